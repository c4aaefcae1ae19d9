//! Input and output of files: rigs, scenarios, logs, calibrations and results, with a check of every unit.
//!
//! **What it does.** [`read`] converts a rig file and its log to a [`Recording`](rins_motion::Recording) in SI units and radians.
//! [`ScenarioFile`], [`ModelFile`] and [`Calibration`] are the other TOML files; [`write_file`] and [`write_folder`] write
//! results atomically. An [`IoError`] names the file, the line, the key or column, the value found and the value expected.
//!
//! **What it does not do.** It draws no conclusions from the data, and reports every repair.
//!
//! ```
//! use rins_io::quantity::kinds;
//! assert_eq!(kinds::GYRO_BIAS.parse("3600 deg/h")?, kinds::GYRO_BIAS.parse("1 deg/s")?);
//! assert_eq!(
//!     kinds::GYRO_BIAS.parse("0.05 deg/hr").unwrap_err().to_string(),
//!     "\"0.05 deg/hr\": unknown unit \"hr\"; did you mean \"h\"?",
//! );
//! # Ok::<(), rins_io::QuantityError>(())
//! ```
mod calibration;
mod campaign;
mod content;
mod document;
mod draft;
mod error;
mod input_file;
mod inputs;
mod log;
mod mission;
mod model;
mod output;
mod parameter;
mod provenance;
pub mod quantity;
mod rig;
mod run;
mod scenario;
mod section;
mod shown;
mod sound_parquet;
mod source;
mod suggestion;
mod term;
mod unfinished;
mod write;

pub use calibration::{CalibratedRange, Calibration, Covariance, Measured};
pub use campaign::{
    CampaignModel, GridCell, Heading, Identity, Journal, JournalRun, ModelRecord, PartRuns, Record,
    Row, RunRows, ScenarioGrid, write_part,
};
pub use content::TomlContent;
pub use draft::{Draft, Guess, ToFillIn, draft_rig};
pub use error::{IoError, KeyError, KeyProblem, LogError, OutputProblem, WriteProblem};
pub use input_file::InputFile;
pub use inputs::{ProtectedInputs, open as open_input, protect_inputs};
pub use log::{
    ColumnNumbers, Delimiter, Gap, LeftOut, LiveLog, Loaded, LogColumns, LogHead, LogPolicy,
    LogProblem, LogSummary, Omission, Overflow, PsinsHeader, Redivided, Rounded, TableClock,
    date_seconds, date_text, peek, read, read_columns, read_log,
};
pub use mission::{MissionFile, RotationScheme};
pub use model::ModelFile;
pub use output::{
    IntermediateFolder, Overwrite, ensure_replaceable, ensure_replaceable_folder, write_file,
    write_files, write_folder,
};
pub use parameter::{Parameter, parameters};
pub use provenance::Provenance;
pub use quantity::{Dimension, Kind, Quantity, QuantityError, Unit};
pub use rig::{
    Accuracy, AngleColumn, Axes, Coarse, ColumnSpec, Decimal, Gaps, InitialAttitude, Laboratory,
    LogFormat, LogSpec, OwnClock, Reading, Rig, RowFilter, RunIdentity, ScaledColumn, SplitTime,
    Stamp, Started, StatedRotation, Table, TableSpec, TemperatureColumn, TextForm, TimeColumn,
    TimeUnit, TriadColumns,
};
pub use scenario::ScenarioFile;
pub use shown::{one_line, shown};
pub use suggestion::nearest;
pub use unfinished::{Abandoned, abandon};
pub use write::{
    Converted, Difference, LogFile, convert, convert_changed, write_log, write_recording,
};

/// Entry points of builds for fuzzing.
#[cfg(fuzzing)]
pub mod fuzzing {
    pub use crate::source::memory::put;
}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
