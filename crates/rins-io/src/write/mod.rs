//! Output of recordings as logs in the formats of other software, with their rig files.

mod compare;
mod convert;
mod csv;
mod doubles;
mod euroc;
mod exact;
mod failure;
mod kf_gins;
mod mat;
mod parquet;
mod psins;
pub(crate) mod rig_text;
mod signals;

use std::ffi::OsStr;
use std::io::Write;
use std::path::{Path, PathBuf};

pub use compare::Difference;
pub use convert::{Converted, convert, convert_changed};
pub use csv::write_recording;
use rins_frames::InFrame;
use rins_motion::Recording;

use self::failure::Failure;
use crate::error::IoError;
use crate::log::Loaded;
use crate::rig::Axes;

/// A format for the output of logs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LogFile {
    /// Text with a header, in SI units and radians.
    Csv,
    /// A Parquet file with the same columns.
    Parquet,
    /// A MATLAB level 5 file with the vector `time` and the matrices `gyro` and `accel`.
    Mat,
    /// A PSINS text log.
    Psins,
    /// PSINS rows `[wm vm t]` of doubles.
    PsinsBinary,
    /// KF-GINS text.
    KfGins,
    /// Text of the EuRoC data set, which Kalibr also uses.
    Euroc,
}

impl LogFile {
    /// All formats.
    pub const ALL: [Self; 7] = [
        Self::Csv,
        Self::Parquet,
        Self::Mat,
        Self::Psins,
        Self::PsinsBinary,
        Self::KfGins,
        Self::Euroc,
    ];

    /// Its name in a rig file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Parquet => "parquet",
            Self::Mat => "mat",
            Self::Psins => "psins",
            Self::PsinsBinary => "psins-bin",
            Self::KfGins => "kf-gins",
            Self::Euroc => "euroc",
        }
    }

    /// The format with this name in a rig file.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.name() == name)
    }

    /// The format that follows from a file's name; `None` if it is ambiguous.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension().map(OsStr::to_ascii_lowercase);
        match ending.as_ref().and_then(|ending| ending.to_str())? {
            "csv" => Some(Self::Csv),
            "parquet" => Some(Self::Parquet),
            "mat" => Some(Self::Mat),
            "imu" => Some(Self::Psins),
            "bin" => Some(Self::PsinsBinary),
            _ => None,
        }
    }

    /// Whether it can contain a table angle or rate, and a temperature.
    pub const fn holds_more_than_the_imu(self) -> bool {
        matches!(self, Self::Csv | Self::Parquet | Self::Mat)
    }
}

/// Changes the readings of a run with these axes to the sensors' own axes: exact, because axes are only permuted and reversed.
pub(crate) fn to_own_axes(recording: &mut Recording, spin: &Axes) {
    let back = spin.inverse();
    for sample in &mut recording.increments {
        sample.angle = InFrame::from_components(back.apply(sample.angle.components()));
        sample.velocity = InFrame::from_components(back.apply(sample.velocity.components()));
    }
}

/// Writes a recording as a log of this format.
///
/// Every number is written such that it is read as the same number, if the format can represent it.
///
/// # Errors
/// [`IoError::Write`] if the format cannot represent it, [`IoError::File`] on a system error.
pub fn write_log(
    loaded: &Loaded,
    format: LogFile,
    path: &Path,
    out: &mut (dyn Write + Send),
) -> Result<(), IoError> {
    let recording = &loaded.recording;
    let done = match format {
        LogFile::Csv => write_recording(recording, out).map_err(Failure::from),
        LogFile::Parquet => parquet::write(recording, out),
        LogFile::Mat => mat::write(recording, out),
        LogFile::Psins => psins::write(loaded, out),
        LogFile::PsinsBinary => doubles::write(recording, out).map_err(Failure::from),
        LogFile::KfGins => kf_gins::write(recording, out).map_err(Failure::from),
        LogFile::Euroc => euroc::write(loaded, out),
    };
    done.map_err(|failure| match failure {
        Failure::System(source) => IoError::file("write", path)(source),
        Failure::Problem(problem) => IoError::Write { path: PathBuf::from(path), problem },
    })
}
