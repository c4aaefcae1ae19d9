//! A log with the rig file that describes it.

mod range;
mod repairs;
mod setup;
mod statics;

use std::path::Path;

use rins_io::{Loaded, shown};

pub(crate) use self::range::{Beyond, beyond, covered, ensure_temperature};
pub use self::range::{OutsideRange, OutsideRate, OutsideTemperature};
pub(crate) use self::repairs::{repairs, with_repairs};
pub(crate) use self::setup::{setup, setup_at, table_accuracy};
pub use self::statics::StaticIntervalResult;
pub(crate) use self::statics::{
    lasting, longest, none_found, only, static_intervals, statics_in_words, statics_result,
};
use crate::error::Result;

/// A bias of more than so many sigmas of the data sheet is told.
pub(crate) const BEYOND_DATA_SHEET: f64 = 4.0;

/// A log with the rig file that describes it: what every job works on.
#[derive(Clone, Debug)]
pub struct Log {
    /// What it is called: the path of its rig file.
    pub name: String,
    /// The content of both files, in SI units, and what reading them has repaired.
    pub loaded: Loaded,
}

impl Log {
    /// Reads a rig file and the log that it names.
    ///
    /// # Errors
    /// If either cannot be read or says something wrong: file, line or key, the value, and what was expected.
    pub fn open(rig: impl AsRef<Path>) -> Result<Self> {
        let rig = rig.as_ref();
        Ok(Self { name: shown(rig), loaded: rins_io::read(rig)? })
    }

    /// What reading the log has repaired or left out, each in a sentence.
    pub fn repairs(&self) -> Vec<String> {
        repairs(&self.loaded.rig, &self.loaded.summary)
    }
}
