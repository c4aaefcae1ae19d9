//! Why a schedule cannot be looked at.

use rins_estimation::{JointError, RunError};
use rins_motion::ProfileError;
use rins_simulation::ScenarioError;

/// Why a schedule cannot be looked at.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DesignError {
    /// The run cannot be simulated.
    #[error("{name}: {source}")]
    Scenario {
        /// What the run is called.
        name: String,
        /// Why it cannot.
        source: ScenarioError,
    },
    /// The run is no run to estimate from.
    #[error("{name}: {source}")]
    Run {
        /// What the run is called.
        name: String,
        /// Why it is none.
        source: RunError,
    },
    /// The table of a run cannot move as is said.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// The runs do not go together with the model.
    #[error(transparent)]
    Joint(#[from] JointError),
    /// The table turns, and nothing that would be recorded shows its angle.
    #[error(
        "{name}: the log holds neither a table angle nor a rate, and the spin axis is vertical: the table angle is \
         unobservable"
    )]
    NoAngleReference {
        /// What the run is called.
        name: String,
    },
    /// No schedule of the library is slow enough.
    #[error(
        "no schedule fits within the limits of the table: a ramp takes longer than its segment in every schedule"
    )]
    NothingFits,
}
