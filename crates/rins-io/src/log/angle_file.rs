//! A table angle in a file with its own clock.

use std::ops::Range;
use std::path::Path;

use rins_frames::Increments;
use rins_motion::median;

use super::files::OneFile;
use super::problem::LogProblem;
use super::series::{between, smoothly_between, unwrap};
use crate::error::{IoError, LogError};
use crate::rig::AngleColumn;
use crate::shown::shown;

/// The longest interval of the readings \[s\]. The estimator uses the angle several times a second: of slower readings it would take
/// one for several.
const LONGEST_INTERVAL: f64 = 0.2;

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
/// Between two readings the angle follows the gyro about the spin axis: the difference of both is interpolated. It changes slowly
/// whatever the table does, and shows the whole turns between two readings.
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
    let mut angles = file.column(&column.column, column.factor, "rad")?;
    let path = file.path.clone();
    let times = &file.columns.time;
    for (row, pair) in times.windows(2).enumerate() {
        if pair[1] <= pair[0] {
            let problem = LogProblem::TimeNotIncreasing { before: pair[0], now: pair[1] };
            return Err(LogError::at(&path, file.columns.lines.of(row + 1), problem));
        }
    }
    let Some(interval) = median(times.windows(2).map(|pair| pair[1] - pair[0])) else {
        return Err(LogError::of(&path, LogProblem::TooShort { samples: times.len() }));
    };
    if interval > LONGEST_INTERVAL {
        let (rate, least) = (1.0 / interval, 1.0 / LONGEST_INTERVAL);
        return Err(LogError::of(&path, LogProblem::SlowTableAngle { rate, least }));
    }
    if let Some(row) = times.windows(2).position(|pair| pair[1] - pair[0] > GAP * interval) {
        let (after, length) = (times[row], times[row + 1] - times[row]);
        let problem = LogProblem::LongGap { length, after, largest: GAP * interval };
        return Err(LogError::at(&path, file.columns.lines.of(row + 1), problem));
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
    let inside: Vec<usize> =
        (0..times.len()).filter(|&row| (first..=last).contains(&times[row])).collect();
    let (Some(&from), Some(&to)) = (inside.first(), inside.last()) else {
        return Err(LogError::of(&path, LogProblem::NoOverlap { other: shown(log) }));
    };
    let times = &times[from..=to];
    let gyro = |time: f64| smoothly_between(&moments, &turned, time).unwrap_or(total);
    angles.truncate(to + 1);
    angles.drain(..from);
    let mut offsets: Vec<f64> =
        angles.iter().zip(times).map(|(angle, time)| angle - gyro(*time)).collect();
    unwrap(&mut offsets).map_err(|(row, turns)| {
        let problem = LogProblem::AmbiguousAngle { turns };
        LogError::at(&path, file.columns.lines.of(from + row), problem)
    })?;
    let (earliest, latest) =
        (times[0] - REACH * interval, times[times.len() - 1] + REACH * interval);
    let covered =
        ends.partition_point(|end| *end < earliest)..ends.partition_point(|end| *end <= latest);
    let at = |sample: usize| {
        let end = ends[sample];
        let held = if end < times[0] { offsets[0] } else { offsets[offsets.len() - 1] };
        turned[sample + 1] + between(times, &offsets, end).unwrap_or(held)
    };
    let angles = covered.clone().map(at).collect();
    Ok(OwnAngles { angles, covered, rate: 1.0 / interval })
}
