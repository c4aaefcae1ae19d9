//! The findings while reading a log.

use std::path::PathBuf;

use super::overflow::Overflow;
use crate::rig::StatedRotation;

/// The limits that a log must keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogPolicy {
    /// The longest accepted gap between two samples \[s\].
    ///
    /// Over a shorter gap the mean rate of the sample at its end is held.
    pub largest_gap: f64,
    /// The maximum accepted fraction of the gaps in a log's time.
    pub largest_loss: f64,
    /// Whether a log of fewer than three gyros and three accelerometers is accepted. The readings of the absent sensors are then
    /// zero; [`LogSpec::sensors`](crate::LogSpec::sensors) tells which.
    pub incomplete: bool,
}

impl Default for LogPolicy {
    fn default() -> Self {
        Self { largest_gap: 1.0, largest_loss: 0.5, incomplete: false }
    }
}

/// The findings while reading a log.
#[derive(Clone, Debug, PartialEq)]
pub struct LogSummary {
    /// The number of samples.
    pub samples: usize,
    /// The nominal interval \[s\]: that of the rig, otherwise the median.
    pub nominal_interval: f64,
    /// The rms difference of the intervals that are not gaps from the nominal interval \[s\].
    pub jitter_rms: f64,
    /// The steps longer than one and a half nominal intervals.
    pub gaps: Vec<Gap>,
    /// The omitted lines, file by file.
    pub left_out: Vec<LeftOut>,
    /// The origin that is added to a recording's times to get those of the log \[s\]. It is zero
    /// unless the log's times are so large that a double would lose nanoseconds.
    pub time_origin: f64,
    /// The resampling of accelerometers with a clock of their own.
    pub redivided: Option<Redivided>,
    /// The overflows of the time column over which it is continued.
    pub overflows: Vec<Overflow>,
    /// The even clock whose stamps replace rounded ones.
    pub rounded: Option<Rounded>,
    /// The number of ramps between the rates of a commanded profile whose shape is taken from the gyro about the axis instead of
    /// the profile.
    pub ramps: usize,
    /// A table angle in a file with its own clock.
    pub table_clock: Option<TableClock>,
    /// The rotations between readings of a table angle that is not read in every row; [`Loaded::rotations`](crate::Loaded::rotations)
    /// has them in the end.
    pub(crate) rotations: Vec<StatedRotation>,
}

/// The rounded time stamps of an even clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded {
    /// The rounding unit \[s\].
    pub unit: f64,
    /// The interval of the clock \[s\].
    pub interval: f64,
}

/// Readings of a table angle with its own clock, which are interpolated with the gyro about the spin axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableClock {
    /// The rate of the readings \[Hz\].
    pub rate: f64,
    /// The number of samples that are left out, because they are outside of the readings.
    pub left_out: usize,
}

/// The resampling of one clock's samples to the intervals of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Redivided {
    /// The number of samples before.
    pub samples: usize,
    /// The number of samples of the other clock that are omitted because they are outside of these.
    pub left_out: usize,
    /// The duration of the omitted samples at the start \[s\].
    pub late: f64,
}

/// A line that is not a sample of the recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// The line, from 1; the row if a file has no lines.
    pub path: PathBuf,
    /// The line, from 1; the row where a file has no lines.
    pub line: u64,
    /// The reason.
    pub reason: Omission,
}

/// The reason why a line is omitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Omission {
    /// It repeats the previous line including its time stamp, as some loggers do.
    Repeated,
    /// It is the last line and has no line end: its last number may be truncated.
    Unfinished,
    /// It cannot be read, or the row of the same sample in another file cannot.
    Damaged,
    /// All six readings are exactly zero: an empty message of a driver, as no accelerometers on Earth read.
    Empty,
}

/// A gap in a log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The index of the sample whose interval contains it.
    pub sample: usize,
    /// The line at its end.
    pub line: u64,
    /// The time of the previous line \[s\].
    pub after: f64,
    /// The time from the previous line to the line at its end \[s\].
    pub length: f64,
    /// Whether all its samples are damaged rows, which the sensor did not accumulate in the next one.
    pub damaged: bool,
}

impl LogSummary {
    /// A summary of samples without jitter or gaps.
    pub(super) fn even(samples: usize, nominal_interval: f64) -> Self {
        Self {
            samples,
            nominal_interval,
            jitter_rms: 0.0,
            gaps: Vec::new(),
            left_out: Vec::new(),
            time_origin: 0.0,
            redivided: None,
            overflows: Vec::new(),
            rounded: None,
            table_clock: None,
            rotations: Vec::new(),
            ramps: 0,
        }
    }
}
