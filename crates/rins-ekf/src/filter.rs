//! The filter's two steps.

use nalgebra::{SMatrix, SVector};

use crate::error::{CovarianceError, Quantity, UpdateError};
use crate::innovation::Innovation;
use crate::kernel::{Factor, add_congruence, add_product, is_finite, mirrored};
use crate::measurement::Measurement;

/// The largest ratio of the variance of a predicted measurement, with correlations between states neglected, to the
/// measurement noise: the accumulated rounding of a covariance of 24 states is then about a thousandth of a sigma.
const RESOLVED: f64 = 1e10;

/// Estimate and covariance of an `N`-element state.
///
/// A constant, estimated from one reading of it:
/// ```
/// use nalgebra::{Matrix1, Vector1};
/// use rins_ekf::{Filter, Measurement};
/// let mut filter = Filter::new(Vector1::new(0.0), Matrix1::new(3.0))?;
/// let reading = Measurement::new(Vector1::new(4.0), Matrix1::new(1.0), Matrix1::new(1.0));
/// let innovation = filter.update(&reading)?;
/// assert_eq!((filter.state[0], filter.covariance[0]), (3.0, 0.75)); // three quarters of the way
/// assert_eq!(innovation.nis(), 4.0); // a 2σ surprise
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Filter<const N: usize> {
    /// The state's estimate, `x̂`.
    pub state: SVector<f64, N>,
    /// The covariance of the estimate's error, `P`; exactly symmetric, and both steps keep it so.
    pub covariance: SMatrix<f64, N, N>,
}

impl<const N: usize> Filter<N> {
    /// A filter with this initial estimate and covariance, which is checked.
    ///
    /// A state with zero variance is known exactly; its covariances must then be zero.
    ///
    /// # Errors
    /// [`CovarianceError`] if a number is not finite, the covariance is not exactly symmetric, or a linear combination of
    /// states has a negative variance.
    pub fn new(
        state: SVector<f64, N>,
        covariance: SMatrix<f64, N, N>,
    ) -> Result<Self, CovarianceError> {
        let filter = Self { state, covariance };
        filter.check()?;
        Ok(filter)
    }

    /// Checks the covariance as in [`Filter::new`].
    ///
    /// The steps themselves check only the diagonal.
    ///
    /// # Errors
    /// As [`Filter::new`].
    pub fn check(&self) -> Result<(), CovarianceError> {
        if let Some(quantity) = self.culprit() {
            return Err(CovarianceError::NotFinite { quantity });
        }
        let p = &self.covariance;
        for column in 0..N {
            for row in column + 1..N {
                let difference = p[(row, column)] - p[(column, row)];
                if difference.abs() > 0.0 {
                    return Err(CovarianceError::NotSymmetric { row, column, difference });
                }
            }
        }
        // Outer-product elimination, without states that are known exactly.
        let mut rest = *p;
        for index in 0..N {
            let variance = rest[(index, index)];
            let known = rest.column(index).iter().skip(index).all(|&x| x.abs() <= 0.0);
            if known {
                continue;
            }
            if variance <= 0.0 {
                return Err(CovarianceError::NotPositiveDefinite { index, variance });
            }
            let column = rest.column(index) / variance;
            for j in index + 1..N {
                let factor = rest[(j, index)];
                for i in j..N {
                    rest[(i, j)] -= column[i] * factor;
                }
            }
        }
        Ok(())
    }

    /// Propagates the estimate over one step of a linear system: `x ← Φ x`, `P ← Φ P Φᵀ + Q`.
    ///
    /// `transition` is `Φ`; `noise` is `Q`, of which only the lower triangle is used. Numbers that are not finite propagate
    /// to the estimate, and the next update reports them.
    pub fn predict(&mut self, transition: &SMatrix<f64, N, N>, noise: &SMatrix<f64, N, N>) {
        self.predict_to(transition * self.state, transition, noise);
    }

    /// Propagates the estimate over one step of a nonlinear system with the propagated state `state` and the derivative
    /// `transition`: `x ← f(x)`, `P ← Φ P Φᵀ + Q`.
    pub fn predict_to(
        &mut self,
        state: SVector<f64, N>,
        transition: &SMatrix<f64, N, N>,
        noise: &SMatrix<f64, N, N>,
    ) {
        let mut covariance = *noise;
        add_congruence(&mut covariance, transition, &self.covariance);
        self.state = state;
        self.covariance = mirrored(covariance);
    }

