//! Errors of the evaluation of a schedule.

use rins_estimation::{JointError, RunError};
use rins_motion::ProfileError;
use rins_simulation::ScenarioError;

/// The reason why a schedule cannot be evaluated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DesignError {
    /// The run cannot be simulated.
    #[error("{name}: {source}")]
    Scenario {
        /// The name of the run.
        name: String,
        /// The reason.
        source: ScenarioError,
    },
    /// The run cannot be used for an estimation.
    #[error("{name}: {source}")]
    Run {
        /// The name of the run.
        name: String,
        /// The reason.
        source: RunError,
    },
    /// The table cannot follow the motion of a run.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// The evidence of the runs on the parameters of the model cannot be calculated.
    #[error(transparent)]
    Joint(#[from] JointError),
    /// The table rotates, and nothing that would be recorded determines its angle.
    #[error(
        "{name}: the log holds neither a table angle nor a rate, and the spin axis is vertical: the table angle is \
         unobservable"
    )]
    NoAngleReference {
        /// The name of the run.
        name: String,
    },
    /// No schedule of the library is within the limits.
    #[error(
        "no schedule fits within the limits of the table: a ramp takes longer than its segment in every schedule"
    )]
    NothingFits,
    /// No schedule determines what is asked for.
    #[error("no motion of the table determines what the schedule is optimized for")]
    Undetermined,
}
