//! The estimates of a run alone: what a campaign keeps of each.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};
use rins_motion::Recording;

use crate::calibration::{CalibrationError, Run};
use crate::filter::{MEASUREMENTS, Start};
use crate::layout::SPIN_AXIS_ERRORS;
use crate::setup::Setup;

/// The spin-axis errors that a run shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// `M_xz`, `M_yz` \[rad\] and `S_z`.
    pub value: Vector3<f64>,
    /// Their covariance, as the filter claims it.
    pub covariance: Matrix3<f64>,
    /// The mean normalised innovation squared over its degrees of freedom; 1 if the model is right.
    pub nis_ratio: f64,
}

/// What [`calibrate`](crate::calibrate) estimates of a recording, without navigation and consistency.
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

/// How the filter starts over a recording, and the samples that it runs over.
///
/// # Errors
/// As [`calibrate`](crate::calibrate), but for what breaks off on the way.
pub fn beginning(
    recording: &Recording,
    setup: &Setup,
) -> Result<(Start, Range<usize>), CalibrationError> {
    Run::prepare(recording, setup).map(|run| (run.start, run.span))
}
