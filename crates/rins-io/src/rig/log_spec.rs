//! The place and format of a log.

use std::borrow::Cow;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use rins_frames::SignedAxes;

use super::axes::Axes;

/// The place and format of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct LogSpec {
    /// The log file, or that of the gyros.
    pub path: PathBuf,
    /// The format.
    pub format: LogFormat,
    /// The nominal sampling rate \[Hz\].
    pub rate: Option<f64>,
    /// From the gyros' axes to the body's.
    pub gyro_axes: Axes,
    /// From the accelerometers' axes to the body's.
    pub accel_axes: Axes,
    /// The start and end time of the part that is read, in the time of its time column; `None` for the whole log \[s\].
    pub window: Option<[f64; 2]>,
    /// The stated static intervals, in order of time \[s\].
    pub static_spans: Vec<[f64; 2]>,
}

/// The format of a log.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum LogFormat {
    /// Columns of numbers.
    Columns(Box<ColumnSpec>),
    /// A PSINS text log, whose header defines its columns.
    Psins,
}

/// The format of columns of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Table {
    /// Text, with any delimiter.
    Text,
    /// The same without column names.
    Numbers,
    /// A Parquet file.
    Parquet,
    /// Matrices in a MATLAB level 5 file.
    Mat,
    /// Rows of this number of little-endian doubles.
    Doubles(usize),
    /// NovAtel RAWIMU messages.
    NovAtel,
}

/// The form of text logs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TextForm {
    /// The decimal mark.
    pub decimal: Decimal,
    /// The number of lines before the header, or before the first row; `None` if a preamble is recognized.
    pub skip: Option<u64>,
}

impl TextForm {
    /// The form of a file that is not the log: decimals are written alike, but it has a preamble of its own.
    pub(crate) fn of_another_file(self) -> Self {
        Self { skip: None, ..self }
    }
}

/// The decimal mark of numbers in text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Decimal {
    /// A point.
    #[default]
    Point,
    /// A comma.
    Comma,
}

impl Decimal {
    /// A number in Rust's notation; the text itself if it has another decimal mark, as times of day may have.
    pub(crate) fn plain(self, text: &str) -> Cow<'_, str> {
        match self {
            Self::Comma if text.contains(',') && !text.contains('.') => {
                text.replace(',', ".").into()
            }
            _ => text.into(),
        }
    }

    /// The number in a text.
    pub(crate) fn number(self, text: &str) -> Option<f64> {
        match self {
            Self::Comma if text.contains('.') => None,
            _ => self.plain(text).parse().ok(),
        }
    }
}

/// The assignment of columns.
///
/// A column is named by its header or, if there is none, by its number from "1"; in a MATLAB
/// file as `imu(:,1)`.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnSpec {
    /// The format of the columns.
    pub table: Table,
    /// The form of text.
    pub text: TextForm,
    /// The time; without it, the sampling rate is the nominal rate.
    pub time: Option<TimeColumn>,
    /// The gyros.
    pub gyro: TriadColumns,
    /// The accelerometers.
    pub accel: TriadColumns,
    /// The accelerometers' own clock, if they have one.
    pub accel_clock: Option<OwnClock>,
    /// The measured table angle.
    pub table_angle: Option<AngleColumn>,
    /// The table's mean rate over each interval \[rad/s\]; the sign of its factor as for the angle.
    pub table_rate: Option<ScaledColumn>,
    /// The temperature.
    pub temperature: Option<TemperatureColumn>,
    /// The meaning of the increment after a gap; needed only if increments have gaps.
    pub gaps: Option<Gaps>,
}

/// The time column.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeColumn {
    /// Its name; that of the first column, if the time is in two.
    pub column: String,
    /// Its unit; seconds, if the time is in two columns.
    pub unit: TimeUnit,
    /// The second column of a time in two columns.
    pub split: Option<SplitTime>,
    /// The instant of a sample's interval that it refers to.
    pub stamp: Stamp,
}

/// The second of the two columns whose sum is the time.
#[derive(Clone, Debug, PartialEq)]
pub struct SplitTime {
    /// The unit of the first column.
    pub coarse: Coarse,
    /// The name of the second column.
    pub column: String,
    /// The number of units of the second column in a second.
    pub per_second: i64,
}

/// The unit of the first of the two columns of a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coarse {
    /// This number of seconds, of which the column has whole numbers.
    Seconds(i64),
    /// The day of a date in text.
    Date,
}

/// The clock of a file that was not sampled together with the gyros' file.
///
/// Its increments are resampled to the gyros' intervals.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnClock {
    /// Its time column.
    pub time: TimeColumn,
    /// Its reading when the gyros' clock reads zero \[s\].
    pub offset: f64,
}

/// The unit of a time column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeUnit {
    /// This number of seconds.
    Seconds(f64),
    /// Samples at the nominal rate.
    Samples,
}

