//! The filter's two steps on the factors of its covariance.

use nalgebra::{ComplexField, SMatrix, SVector};

use crate::error::{CovarianceError, Quantity, UpdateError};
use crate::factors::Factors;
use crate::innovation::Innovation;
use crate::kernel::{add_product, is_finite, mirrored};
use crate::measurement::Measurement;

/// The largest ratio after an update of the variance of a predicted measurement, with correlations between states neglected,
/// to the measurement noise: the relative error of a sigma is the square root of this ratio times the rounding error.
const RESOLVED: f64 = 1e18;

/// The relative rounding error of a noise variance that the state's error explains completely.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The estimate of an `N`-element state, with the covariance as factors `U D Uᵀ`.
///
/// It processes the same measurements as [`Filter`](crate::Filter) with the same results. If only combinations of states are
/// measured, its sigmas keep six digits as long as the remaining variances of the states are below 1e16 times the noise. From
/// 1e18 on it refuses the measurement, as the plain filter does from 1e10 on.
///
/// ```
/// use nalgebra::{Matrix1, Matrix2, RowVector2, Vector1, Vector2};
/// use rins_ekf::{FactorisedFilter, Filter, Measurement};
/// let prior = Matrix2::identity() * 1e16;
/// // Only the sum is measured.
/// let sum = RowVector2::new(1.0, 1.0);
/// let reading = Measurement::new(Vector1::new(2.0), sum, Matrix1::new(1.0));
/// let mut filter = FactorisedFilter::new(Vector2::zeros(), &prior)?;
/// filter.update(&reading)?;
/// filter.update(&reading)?;
/// assert!((filter.factors().variance_of(&sum) - 0.5).abs() < 1e-9); // after two readings
/// assert!(Filter::new(Vector2::zeros(), prior)?.update(&reading).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FactorisedFilter<const N: usize> {
    /// The state's estimate, `x̂`.
    pub state: SVector<f64, N>,
    factors: Factors<N>,
}

impl<const N: usize> FactorisedFilter<N> {
    /// A filter with this initial estimate and covariance.
    ///
    /// # Errors
    /// As [`Factors::of`].
    pub fn new(
        state: SVector<f64, N>,
        covariance: &SMatrix<f64, N, N>,
    ) -> Result<Self, CovarianceError> {
        let factors = Factors::of(covariance)?;
        if !is_finite(&state) {
            return Err(CovarianceError::NotFinite { quantity: Quantity::State });
        }
        Ok(Self { state, factors })
    }

    /// A filter with this initial estimate and these factors of its covariance.
    pub const fn from_factors(state: SVector<f64, N>, factors: Factors<N>) -> Self {
        Self { state, factors }
    }

    /// The factors of the covariance.
    pub const fn factors(&self) -> &Factors<N> {
        &self.factors
    }

    /// Propagates the estimate over one step of a linear system: `x ← Φ x`, `P ← Φ P Φᵀ + G W Gᵀ`, where `by` is `G`, and `W`
    /// is diagonal with the variances of the noise sources.
    pub fn predict<const K: usize>(
        &mut self,
        transition: &SMatrix<f64, N, N>,
        by: &SMatrix<f64, N, K>,
        variances: &SVector<f64, K>,
    ) {
        self.state = transition * self.state;
        self.factors = self.factors.carried(transition, by, variances);
    }

    /// Corrects the estimate and returns the innovation, whitened.
    ///
    /// The rows are processed one by one (‹bierman1977›, ch. V). Their noises precede the state as additional elements, whose
    /// factors contain their correlations with each other and with the state's error.
    ///
    /// # Errors
    /// [`UpdateError`] if a number is not finite or overflows, if the innovation covariance is not positive definite, if the
    /// covariance of noise and state's error is impossible, or if the precision of the factors is insufficient for the
    /// measurement. The filter is then unchanged.
    pub fn update<const M: usize>(
        &mut self,
        measurement: &Measurement<M, N>,
    ) -> Result<Innovation<M>, UpdateError> {
        if let Some(quantity) = measurement.culprit() {
            return Err(UpdateError::NotFinite { quantity });
        }
        if !is_finite(&self.state) {
            return Err(UpdateError::NotFinite { quantity: Quantity::State });
        }
        if !self.factors.is_finite() {
            return Err(UpdateError::NotFinite { quantity: Quantity::Covariance });
        }
        let Measurement { value: z, matrix: h, noise, cross } = measurement;
        let r = mirrored(*noise);
        let mut joint = Joint::new(self.factors, &r, cross.as_ref())?;
        let value = z - h * self.state;
        let covariance = joint.innovation(h);

        let (mut of_noise, mut of_state) = (SVector::<f64, M>::zeros(), SVector::<f64, N>::zeros());
        let (mut whitened, mut inverse_scales) = (value, value);
        for row in 0..M {
            let by = h.row(row).transpose();
            let known = of_noise[row] + by.dot(&of_state);
            let (variance, (with_noise, with_state)) = joint.take_in(row, &by);
            if variance.is_nan() || variance <= 0.0 {
                return Err(UpdateError::InnovationNotPositiveDefinite { smallest: variance });
            }
            if !variance.is_finite() {
                return Err(UpdateError::Overflow);
            }
            let left = value[row] - known;
            of_noise += with_noise * (left / variance);
            of_state += with_state * (left / variance);
            inverse_scales[row] = 1.0 / ComplexField::sqrt(variance);
            whitened[row] = left * inverse_scales[row];
        }

        let state = self.state + of_state;
        let factors = joint.state;
        if !is_finite(&state) || !factors.is_finite() {
            return Err(UpdateError::Overflow);
        }
        let variances = factors.diagonal();
        for row in 0..M {
            let remaining: f64 = (0..N).map(|i| h[(row, i)] * h[(row, i)] * variances[i]).sum();
            if remaining > RESOLVED * r[(row, row)] {
                return Err(UpdateError::Unresolved { row, ratio: remaining / r[(row, row)] });
            }
        }
        self.state = state;
        self.factors = factors;
        Ok(Innovation { value, covariance, whitened, inverse_scales })
    }
}

