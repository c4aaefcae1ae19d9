//! Why an experiment could not be run again.

use rins_calibration::CalibrationError;
use rins_ekf::UpdateError;
use rins_estimation::{FitError, RunError};
use rins_imu::ImuCompensationError;
use rins_io::IoError;
use rins_motion::{AlignmentError, ProfileError};
use rins_simulation::ScenarioError;

/// Why an experiment could not be run again.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum ReproductionError {
    /// A scenario file is wrong.
    #[error("a scenario file is wrong")]
    File(#[from] IoError),
    /// A scenario lacks a section that this experiment needs.
    #[error("{name} lacks {section}")]
    Missing {
        /// The scenario file.
        name: &'static str,
        /// The section or key.
        section: &'static str,
    },
    /// A scenario cannot be simulated.
    #[error("the scenario cannot be simulated")]
    Scenario(#[from] ScenarioError),
    /// A table profile is none.
    #[error("the table profile is none")]
    Profile(#[from] ProfileError),
    /// A run could not be calibrated.
    #[error("run {run} could not be calibrated")]
    Calibration {
        /// Its index in the campaign.
        run: u64,
        /// Why.
        source: CalibrationError,
    },
    /// A filter broke off.
    #[error("the filter failed at {time} s of run {run}")]
    Update {
        /// The run's index in the campaign.
        run: u64,
        /// The end of the sample's interval \[s\].
        time: f64,
        /// Why.
        source: UpdateError,
    },
    /// A covariance has no inverse, so that nothing can be normalised by it.
    #[error("the covariance of run {run} has no inverse")]
    Singular {
        /// The run's index in the campaign.
        run: u64,
    },
    /// A simulated run does not suit the estimator.
    #[error("a simulated run does not suit the estimator")]
    Run(#[from] RunError),
    /// Nothing could be estimated from a run.
    #[error("nothing could be estimated")]
    Fit(#[from] FitError),
    /// Errors cannot be compensated.
    #[error("the errors cannot be compensated")]
    Compensation(#[from] ImuCompensationError),
    /// The rest at the start cannot be aligned on.
    #[error("the alignment over the static interval at the start failed")]
    Alignment(#[from] AlignmentError),
}
