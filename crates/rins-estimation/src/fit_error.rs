//! Errors of the estimation.

use crate::evidence::Indefinite;

/// The reason why there is no estimate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// There is no run.
    #[error("no run is given for the estimation")]
    NoRun,
    /// The model has no free parameters.
    #[error("the model has no parameter to estimate")]
    NothingFree,
    /// The model has more free parameters than can be estimated in reasonable time.
    #[error(
        "the model estimates {parameters} parameters, at most {most} are possible: remove some"
    )]
    ManyParameters {
        /// The number of its free parameters.
        parameters: usize,
        /// The largest possible number.
        most: usize,
    },
    /// The filter failed.
    #[error(transparent)]
    Indefinite(#[from] Indefinite),
    /// The information matrix is not finite.
    #[error("the information matrix is not finite at iteration {iteration}")]
    NoInformation {
        /// The iteration.
        iteration: usize,
    },
    /// The iteration did not converge.
    #[error(
        "not converged after {iterations} iterations (last step {step:.1} sigma): the innovations are {misfit:.1} times as large as the \
         stated noise, and the parameter farthest from its prior is {parameter} ({distance:.0} sigma); the model does not describe these \
         data, or a stated sigma is too small"
    )]
    Diverged {
        /// The id of the parameter that is farthest from its prior.
        parameter: String,
        /// Its distance from its prior, in prior sigmas.
        distance: f64,
        /// The number of iterations.
        iterations: usize,
        /// The largest component of the last step, in sigmas.
        step: f64,
        /// The root mean square of the innovations, in units of the stated noise.
        misfit: f64,
    },
}
