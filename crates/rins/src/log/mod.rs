//! A log with its rig file.

mod data_sheet;
mod measured;
mod range;
mod repairs;
mod setup;
mod statics;

use std::path::Path;

use rins_io::{InputFile, Loaded, LogColumns, LogPolicy, Rig, shown};

pub(crate) use self::data_sheet::DataSheet;
pub(crate) use self::measured::{measured, measured_together};
pub(crate) use self::range::{Beyond, DAY, beyond, covered, ensure_temperature};
pub use self::range::{OutsideRange, OutsideRate, OutsideTemperature};
pub(crate) use self::repairs::{repairs, with_repairs};
pub(crate) use self::setup::{setup, setup_at, site_assumption, table_accuracy};
pub use self::statics::StaticIntervalResult;
pub(crate) use self::statics::{
    lasting, longest, none_found, only, static_intervals, statics_in_words, statics_result,
};
use crate::error::Result;

/// A bias that exceeds this number of sigmas of the data sheet is reported.
pub(crate) const BEYOND_DATA_SHEET: f64 = 4.0;

/// A log with its rig file: the input of every job.
#[derive(Clone, Debug)]
pub struct Log {
    /// The name: the path of the rig file.
    pub name: String,
    /// The content of both files in SI units, and the repairs made while reading.
    pub loaded: Loaded,
    /// The files that were read: the rig file and those of the log.
    pub inputs: Vec<InputFile>,
}

impl Log {
    /// Reads a rig file and the log that it names.
    ///
    /// # Errors
    /// If a file cannot be read or has an invalid value; the error states file, line or key, the value, and the expected value.
    pub fn open(rig: impl AsRef<Path>) -> Result<Self> {
        let rig = rig.as_ref();
        Self::of(shown(rig), rins_io::read(rig)?)
    }

    /// Reads a rig file and a log that may have fewer than three gyros and three accelerometers, for [`allan`](crate::allan()).
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn open_partial(rig: impl AsRef<Path>) -> Result<Self> {
        let rig = rig.as_ref();
        let policy = LogPolicy { incomplete: true, ..LogPolicy::default() };
        Self::of(shown(rig), rins_io::read_log(Rig::read(rig)?, policy)?)
    }

    /// The rig in `text`, the content of a rig file, with its log in memory.
    ///
    /// `[log]` in `text` states the names, units and axes of the columns; `path` is the name of the rig in messages and the folder
    /// of other files that it names. The columns are checked as those of a file are, and results state their SHA-256.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    ///
    /// ```
    /// use rins::io::{ColumnNumbers, LogColumns};
    /// let rig = r#"
    /// [site]
    /// latitude = "34.25 deg"
    /// height = "400 m"
    /// [log]
    /// path = "arrays"
    /// format = "csv"
    /// time = { column = "t", unit = "s" }
    /// gyro = { columns = ["gx", "gy", "gz"], unit = "deg/h" }
    /// accel = { columns = ["ax", "ay", "az"], unit = "g" }
    /// "#;
    /// let times = (1..=100).map(|k| 0.01 * f64::from(k));
    /// let mut columns = LogColumns::new("arrays");
    /// columns.push("t", ColumnNumbers::Real(times.clone().collect()));
    /// for (name, level) in [("gx", 0.0), ("gy", 12.4), ("gz", 8.5), ("ax", 0.0), ("ay", 0.0), ("az", 1.0)] {
    ///     columns.push(name, ColumnNumbers::Real(times.clone().map(|t| level + 0.001 * t).collect()));
    /// }
    /// let log = rins::Log::of_columns(rig, "rig.toml", columns)?;
    /// assert_eq!(log.loaded.recording.len(), 100);
    /// # Ok::<(), rins::Error>(())
    /// ```
    pub fn of_columns(text: &str, path: impl AsRef<Path>, columns: LogColumns) -> Result<Self> {
        let path = path.as_ref();
        let inputs = vec![InputFile::of_content(path, text.as_bytes()), columns.digest()];
        let loaded = rins_io::read_columns(Rig::parse(text, path)?, columns, LogPolicy::default())?;
        Ok(Self { name: shown(path), loaded, inputs })
    }

    fn of(name: String, loaded: Loaded) -> Result<Self> {
        let inputs = loaded.rig.input_files()?;
        Ok(Self { name, loaded, inputs })
    }

    /// The repairs and omissions made while reading the log, one sentence each.
    pub fn repairs(&self) -> Vec<String> {
        repairs(&self.loaded.rig, &self.loaded.summary)
    }
}
