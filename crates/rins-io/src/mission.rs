//! Mission files: a system in service, the schemes of its table, and its errors.

mod carrier;

use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::{Path, PathBuf};

use rins_frames::{Dcm, Nav, Table};
use rins_imu::{ImuError, ImuSpec, TriadError};
use rins_motion::{Carrier, Segment, Station};

use crate::document::Document;
use crate::error::IoError;
use crate::parameter::{self, LeftOut};
use crate::quantity::kinds;
use crate::rig::{self, Rig};
use crate::section::{Section, quoted, such_as};

/// The maximum number of output times.
const MOST_TIMES: f64 = 100_000.0;

/// The sampling rate of strapdown navigation if none is stated \[Hz\].
const SAMPLE_RATE: f64 = 50.0;

/// The interval of the results if none is stated \[s\].
const INTERVAL: f64 = 3600.0;

/// The content of a mission file: `[site]`, `[attitude]`, `[imu]`, `[mission]`, `[carrier]`,
/// `[errors]` and a `[[scheme]]` for each scheme.
///
/// ```
/// # use std::path::Path;
/// let text = r#"
/// [site]
/// latitude = "45 deg"
/// longitude = "0 deg"
/// height = "0 m"
///
/// [mission]
/// duration = "24 h"
///
/// [[scheme]]
/// name = "reciprocating"
/// rate = "6 deg/s"
///
/// [errors]
/// gyro = { bias = ["0.01 deg/h", "0.01 deg/h", "0.01 deg/h"] }
/// "#;
/// let file = rins_io::MissionFile::parse(text, Path::new("mission.toml"))?;
/// assert_eq!((file.times.len(), file.schemes[0].cycle.len()), (24, 2));
/// # Ok::<(), rins_io::IoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MissionFile {
    /// The mission file.
    pub path: PathBuf,
    /// The site at which the mission begins.
    pub station: Station,
    /// The carrier's motion, if it is not at rest.
    pub carrier: Option<Carrier>,
    /// The attitude of the axis frame on a carrier that heads north; upright, with x to the right, if none is stated.
    pub nav_from_table: Dcm<Nav, Table>,
    /// The 1σ of the initial attitude error about each axis \[rad\]; zero if no attitude is stated.
    pub attitude_sigma: f64,
    /// The times of the results since the start \[s\].
    pub times: Vec<f64>,
    /// The interval of strapdown navigation \[s\].
    pub sample_interval: f64,
    /// The schemes.
    pub schemes: Vec<RotationScheme>,
    /// The errors of the sensors, if they are stated.
    pub errors: Option<ImuError>,
    /// The data sheet, if it is stated.
    pub imu: Option<ImuSpec>,
}

/// A scheme of rotation, which repeats.
#[derive(Clone, Debug, PartialEq)]
pub struct RotationScheme {
    /// Its name.
    pub name: String,
    /// One cycle of it.
    pub cycle: Vec<Segment>,
    /// Whether the table is isolated from the carrier's heading.
    pub stabilized: bool,
}

/// The expected form of a profile, for an error message.
const PROFILE: &str = r#"a list such as [{ rate = "6 deg/s", duration = "60 s" }]"#;

/// The names of the schemes that need no profile.
const NAMED: [&str; 4] = ["static", "continuous", "reciprocating", "four-position"];

impl MissionFile {
    /// Reads the mission file at `path`.
    ///
    /// # Errors
    /// [`IoError::File`] if it cannot be read, [`IoError::Key`] if a key is missing, unknown, of the wrong dimension or out of range.
    pub fn read(path: &Path) -> Result<Self, IoError> {
        Self::from_document(&Document::read(path)?)
    }

