//! The posterior of a run with the true values.

use nalgebra::{DMatrix, DVector};

/// The Gaussian posterior of a run with the true values, in any units.
#[derive(Clone, Debug, PartialEq)]
pub struct PosteriorRun {
    /// The true values (n).
    pub truth: Vec<f64>,
    /// The estimates (n).
    pub estimate: Vec<f64>,
    /// The prior sigmas (n).
    pub prior_sigmas: Vec<f64>,
    /// The posterior covariance (n × n).
    pub covariance: DMatrix<f64>,
}

impl PosteriorRun {
    /// Whether all numbers are finite, and all variances positive.
    pub fn is_sound(&self) -> bool {
        let numbers = self.truth.iter().chain(&self.estimate).chain(&self.prior_sigmas);
        numbers.chain(&self.covariance).all(|number| number.is_finite())
            && self.prior_sigmas.iter().chain(&self.covariance.diagonal()).all(|own| *own > 0.0)
    }

    /// The errors, estimate minus truth, in units of the prior sigmas.
    pub(super) fn scaled_error(&self) -> DVector<f64> {
        DVector::from_fn(self.truth.len(), |row, _| {
            (self.estimate[row] - self.truth[row]) / self.prior_sigmas[row]
        })
    }
}
