//! A table angle in a file with its own clock.

use std::ops::Range;
use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use rins_frames::Increments;
use rins_motion::median;

use super::files::OneFile;
use super::problem::LogProblem;
use super::series::{smoothly_between, unwrap};
use crate::error::{IoError, LogError};
use crate::rig::AngleColumn;
use crate::shown::shown;

/// The longest interval of the readings \[s\], with the jitter of a median: that of the shortest epochs of the estimator, which
/// would take one slower reading for several.
pub(super) const LONGEST_INTERVAL: f64 = 0.101;

/// The smallest singular value of the normal matrix of the gyro's errors, relative to its norm, that is not zero.
const SINGULAR: f64 = 1e-12;

/// A gap between two readings, in intervals.
const GAP: f64 = 1.5;

/// The time before the first and after the last reading over which the angle follows the gyro, in intervals of the readings.
const REACH: f64 = 2.0;

/// A table angle at the ends of the samples' intervals.
pub(super) struct OwnAngles {
    /// The angles \[rad\].
    pub(super) angles: Vec<f64>,
    /// The samples that the readings cover.
    pub(super) covered: Range<usize>,
    /// The rate of the readings \[Hz\].
    pub(super) rate: f64,
}

/// The table angle at the ends of the samples' intervals.
///
/// From the nearest reading on the angle follows the gyro about the spin axis, with the gyro's bias and scale error by a regression
/// over the log. The difference of angle and gyro changes slowly whatever the table does, and shows the whole turns between two
/// readings. An interpolation between two readings would mix their noise: it would not be white.
///
/// # Errors
/// [`IoError::Log`] if times do not increase, if readings are too rare or have gaps, or if they are at other times than the samples.
pub(super) fn angles_of_own_clock(
    mut file: OneFile,
    column: &AngleColumn,
    increments: &[Increments],
    ends: &[f64],
    log: &Path,
) -> Result<OwnAngles, IoError> {
    let angles = file.column(&column.column, column.factor, "rad")?;
    file.ensure_increasing()?;
    let path = &file.path;
    let times = &file.columns.time;
    let Some(interval) = median(times.windows(2).map(|pair| pair[1] - pair[0])) else {
        return Err(LogError::of(path, LogProblem::TooShort { samples: times.len() }));
    };
    if interval > LONGEST_INTERVAL {
        let (rate, least) = (1.0 / interval, 1.0 / LONGEST_INTERVAL);
        return Err(LogError::of(path, LogProblem::SlowTableAngle { rate, least }));
    }
    if let Some(row) = times.windows(2).position(|pair| pair[1] - pair[0] > GAP * interval) {
        let (after, length) = (times[row], times[row + 1] - times[row]);
        let problem = LogProblem::LongGap { length, after, largest: GAP * interval };
        return Err(LogError::at(path, file.columns.lines.of(row + 1), problem));
    }

    // The angle of the gyro about the spin axis, from the start of the first sample on.
    let start = ends.first().zip(increments.first()).map(|(end, first)| end - first.interval);
    let mut moments = vec![start.unwrap_or_default()];
    moments.extend(ends);
    let mut turned = vec![0.0];
    let mut total = 0.0;
    turned.extend(increments.iter().map(|sample| {
        total += sample.angle.components().z;
        total
    }));
    let (first, last) = (moments[0], moments[moments.len() - 1]);
    // Readings during the samples.
    let inside =
        times.partition_point(|time| *time < first)..times.partition_point(|time| *time <= last);
    if inside.is_empty() {
        return Err(LogError::of(path, LogProblem::NoOverlap { other: shown(log) }));
    }
    let times = &times[inside.clone()];
    let turned_by: Vec<f64> = times
        .iter()
        .map(|time| smoothly_between(&moments, &turned, *time).unwrap_or(total))
        .collect();
    let mut offsets: Vec<f64> = angles[inside.clone()]
        .iter()
        .zip(&turned_by)
        .map(|(angle, turned)| angle - turned)
        .collect();
    unwrap(&mut offsets).map_err(|(row, turns)| {
        let problem = LogProblem::AmbiguousAngle { turns };
        LogError::at(path, file.columns.lines.of(inside.start + row), problem)
    })?;
    let (earliest, latest) =
        (times[0] - REACH * interval, times[times.len() - 1] + REACH * interval);
    let covered =
        ends.partition_point(|end| *end < earliest)..ends.partition_point(|end| *end <= latest);
    let errors = GyroErrors::of(times, &turned_by, &offsets);
    let residuals: Vec<f64> =
        (0..times.len()).map(|row| offsets[row] - errors.at(times[row], turned_by[row])).collect();
    let at = |sample: usize| {
        let (end, turned) = (ends[sample], turned[sample + 1]);
        let after = times.partition_point(|time| *time < end).min(times.len() - 1);
        let before = after.saturating_sub(1);
        let nearest = if end - times[before] < times[after] - end { before } else { after };
        turned + errors.at(end, turned) + residuals[nearest]
    };
    let angles = covered.clone().map(at).collect();
    Ok(OwnAngles { angles, covered, rate: 1.0 / interval })
}

/// The error of the gyro's angle: constant, by its bias, and by its scale error.
struct GyroErrors {
    start: f64,
    coefficients: Vector3<f64>,
}

impl GyroErrors {
    /// The regression of the differences of angle and gyro on time and on the gyro's angle.
    fn of(times: &[f64], turned: &[f64], differences: &[f64]) -> Self {
        let start = times[0];
        let mut normal = Matrix3::zeros();
        let mut right = Vector3::zeros();
        for ((time, turned), difference) in times.iter().zip(turned).zip(differences) {
            let row = Vector3::new(1.0, time - start, *turned);
            normal += row * row.transpose();
            right += row * *difference;
        }
        let scale = normal
            .diagonal()
            .map(|square: f64| if square > 0.0 { square.sqrt().recip() } else { 0.0 });
        let scaling = Matrix3::from_diagonal(&scale);
        let normal = scaling * normal * scaling;
        let inverse = normal.pseudo_inverse(SINGULAR * normal.norm()).expect("no negative limit");
        Self { start, coefficients: scaling * inverse * scaling * right }
    }

    fn at(&self, time: f64, turned: f64) -> f64 {
        self.coefficients.dot(&Vector3::new(1.0, time - self.start, turned))
    }
}