    /// The mission in `text`, parsed as the content of the file at `path`.
    ///
    /// # Errors
    /// [`IoError::Key`], as for [`MissionFile::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, IoError> {
        Self::from_document(&Document::parse(text, path)?)
    }

    fn from_document(document: &Document) -> Result<Self, IoError> {
        let known = ["site", "attitude", "imu", "mission", "carrier", "scheme", "errors"];
        let root = Section::root(document, &known)?;
        let Some(station) = rig::station(&root)? else {
            return Err(root.missing("[site]", "latitude, longitude and height"));
        };
        let rig = Rig::without_log(document, &root)?;
        let Some(mission) = root.section("mission", &["duration", "interval", "sample_rate"])?
        else {
            return Err(root.missing("[mission]", such_as(&kinds::DURATION)));
        };
        let duration = mission.require_quantity("duration", &kinds::DURATION)?;
        let stated = mission.quantity("interval", &kinds::DURATION)?;
        let interval = stated.unwrap_or(INTERVAL).min(duration);
        let count = (duration / interval * (1.0 + 1e-12)).floor();
        if count > MOST_TIMES {
            let reason = format!(
                "the duration is {count:.0} intervals; at most {MOST_TIMES:.0} are possible"
            );
            return Err(mission.conflict("interval", reason));
        }
        let mut times = Vec::new();
        while (times.len() as f64) < count {
            times.push(interval * (times.len() + 1) as f64);
        }
        let sample_rate =
            mission.quantity("sample_rate", &kinds::SAMPLE_RATE)?.unwrap_or(SAMPLE_RATE);
        let carrier = match root.section("carrier", &carrier::KEYS)? {
            None => None,
            Some(section) => Some(carrier::read(&section, duration)?),
        };
        let keys = ["name", "rate", "dwell", "profile", "stabilized"];
        let tables = root.tables("scheme", &keys)?.unwrap_or_default();
        if tables.is_empty() {
            return Err(root.missing("[[scheme]]", scheme_names()));
        }
        let mut schemes: Vec<RotationScheme> = Vec::new();
        for table in &tables {
            let scheme = scheme(table)?;
            if scheme.stabilized && carrier.is_none() {
                return Err(table.conflict("stabilized", "there is no [carrier] that turns"));
            }
            if schemes.iter().any(|other| other.name == scheme.name) {
                return Err(table.conflict("name", "another scheme has this name"));
            }
            schemes.push(scheme);
        }
        let errors = match root.section("errors", &["gyro", "accel"])? {
            None => None,
            Some(errors) => {
                let triad = |key: &str, keys: &parameter::TriadKeys| {
                    let section = errors.section(key, &parameter::KEYS)?;
                    let read = |section| parameter::read(&section, keys, LeftOut::Zero);
                    section.map_or_else(|| Ok(TriadError::default()), read)
                };
                let gyro = triad("gyro", &parameter::GYRO)?;
                Some(ImuError { gyro, accel: triad("accel", &parameter::ACCEL)? })
            }
        };
        let nav_from_table =
            rig.attitude.as_ref().map_or_else(Dcm::identity, |attitude| attitude.angles.dcm());
        Ok(Self {
            path: document.path.clone(),
            station,
            nav_from_table,
            attitude_sigma: rig.attitude.map_or(0.0, |attitude| attitude.sigma),
            times,
            carrier,
            sample_interval: 1.0 / sample_rate,
            schemes,
            errors,
            imu: rig.imu,
        })
    }
}

fn scheme_names() -> String {
    format!("a name: {}, or any other with a profile", quoted(NAMED))
}

/// A scheme by its name, or by its profile.
fn scheme(table: &Section<'_>) -> Result<RotationScheme, IoError> {
    let expected = scheme_names();
    let Some(name) = table.text("name", &expected)? else {
        return Err(table.missing("name", expected));
    };
    let stabilized = table.flag("stabilized")?;
    if let Some(segments) = table.tables("profile", &["rate", "duration"])? {
        for key in ["rate", "dwell"] {
            if table.has(key) {
                return Err(table.conflict(key, "the profile states rates and durations"));
            }
        }
        let cycle = segments.iter().map(rig::segment).collect::<Result<Vec<_>, IoError>>()?;
        if cycle.is_empty() {
            return Err(table.not_allowed("profile", PROFILE));
        }
        return Ok(RotationScheme { name: name.into(), cycle, stabilized });
    }
    let refuse = |key: &str| {
        let reason = format!("the scheme {name:?} has none");
        if table.has(key) { Err(table.conflict(key, reason)) } else { Ok(()) }
    };
    let rate = || {
        let rate = table.require_quantity("rate", &kinds::TABLE_RATE)?;
        if rate == 0.0 {
            Err(table.not_allowed("rate", "a rate other than zero"))
        } else {
            Ok(rate)
        }
    };
    let turn = |rate: f64| Segment { rate, duration: TAU / rate.abs() };
    if name != "four-position" {
        refuse("dwell")?;
    }
    let cycle = match name {
        "static" => {
            refuse("rate")?;
            vec![Segment { rate: 0.0, duration: INTERVAL }]
        }
        "continuous" => vec![turn(rate()?)],
        "reciprocating" => {
            let rate = rate()?;
            vec![turn(rate), turn(-rate)]
        }
        "four-position" => {
            let rate = rate()?;
            let dwell = table.require_quantity("dwell", &kinds::DURATION)?;
            let quarter = |rate: f64| {
                [
                    Segment { rate: 0.0, duration: dwell },
                    Segment { rate, duration: FRAC_PI_2 / rate.abs() },
                ]
            };
            [[rate; 3], [-rate; 3]].concat().into_iter().flat_map(quarter).collect()
        }
        _ => return Err(table.missing("profile", PROFILE)),
    };
    Ok(RotationScheme { name: name.into(), cycle, stabilized })
}
