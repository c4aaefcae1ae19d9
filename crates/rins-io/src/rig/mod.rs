//! The rig file: site, log, table and data sheets of a measurement.

mod accuracy;
mod axes;
mod formats;
mod identity;
mod imu;
mod log_keys;
mod log_spec;
mod log_times;
mod novatel;
mod place;
mod readings;
mod table;
mod table_columns;
mod time_keys;
mod tolerance;

use std::path::{Path, PathBuf};

use rins_imu::{ImuError, ImuSpec, Preset};
use rins_motion::Station;

pub use accuracy::Accuracy;
pub use axes::Axes;
pub use identity::{Laboratory, RunIdentity, Started};
pub(crate) use identity::{named, started};
pub(crate) use log_keys::KEYS as LOG_KEYS;
pub use log_spec::{
    AngleColumn, Coarse, ColumnSpec, Decimal, Gaps, LogFormat, LogSpec, OwnClock, Reading,
    RowFilter, ScaledColumn, SplitTime, Stamp, Table, TemperatureColumn, TextForm, TimeColumn,
    TimeUnit, TriadColumns,
};
pub(crate) use novatel::of_type as novatel_imu;
pub use place::InitialAttitude;
pub(crate) use place::{angles, station};
pub(crate) use table::segment;
pub use table::{StatedRotation, TableSpec};
pub(crate) use table_columns::angle_figures;

use self::readings::{ACCEL, GYRO, example};
use crate::document::Document;
use crate::error::{IoError, KeyError, KeyProblem};
use crate::section::Section;

/// The content of a rig file, in SI units and radians.
///
/// ```
/// # use std::path::Path;
/// let text = r#"
/// [site]
/// latitude = "34.25 deg"
/// longitude = "108.9 deg"
/// height = "400 m"
///
/// [log]
/// path = "run.csv"
/// time = { column = "t", unit = "s" }
/// gyro = { columns = ["gx", "gy", "gz"], unit = "deg/h" }
/// accel = { columns = ["ax", "ay", "az"], unit = "mg" }
/// "#;
/// let rig = rins_io::Rig::parse(text, Path::new("runs/rig.toml"))?;
/// assert_eq!(rig.log.path, Path::new("runs/run.csv"));
/// // The data sheet is optional, until somebody needs it:
/// assert_eq!(
///     rig.require_imu().unwrap_err().to_string(),
///     "runs/rig.toml: [imu.gyro]: missing, expected the gyros' data sheet figures noise, \
///      bias_sigma, scale_sigma and misalignment_sigma, or [imu] grade",
/// );
/// # Ok::<(), rins_io::IoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Rig {
    /// The path of the rig file.
    pub path: PathBuf,
    /// The site of the table. A PSINS log has it in its header, so its rig file may omit it.
    pub station: Option<Station>,
    /// Whether gravity is that of sea level because the rig file states neither a height nor gravity.
    pub at_sea_level: bool,
    /// The place and format of the log.
    pub log: LogSpec,
    /// The attitude of the table axis frame at table angle zero.
    pub attitude: Option<InitialAttitude>,
    /// The data sheet of the IMU.
    pub imu: Option<ImuSpec>,
    /// The grade or sensor that gives the values of the data sheet which the rig file does not state.
    pub preset: Option<&'static Preset>,
    /// The commanded motion of the table, and the wobble of its axis.
    pub table: Option<TableSpec>,
    /// From the axes that `[log]` calls the body's to those with z along the spin axis, which are
    /// the body axes everywhere else ([`Axes::spin`]).
    pub spin: Axes,
    /// Which IMU the run is of, and when it was made.
    pub run: RunIdentity,
    /// Who made it.
    pub laboratory: Laboratory,
    /// How accurate the references are: of `[table]`, `[site]` and `[log]`.
    pub accuracy: Accuracy,
    /// The largest magnitudes that are permitted of the errors, if they are stated; zero of an error without a tolerance.
    pub tolerance: Option<ImuError>,
}

/// The sections of a rig file.
pub(crate) const SECTIONS: [&str; 9] =
    ["site", "log", "attitude", "imu", "table", "axis", "run", "lab", "tolerance"];

