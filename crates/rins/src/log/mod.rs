//! A log with its rig file.

mod data_sheet;
mod measured;
mod range;
mod repairs;
mod setup;
mod statics;

use std::path::Path;

use rins_io::{InputFile, Loaded, LogPolicy, Rig, shown};

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

    fn of(name: String, loaded: Loaded) -> Result<Self> {
        let inputs = loaded.rig.input_files()?;
        Ok(Self { name, loaded, inputs })
    }

    /// The repairs and omissions made while reading the log, one sentence each.
    pub fn repairs(&self) -> Vec<String> {
        repairs(&self.loaded.rig, &self.loaded.summary)
    }
}
