//! Errors of experiments.

use rins_calibration::CalibrationError;
use rins_ekf::UpdateError;
use rins_estimation::{FitError, RunError};
use rins_imu::ImuCompensationError;
use rins_io::IoError;
use rins_motion::{AlignmentError, ProfileError};
use rins_simulation::ScenarioError;

/// The reason why an experiment failed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum ReproductionError {
    /// A scenario file is invalid.
    #[error("a scenario file is wrong")]
    File(#[from] IoError),
    /// A scenario lacks a required section.
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
    /// A table profile is invalid.
    #[error("the table profile is none")]
    Profile(#[from] ProfileError),
    /// The calibration of a run failed.
    #[error("run {run} could not be calibrated")]
    Calibration {
        /// Its index in the campaign.
        run: u64,
        /// The reason.
        source: CalibrationError,
    },
    /// A filter diverged.
    #[error("the filter failed at {time} s of run {run}")]
    Update {
        /// The run's index in the campaign.
        run: u64,
        /// The end of the sample's interval \[s\].
        time: f64,
        /// The reason.
        source: UpdateError,
    },
    /// A covariance is singular, so that an error cannot be normalized by it.
    #[error("the covariance of run {run} has no inverse")]
    Singular {
        /// The run's index in the campaign.
        run: u64,
    },
    /// The estimator cannot process a simulated run.
    #[error("a simulated run does not suit the estimator")]
    Run(#[from] RunError),
    /// The estimation from a run failed.
    #[error("nothing could be estimated")]
    Fit(#[from] FitError),
    /// Errors cannot be compensated.
    #[error("the errors cannot be compensated")]
    Compensation(#[from] ImuCompensationError),
    /// The alignment on the static interval at the start failed.
    #[error("the alignment over the static interval at the start failed")]
    Alignment(#[from] AlignmentError),
}
