//! The site of a table, with Earth rate, gravity and magnetic field.

use nalgebra::Vector3;

/// The Earth rate \[rad/s\], WGS84.
const EARTH_RATE: f64 = 7.292115e-5;

/// A site on the Earth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Geodetic latitude \[rad\].
    pub latitude: f64,
    /// Gravity \[m/s²\].
    pub gravity: f64,
}

impl Place {
    /// A site with gravity by the formula of 1967 at sea level.
    pub fn at(latitude: f64) -> Self {
        let (once, twice) = (latitude.sin(), (2.0 * latitude).sin());
        let gravity = 9.780318 * (1.0 + 0.0053024 * once * once - 0.0000059 * twice * twice);
        Self { latitude, gravity }
    }

    /// The Earth rate, east-north-up \[rad/s\].
    pub(crate) fn earth_rate(&self) -> Vector3<f64> {
        Vector3::new(0.0, self.latitude.cos(), self.latitude.sin()) * EARTH_RATE
    }

    /// The field of a magnetic dipole along the Earth's axis, east-north-up \[T\].
    pub(crate) fn magnetic_field(&self) -> Vector3<f64> {
        Vector3::new(0.0, self.latitude.cos(), -2.0 * self.latitude.sin()) * 3e-5
    }
}