    /// Corrects the estimate and returns the innovation, whitened.
    ///
    /// With `C = E[(x − x̂) vᵀ]` (zero unless the measurement states it) the gain is `K = (P Hᵀ + C) S⁻¹` and `S = H P Hᵀ + H
    /// C + Cᵀ Hᵀ + R`. The covariance has Joseph's form for noise that is correlated with the error, `(I−KH) P (I−KH)ᵀ + K R
    /// Kᵀ − (I−KH) C Kᵀ − K Cᵀ (I−KH)ᵀ`, in which an error of the gain is of second order.
    ///
    /// # Errors
    /// [`UpdateError`] if a number is not finite or overflows, if `S` is not positive definite, if a variance would be
    /// negative, or if the precision of the covariance is insufficient for the measurement. The filter is then unchanged.
    pub fn update<const M: usize>(
        &mut self,
        measurement: &Measurement<M, N>,
    ) -> Result<Innovation<M>, UpdateError> {
        if let Some(quantity) = measurement.culprit() {
            return Err(UpdateError::NotFinite { quantity });
        }
        let Measurement { value: z, matrix: h, noise, cross } = measurement;
        let r = mirrored(*noise);

        // The covariances of the state's error with the innovation, of the innovation with the noise, and of the innovation.
        let mut error_with_innovation = cross.unwrap_or_else(SMatrix::zeros);
        add_product(&mut error_with_innovation, &self.covariance, h);
        let mut innovation_with_noise = r;
        if let Some(c) = cross {
            innovation_with_noise += h * c;
        }
        let mut s = innovation_with_noise;
        add_product(&mut s, &error_with_innovation.transpose(), h);
        let s = mirrored(s);

        let Some(factor) = Factor::of(&s) else {
            let smallest = s.diagonal().min();
            return Err(self.refusal(if is_finite(&s) {
                UpdateError::InnovationNotPositiveDefinite { smallest }
            } else {
                UpdateError::Overflow
            }));
        };
        let gain = factor.divide(error_with_innovation);
        let innovation = z - h * self.state;
        let state = self.state + gain * innovation;

        // Joseph's form, with E = [I − KH, −K] and J the joint covariance of error and noise: the product E J Eᵀ from the
        // left, with each factor as the identity minus a matrix of rank M, which avoids products of N × N matrices.
        let minus_gain = -gain;
        let mut covariance = self.covariance;
        add_product(&mut covariance, &minus_gain, &error_with_innovation);
        let mut corrected_with_innovation = cross.unwrap_or_else(SMatrix::zeros);
        add_product(&mut corrected_with_innovation, &covariance, h);
        add_product(
            &mut corrected_with_innovation,
            &minus_gain,
            &innovation_with_noise.transpose(),
        );
        add_product(&mut covariance, &corrected_with_innovation, &minus_gain);
        let covariance = mirrored(covariance);

        let whitened = factor.whiten(innovation);
        if !is_finite(&state) || !is_finite(&covariance) || !is_finite(&whitened) {
            return Err(self.refusal(UpdateError::Overflow));
        }
        if let Some(index) = (0..N).find(|&i| covariance[(i, i)] < 0.0) {
            let variance = covariance[(index, index)];
            return Err(UpdateError::NegativeVariance { index, variance });
        }

        for row in 0..M {
            let remaining: f64 =
                (0..N).map(|i| h[(row, i)] * h[(row, i)] * covariance[(i, i)]).sum();
            if remaining > RESOLVED * r[(row, row)] {
                return Err(UpdateError::Unresolved { row, ratio: remaining / r[(row, row)] });
            }
        }

        self.state = state;
        self.covariance = covariance;
        Ok(Innovation {
            value: innovation,
            covariance: s,
            whitened,
            inverse_scales: *factor.inverse_diagonal(),
        })
    }

    /// The error `otherwise`, unless its cause is a number in the filter that is not finite.
    fn refusal(&self, otherwise: UpdateError) -> UpdateError {
        self.culprit().map_or(otherwise, |quantity| UpdateError::NotFinite { quantity })
    }

    fn culprit(&self) -> Option<Quantity> {
        if !is_finite(&self.state) {
            Some(Quantity::State)
        } else if !is_finite(&self.covariance) {
            Some(Quantity::Covariance)
        } else {
            None
        }
    }
}

impl<const M: usize, const N: usize> Measurement<M, N> {
    pub(crate) fn culprit(&self) -> Option<Quantity> {
        if !is_finite(&self.value) {
            Some(Quantity::Value)
        } else if !is_finite(&self.matrix) {
            Some(Quantity::Matrix)
        } else if !is_finite(&self.noise) {
            Some(Quantity::Noise)
        } else if self.cross.as_ref().is_some_and(|c| !is_finite(c)) {
            Some(Quantity::Cross)
        } else {
            None
        }
    }
}
