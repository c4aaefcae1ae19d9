//! The result of an update: the innovation, its covariance, and statistics for consistency tests.

use core::f64::consts::TAU;

use nalgebra::{ComplexField, SMatrix, SVector};

/// The difference between a measurement and its prediction.
#[derive(Clone, Debug, PartialEq)]
pub struct Innovation<const M: usize> {
    /// `ν = z − H x̂`, in the measurement's units.
    pub value: SVector<f64, M>,
    /// `S`, the covariance of [`value`](Self::value) according to the model.
    pub covariance: SMatrix<f64, M, M>,
    /// `L⁻¹ ν` with `S = L Lᵀ`: N(0, I), and independent from update to update, if the model is correct.
    pub whitened: SVector<f64, M>,
    /// The diagonal of `L⁻¹`.
    pub(crate) inverse_scales: SVector<f64, M>,
}

impl<const M: usize> Innovation<M> {
    /// The normalized innovation squared, `νᵀ S⁻¹ ν`: χ² with `M` degrees of freedom if the model is correct (Bar-Shalom, Li
    /// and Kirubarajan 2001, sec. 5.4).
    pub fn nis(&self) -> f64 {
        self.whitened.norm_squared()
    }

    /// The log-density of this measurement given all previous ones.
    ///
    /// The sum over a run is the log-likelihood of the model.
    pub fn log_likelihood(&self) -> f64 {
        let minus_log_root_determinant: f64 =
            self.inverse_scales.iter().map(|&scale| ComplexField::ln(scale)).sum();
        minus_log_root_determinant - 0.5 * (self.nis() + M as f64 * ComplexField::ln(TAU))
    }
}
