//! What reading a log has shown.

use std::path::PathBuf;

use super::overflow::Overflow;

/// What a log may do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogPolicy {
    /// The longest gap between two samples that is accepted \[s\].
    ///
    /// Over a shorter one the mean rate of the sample that ends it is held.
    pub largest_gap: f64,
    /// The largest share of a log's time that its gaps may be.
    pub largest_loss: f64,
}

impl Default for LogPolicy {
    fn default() -> Self {
        Self { largest_gap: 1.0, largest_loss: 0.5 }
    }
}

/// What reading a log has shown.
#[derive(Clone, Debug, PartialEq)]
pub struct LogSummary {
    /// The number of samples.
    pub samples: usize,
    /// The nominal interval \[s\]: the rig's, or else the median.
    pub nominal_interval: f64,
    /// How much the intervals that are not gaps differ from it, rms \[s\].
    pub jitter_rms: f64,
    /// The steps longer than one and a half nominal intervals.
    pub gaps: Vec<Gap>,
    /// The lines that are left out, file by file.
    pub left_out: Vec<LeftOut>,
    /// What is to be added to a recording's times to have those of the log \[s\]. It is zero
    /// unless the log counts from so long ago that a double would lose nanoseconds.
    pub time_origin: f64,
    /// What became of accelerometers that have a clock of their own.
    pub redivided: Option<Redivided>,
    /// The overflows of the time column over which it is continued.
    pub overflows: Vec<Overflow>,
    /// The even clock whose stamps stand in the place of rounded ones.
    pub rounded: Option<Rounded>,
    /// How many ramps between the rates of a commanded profile are shaped as the gyro about the axis shows them, and not
    /// as the profile says.
    pub ramps: usize,
}

/// Time stamps that are those of an even clock, rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded {
    /// What they were rounded to \[s\].
    pub unit: f64,
    /// The interval of the clock \[s\].
    pub interval: f64,
}

/// Samples of one clock that were divided anew at the ticks of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Redivided {
    /// How many samples there were.
    pub samples: usize,
    /// How many samples of the other clock are left out, because they lie outside of these.
    pub left_out: usize,
    /// How long those last that are left out at the start \[s\].
    pub late: f64,
}

/// A line that is no sample of the recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1; the row where a file has no lines.
    pub line: u64,
    /// Why it is left out.
    pub reason: Omission,
}

/// Why a line is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Omission {
    /// It repeats, time stamp and all, the one before it, as some loggers do.
    Repeated,
    /// It is the last one and has no line end: its last number may be cut short and still be one.
    Unfinished,
}

/// A gap in a log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The index of the sample whose interval holds it.
    pub sample: usize,
    /// The line that ends it.
    pub line: u64,
    /// The time of the line before \[s\].
    pub after: f64,
    /// From there to the line that ends it \[s\].
    pub length: f64,
}

impl LogSummary {
    /// Of samples without jitter or gaps.
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
            ramps: 0,
        }
    }
}