impl Rig {
    /// Reads the rig file at `path`.
    ///
    /// # Errors
    /// [`IoError::File`] if it cannot be read, [`IoError::Key`] if a key is missing, unknown, of
    /// the wrong dimension or out of range.
    pub fn read(path: &Path) -> Result<Self, IoError> {
        Self::from_document(&Document::read(path)?)
    }

    /// The rig in `text`, parsed as the content of the file at `path`.
    ///
    /// # Errors
    /// [`IoError::Key`], as for [`Rig::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, IoError> {
        Self::from_document(&Document::parse(text, path)?)
    }

    fn from_document(document: &Document) -> Result<Self, IoError> {
        let root = Section::root(document, &SECTIONS)?;
        let log = log_keys::read(&root, folder(&document.path))?;
        let station = station(&root)?;
        if station.is_none() && !matches!(log.format, LogFormat::Psins) {
            return Err(root.missing("[site]", "latitude, and height or gravity"));
        }
        let accuracy = accuracy::read(&root)?;
        Ok(Self { station, log, accuracy, ..Self::without_log(document, &root)? })
    }

    /// All sections except the station and the log, which a scenario reads differently.
    pub(crate) fn without_log(document: &Document, root: &Section<'_>) -> Result<Self, IoError> {
        let (imu, preset) = imu::read(root)?;
        Ok(Self {
            path: document.path.clone(),
            station: None,
            at_sea_level: place::is_at_sea_level(root)?,
            log: LogSpec::nowhere(),
            attitude: place::attitude(root)?,
            imu,
            preset,
            table: table::read(root)?,
            spin: spin(root)?,
            run: identity::run(root)?,
            laboratory: identity::laboratory(root)?,
            accuracy: Accuracy::default(),
            tolerance: tolerance::read(root)?,
        })
    }

    /// The data sheet.
    ///
    /// # Errors
    /// [`IoError::Key`] if the rig has no `[imu]` section.
    pub fn require_imu(&self) -> Result<&ImuSpec, IoError> {
        let figures = "the gyros' data sheet figures noise, bias_sigma, scale_sigma and \
                       misalignment_sigma, or [imu] grade";
        self.imu.as_ref().ok_or_else(|| self.missing("[imu.gyro]", figures))
    }

    /// The attitude of the table axis frame.
    ///
    /// # Errors
    /// [`IoError::Key`] if the rig has no `[attitude]` section.
    pub fn require_attitude(&self) -> Result<&InitialAttitude, IoError> {
        self.attitude.as_ref().ok_or_else(|| self.missing("[attitude]", "roll, pitch, yaw, sigma"))
    }

    /// The site of the table.
    ///
    /// # Errors
    /// [`IoError::Key`] if the rig has no `[site]` section.
    pub fn require_station(&self) -> Result<&Station, IoError> {
        self.station
            .as_ref()
            .ok_or_else(|| self.missing("[site]", "latitude, and height or gravity"))
    }

    /// The error that the rig's log does not have three gyros and three accelerometers.
    pub(crate) fn lacks_sensors(&self) -> IoError {
        let [gyro, accel] = self.log.sensors();
        let has_none = |triad: [bool; 3]| triad == [false; 3];
        let (key, expected) = match () {
            () if has_none(gyro) => ("[log] gyro", example(&GYRO)),
            () if has_none(accel) => ("[log] accel", example(&ACCEL)),
            () if gyro != [true; 3] => ("[log] gyro.columns", "three columns".into()),
            () => ("[log] accel.columns", "three columns".into()),
        };
        self.missing(
            key,
            &format!("{expected}; of fewer sensors only the noise is estimated (rins allan)"),
        )
    }

    pub(crate) fn missing(&self, key: &str, expected: &str) -> IoError {
        let problem = KeyProblem::Missing { expected: expected.into() };
        Box::new(KeyError { path: self.path.clone(), line: None, key: key.into(), problem }).into()
    }
}

/// The folder to which paths in the file at `path` are relative.
pub(crate) fn folder(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

fn spin(root: &Section<'_>) -> Result<Axes, IoError> {
    let Some(axis) = root.section("axis", &["spin"])? else { return Ok(Axes::IDENTITY) };
    let expected = r#"a body axis such as "z" or "-x""#;
    let Some(name) = axis.text("spin", expected)? else { return Ok(Axes::IDENTITY) };
    Axes::spin(name).ok_or_else(|| axis.not_allowed("spin", expected))
}
