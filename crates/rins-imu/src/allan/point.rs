//! The Allan deviation at one averaging time, and p-values of variances.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// The probability that a deviation lies within its bounds.
pub const CONFIDENCE: f64 = 0.95;

/// The Allan deviation at one averaging time; a rate is in rad/s or m/s².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AllanPoint {
    /// The averaging time τ \[s\].
    pub time: f64,
    /// The overlapping Allan deviation \[rate\].
    pub deviation: f64,
    /// The bounds of the true deviation with a probability of [`CONFIDENCE`] \[rate\].
    pub bounds: (f64, f64),
    /// The fit by the significant laws \[rate\].
    pub fitted: f64,
}

/// The equivalent degrees of freedom of a variance with that mean and scatter (‹riley2008›, chapter 5).
pub(super) fn degrees_of_freedom(mean: f64, scatter: f64) -> f64 {
    2.0 * mean * mean / scatter
}

/// The two-sided p-value of a variance `found` with this `mean`.
pub(super) fn improbability(found: f64, mean: f64, scatter: f64) -> f64 {
    let degrees = degrees_of_freedom(mean, scatter);
    ChiSquared::new(degrees).map_or(1.0, |law| {
        let square = degrees * found / mean;
        (2.0 * law.cdf(square).min(law.sf(square))).min(1.0)
    })
}