impl TimeUnit {
    /// One unit \[s\]; `None` if it is samples.
    pub fn seconds(self) -> Option<f64> {
        match self {
            Self::Seconds(seconds) => Some(seconds),
            Self::Samples => None,
        }
    }
}

impl Table {
    /// The most likely format of the columns of a file with this name.
    pub(crate) fn of(path: &Path) -> Self {
        let ending = path.extension().map(OsStr::to_ascii_lowercase);
        match ending.as_ref().and_then(|ending| ending.to_str()) {
            Some("parquet") => Self::Parquet,
            Some("mat") => Self::Mat,
            _ => Self::Text,
        }
    }
}

/// The instant of a sample's interval that a time stamp refers to.
///
/// It does not affect the IMU's increments, only the table angle: a row
/// gives the angle at its stamp, and a recording needs it at the end of the interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stamp {
    /// The start.
    Start,
    /// The middle.
    Middle,
    /// The end.
    End,
}

/// The meaning of the increment after a gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gaps {
    /// The increment over the whole gap: the sensor continued to accumulate.
    Accumulated,
    /// The increment over its own interval; its mean rate is then held over the gap.
    Held,
}

/// The kind of a sensor's numbers, with the value of their unit in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reading {
    /// Mean rates over an interval: angular rate or specific force.
    Rate(f64),
    /// Increments over an interval: angle or velocity.
    Increment(f64),
}

/// The rows of a log that belong to one sensor: those with this text in this column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowFilter {
    /// The name of the column.
    pub column: String,
    /// Its text in the rows that are read.
    pub value: String,
}

/// The three columns of a triad: value = (number − offset) × scale, in the reading's unit.
#[derive(Clone, Debug, PartialEq)]
pub struct TriadColumns {
    /// The file with these columns.
    pub path: PathBuf,
    /// Their names; `None` for a sensor that the log does not have.
    pub columns: [Option<String>; 3],
    /// The kind and unit of the numbers.
    pub reading: Reading,
    /// Subtracted from the numbers.
    pub offset: [f64; 3],
    /// The factor of the differences.
    pub scale: [f64; 3],
    /// The rows with its samples, if the file has rows of several sensors.
    pub rows: Option<RowFilter>,
}

/// The table angle's column.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleColumn {
    /// The file and its clock, if it is not the log's.
    pub file: Option<(PathBuf, OwnClock)>,
    /// Its name; empty if there is no column to read, as in a scenario.
    pub column: String,
    /// The value of its unit \[rad\]; negative if the table counts opposite to the body's rotation.
    pub factor: f64,
    /// The standard deviation of the angle's white noise \[rad\].
    pub noise: Option<f64>,
    /// The angle's least significant bit \[rad\].
    pub resolution: Option<f64>,
    /// The latency \[s\]: the angle in a row at time t is that at t − latency. The reader does
    /// not correct it.
    pub latency: Option<f64>,
}

/// A column whose numbers are multiplied by a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaledColumn {
    /// Its name.
    pub column: String,
    /// The value of its unit in SI units.
    pub factor: f64,
}

/// The temperature column, optionally in a file of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct TemperatureColumn {
    /// The file and its time column, if they are not those of the log.
    pub file: Option<(PathBuf, TimeColumn)>,
    /// The name of the column.
    pub column: String,
    /// The offset added to the numbers to get degrees Celsius.
    pub offset: f64,
}

impl LogSpec {
    /// A log without file or columns.
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

    /// The table angle's column, with its errors.
    pub fn table_angle(&self) -> Option<&AngleColumn> {
        match &self.format {
            LogFormat::Columns(columns) => columns.table_angle.as_ref(),
            LogFormat::Psins => None,
        }
    }
}

impl TriadColumns {
    /// The names of the columns that the log has.
    pub fn names(&self) -> impl Iterator<Item = &String> {
        self.columns.iter().flatten()
    }

    /// A triad of which the log has no sensor, beside another.
    pub(super) fn absent(beside: &Self) -> Self {
        Self {
            columns: [const { None }; 3],
            offset: [0.0; 3],
            scale: [1.0; 3],
            rows: None,
            reading: Reading::Rate(1.0),
            path: beside.path.clone(),
        }
    }
}

impl LogSpec {
    /// Which of the gyros and which of the accelerometers the log has, along the body axes that `[log]` names.
    pub fn sensors(&self) -> [[bool; 3]; 2] {
        let LogFormat::Columns(columns) = &self.format else { return [[true; 3]; 2] };
        let of = |triad: &TriadColumns, axes: &Axes| {
            let SignedAxes { source, .. } = (*axes).into();
            source.map(|sensor| triad.columns[sensor].is_some())
        };
        [of(&columns.gyro, &self.gyro_axes), of(&columns.accel, &self.accel_axes)]
    }

    /// Whether the log has three gyros and three accelerometers.
    pub fn is_complete(&self) -> bool {
        self.sensors() == [[true; 3]; 2]
    }
}
