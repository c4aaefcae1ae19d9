//! What may go wrong on the way to an estimate.

use crate::evidence::Indefinite;

/// Why no estimate was found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// There is no run.
    #[error("no run is given for the estimation")]
    NoRun,
    /// The model estimates nothing.
    #[error("the model has no parameter to estimate")]
    NothingFree,
    /// The model estimates more than is done in reasonable time.
    #[error(
        "the model estimates {parameters} parameters, at most {most} are possible: remove some"
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
    #[error("the information matrix is not finite at iteration {iteration}")]
    NoInformation {
        /// Which iteration.
        iteration: usize,
    },
    /// The steps did not become small.
    #[error(
        "not converged after {iterations} iterations: the last step is {step} sigma; the model does not \
         describe these data"
    )]
    Diverged {
        /// How many iterations were made.
        iterations: usize,
        /// The largest of the last steps, in sigmas.
        step: f64,
    },
}
