//! The Rauch–Tung–Striebel smoother: estimates at past times from all measurements.

use alloc::vec::Vec;

use nalgebra::{SMatrix, SVector};

use crate::filter::Filter;
use crate::kernel::{Factor, add_congruence, add_product, is_finite, mirrored};

/// The record of one filter step for the smoother.
#[derive(Clone, Debug, PartialEq)]
pub struct Step<const N: usize> {
    /// `Φ` of the transition from the previous step.
    pub transition: SMatrix<f64, N, N>,
    /// `Q` of this transition; its lower triangle is used.
    pub noise: SMatrix<f64, N, N>,
    /// The estimate before this step's measurements.
    pub predicted: Filter<N>,
    /// The estimate after them, and before any reset of an error state.
    pub filtered: Filter<N>,
}

/// An estimate from the measurements before, at and after its time.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothed<const N: usize> {
    /// The state's estimate.
    pub state: SVector<f64, N>,
    /// The covariance of the estimate's error, exactly symmetric.
    pub covariance: SMatrix<f64, N, N>,
    /// The correction of the filtered estimate by the later measurements: `state − filtered.state`.
    ///
    /// For an error-state filter, it is added to the quantity that was corrected at this step before the reset.
    pub correction: SVector<f64, N>,
}

/// The reason why a run cannot be smoothed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SmootherError {
    /// A predicted covariance has no Cholesky factor.
    #[error(
        "the covariance predicted for step {step} is not positive definite; leave out states that are known"
    )]
    PredictedNotPositiveDefinite {
        /// The step, from 0.
        step: usize,
    },
    /// A number in the record is not finite, or the result overflows.
    #[error("the smoothed estimate before step {step} is not finite")]
    NotFinite {
        /// The step, from 0.
        step: usize,
    },
}

impl<const N: usize> Smoothed<N> {
    /// The last estimate of a run, which smoothing does not change.
    fn last(filtered: &Filter<N>) -> Self {
        Self {
            state: filtered.state,
            covariance: filtered.covariance,
            correction: SVector::zeros(),
        }
    }

    /// The estimate one step earlier, where `earlier` is the filtered one; `self` is the estimate at the end of `step`, and
    /// `predicted_factor` is the factor of its predicted covariance.
    fn before(&self, step: &Step<N>, earlier: &Filter<N>, predicted_factor: &Factor<N>) -> Self {
        let mut earlier_with_predicted = SMatrix::zeros();
        add_product(&mut earlier_with_predicted, &earlier.covariance, &step.transition);
        let gain = predicted_factor.divide(earlier_with_predicted);

        // Only the correction by the step's measurements enters, not the estimates themselves, so that a reset between two
        // steps has no effect.
        let change = step.filtered.state - step.predicted.state + self.correction;
        let correction = gain * change;

        let keep = SMatrix::<f64, N, N>::identity() - gain * step.transition;
        let mut covariance = SMatrix::zeros();
        add_congruence(&mut covariance, &keep, &earlier.covariance);
        add_congruence(&mut covariance, &gain, &(mirrored(step.noise) + self.covariance));
        Self { state: earlier.state + correction, covariance: mirrored(covariance), correction }
    }
}

/// The record of a run, step by step, and the backward pass (Rauch, Tung and Striebel 1965).
///
/// The covariance has the form `(I−GΦ) P (I−GΦ)ᵀ + G (Q + Pˢ) Gᵀ`, a sum of squares, instead of the textbook's difference.
///
/// ```
/// use nalgebra::{Matrix1, Vector1};
/// use rins_ekf::{Filter, Measurement, Smoother, Step};
/// let (transition, noise) = (Matrix1::new(1.0), Matrix1::new(0.0));
/// let mut filter = Filter::new(Vector1::new(0.0), Matrix1::new(1.0))?;
/// let mut smoother = Smoother::new(filter.clone());
/// for reading in [2.0, 4.0] {
///     filter.predict(&transition, &noise);
///     let predicted = filter.clone();
///     filter.update(&Measurement::new(Vector1::new(reading), transition, Matrix1::new(1.0)))?;
///     smoother.push(Step { transition, noise, predicted, filtered: filter.clone() });
/// }
/// // A constant is the same at all times: the mean of the prior's 0 and the readings 2 and 4.
/// for smoothed in smoother.smoothed()? {
///     assert!((smoothed.state[0] - 2.0).abs() < 1e-15);
///     assert!((smoothed.covariance[0] - 1.0 / 3.0).abs() < 1e-15);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// **Error states.** A filter that corrects its reference quantity and then resets its state to zero records each step
/// *before* the reset. [`Smoothed::correction`] is then added to the corrected quantity at that time, with the filter's sign.
///
/// **Limit.** A measurement whose noise is correlated with the state's error
/// ([`Measurement::correlated_with_state_error`](crate::Measurement::correlated_with_state_error)) holds information on the
/// state at the *start* of the step beyond that on its end. This smoother, like the textbook's, does not use it. Augment the
/// state with the shared noise to smooth such a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoother<const N: usize> {
    start: Filter<N>,
    steps: Vec<Step<N>>,
}

impl<const N: usize> Smoother<N> {
    /// The record of a run with this initial estimate.
    pub const fn new(start: Filter<N>) -> Self {
        Self { start, steps: Vec::new() }
    }

    /// Adds the next step.
    pub fn push(&mut self, step: Step<N>) {
        self.steps.push(step);
    }

    /// The steps so far.
    pub fn steps(&self) -> &[Step<N>] {
        &self.steps
    }

    /// The smoothed estimates: of the start, then of the end of each step.
    ///
    /// # Errors
    /// [`SmootherError`] if a predicted covariance is not positive definite or a number is not finite.
    pub fn smoothed(&self) -> Result<Vec<Smoothed<N>>, SmootherError> {
        let end_of = |step: usize| &self.steps[step].filtered;
        let start_of = |step: usize| step.checked_sub(1).map_or(&self.start, end_of);
        let mut later = Smoothed::last(start_of(self.steps.len()));
        let mut smoothed = Vec::with_capacity(self.steps.len() + 1);
        smoothed.push(later.clone());
        for (index, step) in self.steps.iter().enumerate().rev() {
            let factor = Factor::of(&step.predicted.covariance)
                .ok_or(SmootherError::PredictedNotPositiveDefinite { step: index })?;
            later = later.before(step, start_of(index), &factor);
            if !is_finite(&later.state) || !is_finite(&later.covariance) {
                return Err(SmootherError::NotFinite { step: index });
            }
            smoothed.push(later.clone());
        }
        smoothed.reverse();
        Ok(smoothed)
    }
}
