//! The WGS84 Earth: radii of curvature, normal gravity, Earth rate and transport rate.

use nalgebra::ComplexField;

use crate::frame::{InFrame, Nav};

/// The Earth's rotation rate \[rad/s\] (WGS84).
pub const EARTH_RATE: f64 = 7.292115e-5;

/// The semi-major axis \[m\] (WGS84).
const SEMI_MAJOR_AXIS: f64 = 6378137.0;
/// The flattening (WGS84).
const FLATTENING: f64 = 1.0 / 298.257223563;
/// The first eccentricity squared.
const ECCENTRICITY_SQUARED: f64 = FLATTENING * (2.0 - FLATTENING);
/// Normal gravity on the equator \[m/s²\] (WGS84).
const EQUATORIAL_GRAVITY: f64 = 9.7803253359;
/// Somigliana's constant `k` (WGS84).
const SOMIGLIANA: f64 = 0.00193185265241;
/// `m = ω² a² b / GM` (WGS84).
const CENTRIFUGAL_RATIO: f64 = 0.00344978650684;

/// A position on or near the WGS84 ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Geodetic latitude, north positive \[rad\].
    pub latitude: f64,
    /// Longitude, east positive \[rad\].
    pub longitude: f64,
    /// Height above the ellipsoid \[m\].
    pub height: f64,
}

impl Site {
    /// The radius of curvature of the meridian, `R_M` \[m\], on the ellipsoid.
    pub fn meridian_radius(&self) -> f64 {
        let w = self.curvature_term();
        SEMI_MAJOR_AXIS * (1.0 - ECCENTRICITY_SQUARED) / (w * ComplexField::sqrt(w))
    }

    /// The radius of curvature in the prime vertical, `R_N` \[m\], on the ellipsoid.
    pub fn transverse_radius(&self) -> f64 {
        SEMI_MAJOR_AXIS / ComplexField::sqrt(self.curvature_term())
    }

    /// Normal gravity, downwards \[m/s²\]: Somigliana's formula, continued upwards to second order in height.
    ///
    /// NIMA TR8350.2, eqs. (4-1) and (4-3). The second omits squares of the flattening, and differs
    /// from the exact normal gravity by up to 1e-10 m/s² per meter of height.
    ///
    /// ```
    /// use rins_frames::Site;
    /// let pole = Site { latitude: std::f64::consts::FRAC_PI_2, longitude: 0.0, height: 0.0 };
    /// assert!((pole.normal_gravity() - 9.8321849378).abs() < 1e-9);
    /// ```
    pub fn normal_gravity(&self) -> f64 {
        let sin = ComplexField::sin(self.latitude);
        let square = sin * sin;
        let surface = EQUATORIAL_GRAVITY * (1.0 + SOMIGLIANA * square)
            / ComplexField::sqrt(1.0 - ECCENTRICITY_SQUARED * square);
        let ratio = self.height / SEMI_MAJOR_AXIS;
        let slope = 1.0 + FLATTENING + CENTRIFUGAL_RATIO - 2.0 * FLATTENING * square;
        surface * (1.0 - 2.0 * slope * ratio + 3.0 * ratio * ratio)
    }

    /// The Earth rate, `ω_ie^n` \[rad/s\]: the rotation of the Earth with respect to inertial space.
    pub fn earth_rate(&self) -> InFrame<Nav> {
        let (sin, cos) = ComplexField::sin_cos(self.latitude);
        InFrame::new(0.0, EARTH_RATE * cos, EARTH_RATE * sin)
    }

    /// The transport rate, `ω_en^n` \[rad/s\]: the rate of the geographic frame relative to the Earth, at this velocity \[m/s\].
    ///
    /// Its vertical component diverges at the poles, where east is not defined.
    ///
    /// A velocity resolved in another frame does not compile:
    /// ```compile_fail,E0308
    /// use rins_frames::{Body, InFrame, Site};
    /// let site = Site { latitude: 0.6, longitude: 0.0, height: 0.0 };
    /// let rate = site.transport_rate(&InFrame::<Body>::new(0.0, 100.0, 0.0));
    /// ```
    pub fn transport_rate(&self, velocity: &InFrame<Nav>) -> InFrame<Nav> {
        let v = velocity.components();
        let east = v.x / (self.transverse_radius() + self.height);
        let north = v.y / (self.meridian_radius() + self.height);
        let (sin, cos) = ComplexField::sin_cos(self.latitude);
        InFrame::new(-north, east, east * sin / cos)
    }

    fn curvature_term(&self) -> f64 {
        let sin = ComplexField::sin(self.latitude);
        1.0 - ECCENTRICITY_SQUARED * sin * sin
    }
}