/// The joint factors of the noises of `M` rows and of the state's error.
struct Joint<const M: usize, const N: usize> {
    noise: Factors<M>,
    /// The dependence of the noises on the sources of the state's factors.
    across: SMatrix<f64, M, N>,
    state: Factors<N>,
}

/// The covariances of a row's innovation with the noises and with the state's error.
type With<const M: usize, const N: usize> = (SVector<f64, M>, SVector<f64, N>);

impl<const M: usize, const N: usize> Joint<M, N> {
    fn new(
        state: Factors<N>,
        r: &SMatrix<f64, M, M>,
        cross: Option<&SMatrix<f64, N, M>>,
    ) -> Result<Self, UpdateError> {
        let mut across = SMatrix::zeros();
        let mut rest = *r;
        if let Some(cross) = cross {
            for row in 0..M {
                let unmixed = state.unmixed(cross.column(row).into_owned());
                for k in 0..N {
                    let variance = state.variances[k];
                    across[(row, k)] = if variance > 0.0 { unmixed[k] / variance } else { 0.0 };
                }
            }
            let weighed = SMatrix::from_fn(|row, k| -across[(row, k)] * state.variances[k]);
            add_product(&mut rest, &weighed, &across);
        }
        let noise = Factors::eliminated(rest, &r.diagonal(), ROUNDING)
            .map_err(|(row, variance)| UpdateError::NoiseOverexplained { row, variance })?;
        Ok(Self { noise, across, state })
    }

    /// The covariance of the rows' innovations.
    fn innovation(&self, h: &SMatrix<f64, M, N>) -> SMatrix<f64, M, M> {
        let by = h * self.state.upper + self.across;
        let weighed = SMatrix::from_fn(|row, k| by[(row, k)] * self.state.variances[k]);
        let mut covariance = self.noise.covariance();
        add_product(&mut covariance, &weighed, &by);
        mirrored(covariance)
    }

    /// Processes one row: the variance of its innovation, given the previous rows, and its prior covariances with the noises
    /// and with the state.
    fn take_in(&mut self, row: usize, by: &SVector<f64, N>) -> (f64, With<M, N>) {
        let (mut with_noise, mut with_state) =
            (SVector::<f64, M>::zeros(), SVector::<f64, N>::zeros());
        let mut sum = 0.0;
        for j in 0..M {
            let column = &mut self.noise.upper.data.0[j];
            let variance = &mut self.noise.variances[j];
            if let Some((shown, share)) = shown(column[row], variance, &mut sum) {
                exchange(column, &mut with_noise.data.0[0], shown, share);
            }
        }
        for j in 0..N {
            let (above, column) = (&mut self.across.data.0[j], &mut self.state.upper.data.0[j]);
            let part =
                above[row] + column.iter().zip(&by.data.0[0]).map(|(u, h)| u * h).sum::<f64>();
            let variance = &mut self.state.variances[j];
            if let Some((shown, share)) = shown(part, variance, &mut sum) {
                exchange(above, &mut with_noise.data.0[0], shown, share);
                exchange(column, &mut with_state.data.0[0], shown, share);
            }
        }
        (sum, (with_noise, with_state))
    }
}

/// The covariance of a row with a column of the factors, and the multiple of the previous columns that is subtracted from the
/// column; `None` if it is zero. `sum` is the variance of the innovation up to the previous columns.
#[inline]
fn shown(part: f64, variance: &mut f64, sum: &mut f64) -> Option<(f64, f64)> {
    let shown = *variance * part;
    // False for NaN, which must propagate to the sum.
    if shown == 0.0 {
        return None;
    }
    let before = *sum;
    *sum += part * shown;
    *variance *= before / *sum;
    Some((shown, if before > 0.0 { -part / before } else { 0.0 }))
}

/// Adds to `column` its multiple `share` of the previous columns in `with`, and adds the column's own part `shown` to `with`.
#[inline]
fn exchange<const R: usize>(column: &mut [f64; R], with: &mut [f64; R], shown: f64, share: f64) {
    for (column, with) in column.iter_mut().zip(with) {
        let before = *column;
        *column += share * *with;
        *with += shown * before;
    }
}
