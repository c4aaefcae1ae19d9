//! The filter's two steps on the factors of its covariance.

use nalgebra::{ComplexField, SMatrix, SVector};

use crate::error::{CovarianceError, Quantity, UpdateError};
use crate::factors::Factors;
use crate::innovation::Innovation;
use crate::kernel::{add_product, is_finite, mirrored};
use crate::measurement::Measurement;

/// The largest ratio of a measured combination's variance, its states taken apart, to the
/// measurement's noise after an update: its root times a rounding error is what a sigma may be off.
const RESOLVED: f64 = 1e18;

/// What of a noise's variance may be rounding where the state's error explains all of it.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Estimate of an `N`-element state, with the covariance as factors `U D Uᵀ`.
///
/// It takes the same measurements as [`Filter`](crate::Filter) and finds the same. Its sigmas keep six digits where
/// states whose variances stay up to 1e16 times the noise are only seen mixed, and beyond that it refuses,
/// as the plain filter does from 1e10 on.
///
/// ```
/// use nalgebra::{Matrix1, Matrix2, RowVector2, Vector1, Vector2};
/// use rins_ekf::{FactorisedFilter, Filter, Measurement};
/// let prior = Matrix2::identity() * 1e16;
/// // Only the sum is seen.
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
    /// A filter that starts from this estimate and covariance.
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

    /// A filter that starts from this estimate and these factors of its covariance.
    pub const fn from_factors(state: SVector<f64, N>, factors: Factors<N>) -> Self {
        Self { state, factors }
    }

    /// The covariance's factors.
    pub const fn factors(&self) -> &Factors<N> {
        &self.factors
    }

    /// Carries the estimate over one step of a linear system: `x ← Φ x`, `P ← Φ P Φᵀ + G W Gᵀ`, where
    /// `by` is `G` and the noise's sources have these variances.
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
    /// The rows are taken one by one (‹bierman1977›, ch. V). Their noises stand above the state as
    /// further elements of it, whose factors say how they go together with each other and with the state's error.
    ///
    /// # Errors
    /// [`UpdateError`] if a number is not finite or overflows, if the innovation has no covariance, if
    /// noise and state's error can have none in common, or if the factors could not resolve the
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

/// The factors of `M` rows' noises and, below them, the state's error.
struct Joint<const M: usize, const N: usize> {
    noise: Factors<M>,
    /// How the noises depend on what the columns of the state's factors stand for.
    across: SMatrix<f64, M, N>,
    state: Factors<N>,
}

/// What a row's innovation goes together with: the noises, and the state's error.
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

    /// Takes in one row: the variance of its innovation, given the rows before, and the covariances of
    /// that with noises and state before it was known.
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

/// What a row shows of a column of the factors, and by how much the columns before must make up for it;
/// nothing if it shows nothing. `sum` is the innovation's variance as far as the columns before go.
#[inline]
fn shown(part: f64, variance: &mut f64, sum: &mut f64) -> Option<(f64, f64)> {
    let shown = *variance * part;
    // False for NaN, which must show in the sum.
    if shown == 0.0 {
        return None;
    }
    let before = *sum;
    *sum += part * shown;
    *variance *= before / *sum;
    Some((shown, if before > 0.0 { -part / before } else { 0.0 }))
}

/// Adds to `column` its share of what the columns before it show, and to that what it shows itself.
#[inline]
fn exchange<const R: usize>(column: &mut [f64; R], with: &mut [f64; R], shown: f64, share: f64) {
    for (column, with) in column.iter_mut().zip(with) {
        let before = *column;
        *column += share * *with;
        *with += shown * before;
    }
}
