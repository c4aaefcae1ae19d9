//! Where a log is and how it is to be read.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::axes::Axes;

/// Where a log is and how it is to be read.
#[derive(Clone, Debug, PartialEq)]
pub struct LogSpec {
    /// The log, or the gyros' part of it.
    pub path: PathBuf,
    /// How it is written.
    pub format: LogFormat,
    /// The nominal sampling rate \[Hz\].
    pub rate: Option<f64>,
    /// From the gyros' axes to the body's.
    pub gyro_axes: Axes,
    /// From the accelerometers' axes to the body's.
    pub accel_axes: Axes,
    /// The times from and to which the log is read, if not all of it is \[s\]: those of its time column.
    pub window: Option<[f64; 2]>,
    /// The static intervals that are stated, in order of time \[s\].
    pub static_spans: Vec<[f64; 2]>,
}

/// How a log is written.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum LogFormat {
    /// Columns of numbers.
    Columns(Box<ColumnSpec>),
    /// A PSINS text log, whose header says what its columns are.
    Psins,
}

/// How columns of numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Table {
    /// Text, with any delimiter.
    Text,
    /// The same without names of columns.
    Numbers,
    /// A Parquet file.
    Parquet,
    /// Matrices in a MATLAB level 5 file.
    Mat,
    /// Rows of so many little-endian doubles.
    Doubles(usize),
    /// NovAtel's RAWIMU messages.
    NovAtel,
}

/// What stands in which column.
///
/// A column is named by its header or, where there is none, by its place from "1"; in a MATLAB
/// file as `imu(:,1)`.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnSpec {
    /// How the columns are written.
    pub table: Table,
    /// The time; without it samples follow each other at the nominal rate.
    pub time: Option<TimeColumn>,
    /// The gyros.
    pub gyro: TriadColumns,
    /// The accelerometers.
    pub accel: TriadColumns,
    /// The accelerometers' own clock, if they have one.
    pub accel_clock: Option<OwnClock>,
    /// The measured table angle.
    pub table_angle: Option<AngleColumn>,
    /// The table's mean rate over each interval \[rad/s\]; its factor's sign as the angle's.
    pub table_rate: Option<ScaledColumn>,
    /// The temperature.
    pub temperature: Option<TemperatureColumn>,
    /// What the increment after a gap stands for; needed only if increments have gaps.
    pub gaps: Option<Gaps>,
}

/// The time column.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeColumn {
    /// Its name.
    pub column: String,
    /// What it counts.
    pub unit: TimeUnit,
    /// Which instant of a sample's interval it tells.
    pub stamp: Stamp,
}

/// The clock of a file that was not sampled together with the gyros'.
///
/// Its increments are divided anew at the ends of the gyros' intervals.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnClock {
    /// Its time column.
    pub time: TimeColumn,
    /// What it shows when the gyros' clock shows zero \[s\].
    pub offset: f64,
}

/// What a time column counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeUnit {
    /// So many seconds.
    Seconds(f64),
    /// Samples at the nominal rate.
    Samples,
}

impl TimeUnit {
    /// One unit \[s\]; `None` where samples are counted.
    pub fn seconds(self) -> Option<f64> {
        match self {
            Self::Seconds(seconds) => Some(seconds),
            Self::Samples => None,
        }
    }
}

impl Table {
    /// How the columns of a file of this name are most likely written.
    pub(crate) fn of(path: &Path) -> Self {
        let ending = path.extension().map(OsStr::to_ascii_lowercase);
        match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("parquet") => Self::Parquet,
            Some("mat") => Self::Mat,
            _ => Self::Text,
        }
    }
}

/// Which instant of a sample's interval a time stamp tells.
///
/// What the IMU measured does not depend on it, only what the table angle was at that time: a row
/// says what the angle was at its stamp, and a recording wants it at the end of the interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stamp {
    /// Its start.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// What the increment after a gap stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gaps {
    /// The whole gap: the sensor went on summing.
    Accumulated,
    /// Its own interval; its mean is then held over the gap.
    Held,
}

/// What a sensor's numbers are, with the SI units in one of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reading {
    /// Mean rates over an interval: angular rate or specific force.
    Rate(f64),
    /// Increments over an interval: angle or velocity.
    Increment(f64),
}

/// The three columns of a triad: value = (number − offset) × scale, in the reading's unit.
#[derive(Clone, Debug, PartialEq)]
pub struct TriadColumns {
    /// The file they stand in.
    pub path: PathBuf,
    /// Their names.
    pub columns: [String; 3],
    /// What the numbers are.
    pub reading: Reading,
    /// Subtracted from the numbers.
    pub offset: [f64; 3],
    /// What the differences are multiplied by.
    pub scale: [f64; 3],
}

/// The table angle's column.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleColumn {
    /// Its name; empty where there is no column to read, as in a scenario.
    pub column: String,
    /// One of its numbers \[rad\]; less than zero if the table counts against the body's turn.
    pub factor: f64,
    /// The standard deviation of the angle's white noise \[rad\].
    pub noise: Option<f64>,
    /// The angle's least significant bit \[rad\].
    pub resolution: Option<f64>,
    /// By how much it is late \[s\]: the angle told at t is that of t − latency. The reader does
    /// not undo this.
    pub latency: Option<f64>,
}

/// A column whose numbers are multiplied by a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaledColumn {
    /// Its name.
    pub column: String,
    /// The SI units in one of its numbers.
    pub factor: f64,
}

/// The temperature's column, perhaps in a file of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct TemperatureColumn {
    /// The file and its time column, where they are not the log's.
    pub file: Option<(PathBuf, TimeColumn)>,
    /// The name of the column.
    pub column: String,
    /// Added to the numbers to have degrees Celsius.
    pub offset: f64,
}

impl LogSpec {
    /// A log that is not yet anywhere.
    pub(crate) fn nowhere() -> Self {
        Self {
            path: PathBuf::new(),
            format: LogFormat::Psins,
            rate: None,
            gyro_axes: Axes::IDENTITY,
            accel_axes: Axes::IDENTITY,
            window: None,
            static_spans: Vec::new(),
        }
    }

    /// The table angle's column, with what is known of its errors.
    pub fn table_angle(&self) -> Option<&AngleColumn> {
        match &self.format {
            LogFormat::Columns(columns) => columns.table_angle.as_ref(),
            LogFormat::Psins => None,
        }
    }
}
