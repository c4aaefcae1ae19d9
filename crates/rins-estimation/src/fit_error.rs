//! What may go wrong on the way to an estimate.

use crate::evidence::Indefinite;

/// Why no estimate was found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// There is no run.
    #[error("there is no run to estimate anything from")]
    NoRun,
    /// The model estimates nothing.
    #[error("the model leaves no parameter to be estimated")]
    NothingFree,
    /// The model estimates more than is done in reasonable time.
    #[error(
        "the model estimates {parameters} parameters, at most {most} are estimated at once: leave some out"
    )]
    ManyParameters {
        /// How many it estimates.
        parameters: usize,
        /// The most.
        most: usize,
    },
    /// The filter broke off.
    #[error(transparent)]
    Indefinite(#[from] Indefinite),
    /// The information is not finite.
    #[error("the data do not make a finite information matrix at iteration {iteration}")]
    NoInformation {
        /// Which iteration.
        iteration: usize,
    },
    /// The steps did not become small.
    #[error(
        "after {iterations} iterations the last step is still {step} sigma: the model is too far from these data"
    )]
    Diverged {
        /// How many iterations were made.
        iterations: usize,
        /// The largest of the last steps, in sigmas.
        step: f64,
    },
}
