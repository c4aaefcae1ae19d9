//! The deviation at one averaging time, and how probable a variance is.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// How probably a deviation lies within its bounds.
pub const CONFIDENCE: f64 = 0.95;

/// The Allan deviation at one averaging time; a rate is in rad/s or m/s².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AllanPoint {
    /// The averaging time τ \[s\].
    pub time: f64,
    /// The overlapping Allan deviation \[rate\].
    pub deviation: f64,
    /// The bounds between which the true one lies with [`CONFIDENCE`] \[rate\].
    pub bounds: (f64, f64),
    /// What the laws that were seen make of it \[rate\].
    pub fitted: f64,
}

/// The equivalent degrees of freedom of a variance of that mean and scatter (‹riley2008›, chapter 5).
pub(super) fn degrees_of_freedom(mean: f64, scatter: f64) -> f64 {
    2.0 * mean * mean / scatter
}

/// How improbable it is that a variance of `mean` is as far off as `found`, to either side.
pub(super) fn improbability(found: f64, mean: f64, scatter: f64) -> f64 {
    let degrees = degrees_of_freedom(mean, scatter);
    ChiSquared::new(degrees).map_or(1.0, |law| {
        let square = degrees * found / mean;
        (2.0 * law.cdf(square).min(law.sf(square))).min(1.0)
    })
}
