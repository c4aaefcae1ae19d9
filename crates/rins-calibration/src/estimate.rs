//! The estimates of a run without further results, for a Monte Carlo campaign.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};
use rins_motion::Recording;

use crate::calibration::{CalibrationError, Run};
use crate::filter::{MEASUREMENTS, Start};
use crate::layout::SPIN_AXIS_ERRORS;
use crate::setup::Setup;

/// The estimated spin-axis errors of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// `M_xz`, `M_yz` \[rad\] and `S_z`.
    pub value: Vector3<f64>,
    /// Their covariance from the filter.
    pub covariance: Matrix3<f64>,
    /// The mean normalized innovation squared, divided by its degrees of freedom; 1 if the model is correct.
    pub nis_ratio: f64,
}

/// The estimate of [`calibrate`](crate::calibrate) without navigation and consistency.
///
/// # Errors
/// As [`calibrate`](crate::calibrate).
pub fn estimate(recording: &Recording, setup: &Setup) -> Result<Estimate, CalibrationError> {
    let run = Run::prepare(recording, setup)?;
    let samples = run.span.len();
    let mut squares = 0.0;
    let filter = run.pass(setup, samples, |_, _, whitened| squares += whitened.norm_squared())?;
    let first = SPIN_AXIS_ERRORS.start();
    Ok(Estimate {
        value: filter.estimate(),
        covariance: filter.covariance().fixed_view::<3, 3>(first, first).into_owned(),
        nis_ratio: squares / (samples * MEASUREMENTS) as f64,
    })
}

/// The initial state of the filter for a recording, and the samples of the filter.
///
/// # Errors
/// As [`calibrate`](crate::calibrate), except for failures during the run.
pub fn beginning(
    recording: &Recording,
    setup: &Setup,
) -> Result<(Start, Range<usize>), CalibrationError> {
    Run::prepare(recording, setup).map(|run| (run.start, run.span))
}
