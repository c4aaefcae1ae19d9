//! How well the attitude of an axis is known before anything is estimated.

use nalgebra::{Matrix3, Vector3};
use rins_frames::{Dcm, Nav, Table};

use crate::align::ANY_AZIMUTH;

/// An attitude that was found in the same data is counted again by a hundredth of its information.
pub(super) const FOUND_HERE: f64 = 10.0;

/// How well the attitude of an axis is known before anything is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Attitude {
    /// The 1σ of its error about each axis of the axis frame \[rad\]; none if it is a definition.
    pub(crate) sigma: [Option<f64>; 3],
    /// That of its heading, if it is too large to be an error of the attitude \[rad\].
    pub(crate) azimuth: Option<f64>,
}

impl Attitude {
    /// Known to `sigma` about any axis \[rad\].
    pub(super) const fn within(sigma: f64) -> Self {
        Self { sigma: [Some(sigma); 3], azimuth: None }
    }

    /// The 1σ of the Earth's horizontal rate to the north and to the east, true less assumed, as parts of that rate; none if
    /// the heading is known well enough to be an error of the attitude.
    ///
    /// That is `cos ψ - 1` and `sin ψ`, with ψ normal: root mean squares of 1.06 and 0.71 where nothing is known of it.
    pub(super) fn horizontal_rate(&self) -> Option<[f64; 2]> {
        let variance = self.azimuth?.powi(2);
        let (once, twice) = ((-0.5 * variance).exp(), (-2.0 * variance).exp());
        Some([1.5 - 2.0 * once + 0.5 * twice, 0.5 - 0.5 * twice].map(f64::sqrt))
    }
}

/// What an alignment's 1σ about east, north and up are about the axes of the axis frame, widened since the
/// estimate uses the same data.
pub(super) fn aligned(
    nav_from_table: &Dcm<Nav, Table>,
    sigma: (f64, f64, Option<f64>),
) -> Attitude {
    let (east, north, up) = sigma;
    let wide = |sigma: f64| (FOUND_HERE * sigma).min(ANY_AZIMUTH);
    let about = Vector3::new(wide(east), wide(north), up.map_or(ANY_AZIMUTH, wide));
    let covariance = Matrix3::from_diagonal(&about.map(|sigma| sigma * sigma));
    let turned = nav_from_table.matrix().transpose() * covariance * nav_from_table.matrix();
    Attitude { sigma: [0, 1, 2].map(|axis| Some(turned[(axis, axis)].sqrt())), azimuth: None }
}
