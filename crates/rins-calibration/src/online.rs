//! The estimates after each sample, and online compensation of navigation with them.

use std::ops::Range;

use nalgebra::Vector3;
use rins_frames::{Dcm, Nav, Table};
use rins_imu::{Compensation, ImuCompensationError, ImuError, TriadError};
use rins_motion::{Recording, Station};

use crate::calibration::{CalibrationError, EstimatePoint, Run, sigma};
use crate::filter::gyro_error;
use crate::layout::SPIN_AXIS_ERRORS;
use crate::navigation::{FreeNavigation, navigate_compensating};
use crate::setup::Setup;

/// The estimates after each sample of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct RunningEstimate {
    /// The samples of the filter: those after the static interval at the start.
    pub span: Range<usize>,
    /// The estimate after each of these samples.
    pub points: Vec<EstimatePoint>,
}

impl RunningEstimate {
    /// `M_xz`, `M_yz` \[rad\] and `S_z` as estimated from the samples before sample `index` of the recording: zero up to the
    /// first sample of the span.
    pub fn before(&self, index: usize) -> Vector3<f64> {
        let seen = index.saturating_sub(self.span.start).min(self.points.len());
        seen.checked_sub(1).map_or_else(Vector3::zeros, |last| self.points[last].estimate)
    }

    /// For each sample of a range of the recording, the compensation with the estimate before it.
    ///
    /// # Errors
    /// [`ImuCompensationError`] if one of the estimates cannot be compensated.
    pub fn compensations(
        &self,
        samples: Range<usize>,
    ) -> Result<Vec<Compensation>, ImuCompensationError> {
        let of = |index| {
            let gyro = gyro_error(&self.before(index));
            ImuError { gyro, accel: TriadError::default() }.compensation()
        };
        samples.map(of).collect()
    }
}

/// The estimates of [`calibrate`](crate::calibrate) after each sample.
///
/// # Errors
/// As [`calibrate`](crate::calibrate).
pub fn running_estimate(
    recording: &Recording,
    setup: &Setup,
) -> Result<RunningEstimate, CalibrationError> {
    let run = Run::prepare(recording, setup)?;
    let samples = run.span.len();
    let mut points = Vec::with_capacity(samples);
    run.pass(setup, samples, |done, filter, _| {
        points.push(EstimatePoint {
            time: recording.times[run.span.start + done],
            estimate: filter.estimate(),
            sigma: sigma(filter, SPIN_AXIS_ERRORS.start()),
        });
    })?;
    Ok(RunningEstimate { span: run.span, points })
}

/// [`navigate_freely`](crate::navigate_freely) with a compensation for each sample: online compensation with the current
/// estimates. They correct only the sensors, not the integrated position, velocity and attitude. Samples after the last
/// compensation are not compensated.
pub fn navigate_online(
    recording: &Recording,
    angles: &[f64],
    nav_from_table: Dcm<Nav, Table>,
    station: &Station,
    compensations: &[Compensation],
) -> FreeNavigation {
    navigate_compensating(recording, angles, nav_from_table, station, |index, sample| {
        compensations.get(index).map_or(*sample, |compensation| compensation.compensate(sample))
    })
}
