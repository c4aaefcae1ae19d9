//! The prior uncertainty of the attitude of an axis.

use nalgebra::{Matrix3, Vector3};
use rins_frames::{Dcm, Nav, Table};

use crate::align::ANY_AZIMUTH;

/// The factor on the 1σ of an attitude that was found in the same data: only a hundredth of its information is counted twice.
pub(super) const FOUND_HERE: f64 = 10.0;

/// The prior uncertainty of the attitude of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Attitude {
    /// The 1σ of the attitude error about each axis of the axis frame \[rad\]; `None` if the attitude is a definition.
    pub(crate) sigma: [Option<f64>; 3],
    /// The 1σ of the heading, if it is too large to be treated as a small attitude error \[rad\].
    pub(crate) azimuth: Option<f64>,
}

impl Attitude {
    /// An uncertainty of `sigma` about every axis \[rad\].
    pub(super) const fn within(sigma: f64) -> Self {
        Self { sigma: [Some(sigma); 3], azimuth: None }
    }

    /// The 1σ of the error of the Earth's horizontal rate to the north and to the east (true minus assumed), as fractions of that
    /// rate; `None` if the heading is known well enough to be treated as a small attitude error.
    ///
    /// These are the root mean squares of `cos ψ - 1` and `sin ψ` with ψ normal: 1.06 and 0.71 if the heading is unknown.
    pub(super) fn horizontal_rate(&self) -> Option<[f64; 2]> {
        let variance = self.azimuth?.powi(2);
        let (once, twice) = ((-0.5 * variance).exp(), (-2.0 * variance).exp());
        Some([1.5 - 2.0 * once + 0.5 * twice, 0.5 - 0.5 * twice].map(f64::sqrt))
    }
}

/// The 1σ about the axes of the axis frame from an alignment's 1σ about east, north and up, increased because the estimate
/// uses the same data.
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
