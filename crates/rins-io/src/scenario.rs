//! Scenario files: a rig file with the truth of a simulated run.

mod temperature;

use std::path::{Path, PathBuf};

use rins_frames::{Dcm, EulerAngles, SignedAxes};
use rins_imu::{ImuError, ImuNoise, NoiseModel, Quantisation, Seed, TriadError, TriadSpec};
use rins_simulation::{Encoder, Scenario, TableRecord};
use rins_terms::Model;

use crate::document::Document;
use crate::error::IoError;
use crate::parameter::{self, LeftOut};
use crate::quantity::{Quantity, kinds};
use crate::rig::{self, Axes, Rig, angle_figures, angles};
use crate::section::{Section, such_as};
use crate::term::{self, Use};

/// The content of a scenario file: the sections of a rig file and `[truth]`.
///
/// From `[log]` it uses the rate, the name of the log, the noise and resolution of `table_angle`,
/// and the presence of `table_angle` and `table_rate`, which are then recorded. Columns and
/// units, which occur if `[truth]` is appended to a rig file, are ignored: a simulated log has
/// its own ([`write_recording`](crate::write_recording)). `[grid]` is for campaigns
/// ([`ScenarioGrid`](crate::ScenarioGrid)) and ignored here. Errors that `[truth]` omits are zero;
/// noise has the parameters of `[imu]`, unless it is switched off.
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
/// rate = "50 Hz"
/// table_angle = {}
///
/// [table]
/// profile = [{ rate = "10 deg/s", duration = "36 s" }]
///
/// [truth]
/// seed = 1
/// attitude = { roll = "30 deg", pitch = "20 deg", yaw = "40 deg" }
/// gyro = { scale = ["0 ppm", "0 ppm", "300 ppm"] }
/// noise = { gyro = "off", accel = "off" }
/// "#;
/// let file = rins_io::ScenarioFile::parse(text, Path::new("scenario.toml"))?;
/// assert_eq!(file.scenario.imu_error.gyro.matrix[(2, 2)], 300e-6);
/// # Ok::<(), rins_io::IoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioFile {
    /// The scenario file.
    pub path: PathBuf,
    /// The scenario to be simulated, along the axes of the run, whose z is the spin axis.
    pub scenario: Scenario,
    /// The axes of the run, selected from the sensors' own: z unless `[axis] spin` states another one. `[truth]` and the simulated log are
    /// along the sensors' own axes.
    pub spin: Axes,
    /// The file name of the log in the folder of a simulated run.
    pub log_name: String,
    /// The scenario's text, from which the rig file of a run is written.
    pub(crate) document: Document,
}

/// The keys of `[truth]`.
const TRUTH: [&str; 7] = ["seed", "attitude", "gyro", "accel", "noise", "temperature", "effects"];

impl ScenarioFile {
    /// Reads the scenario file at `path`.
    ///
    /// # Errors
    /// [`IoError::File`] if it cannot be read, [`IoError::Key`] if a key is missing, unknown, of
    /// the wrong dimension or out of range.
    pub fn read(path: &Path) -> Result<Self, IoError> {
        Self::from_document(Document::read(path)?)
    }

    /// The scenario in `text`, parsed as the content of the file at `path`.
    ///
    /// # Errors
    /// [`IoError::Key`], as for [`ScenarioFile::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, IoError> {
        Self::from_document(Document::parse(text, path)?)
    }

    /// Refuses a scenario about another axis of the IMU, for this reason.
    pub(crate) fn require_spin_about_z(&self, reason: &str) -> Result<(), IoError> {
        if self.spin == Axes::IDENTITY {
            return Ok(());
        }
        let root = Section::root(&self.document, &sections())?;
        let axis = root.section("axis", &["spin"])?;
        Err(axis.as_ref().unwrap_or(&root).conflict("spin", reason))
    }

    pub(crate) fn from_document(document: Document) -> Result<Self, IoError> {
        let root = Section::root(&document, &sections())?;
        let Some(station) = rig::station(&root)? else {
            return Err(root.missing("[site]", "latitude, longitude and height"));
        };
        let rig = Rig::without_log(&document, &root)?;
        let Some(log) = root.section("log", &rig::LOG_KEYS)? else {
            return Err(root.missing("[log]", such_as(&kinds::SAMPLE_RATE)));
        };
        let rate = log.require_quantity("rate", &kinds::SAMPLE_RATE)?;
        let log_name = log_name(&log)?;
        let Some(truth) = root.section("truth", &TRUTH)? else {
            return Err(root.missing("[truth]", "at least a seed"));
        };
        let axes = SignedAxes::from(rig.spin);
        let effects = effects(&truth, &axes)?;
        let noise = Noise::read(&truth)?;
        let Some(profile) = rig.table.as_ref().and_then(|table| table.profile.clone()) else {
            let expected = r#"a list such as [{ rate = "10 deg/s", duration = "60 s" }]"#;
            return Err(rig.missing("[table] profile", expected));
        };
        let attitude = match truth.section("attitude", &["roll", "pitch", "yaw"])? {
            Some(section) => angles(&section)?,
            None => known_attitude(&rig, &truth)?,
        };
        let gyro = Sensor::read(&truth, "gyro", &parameter::GYRO)?;
        let accel = Sensor::read(&truth, "accel", &parameter::ACCEL)?;
        let scenario = Scenario {
            station,
            nav_from_table: attitude.dcm(),
            profile,
            interval: 1.0 / rate,
            imu_error: ImuError { gyro: gyro.error, accel: accel.error }.along(&axes.matrix()),
            noise: noise.of_imu(&rig, &gyro, &accel)?,
            table: table_record(&log, &noise)?,
            effects,
            temperature: temperature::read(&truth)?,
            seed: Seed::new(seed(&truth)?),
        };
        Ok(Self { path: document.path.clone(), scenario, spin: rig.spin, log_name, document })
    }
}

/// The sections of a scenario file.
fn sections() -> Vec<&'static str> {
    rig::SECTIONS.into_iter().chain(["truth", "grid"]).collect()
}

fn log_name(log: &Section<'_>) -> Result<String, IoError> {
    let expected = r#"the name of a csv file, such as "run.csv""#;
    let name = log.text("path", expected)?.unwrap_or("run.csv");
    let is_name = Path::new(name).file_name().is_some_and(|last| last == name);
    let ends = Path::new(name).extension().is_some_and(|ending| ending == "csv");
    if !(is_name && ends) {
        return Err(log.not_allowed("path", expected));
    }
    if log.text("format", "\"csv\"")?.is_some_and(|format| format != "csv") {
        return Err(log.not_allowed("format", "\"csv\""));
    }
    Ok(name.into())
}

fn known_attitude(rig: &Rig, truth: &Section<'_>) -> Result<EulerAngles, IoError> {
    match &rig.attitude {
        Some(attitude) => Ok(attitude.angles),
        None => Err(truth.missing("attitude", "roll, pitch and yaw, here or in [attitude]")),
    }
}

fn seed(truth: &Section<'_>) -> Result<u64, IoError> {
    let expected = "a whole number from 0";
    truth.count("seed", expected)?.ok_or_else(|| truth.missing("seed", expected))
}

fn table_record(log: &Section<'_>, noise: &Noise) -> Result<TableRecord, IoError> {
    let angle = angle_figures(log)?;
    let rate = log.inline("table_rate", &["column", "unit", "sense"])?;
    match (angle, rate) {
        (Some((section, angle)), _) => {
            if section.has("latency") {
                return Err(section.conflict(
                    "latency",
                    "is not simulated; list the effect encoder_latency instead",
                ));
            }
            let on = noise.table_angle == Switch::On;
            let sigma = if on { angle.noise.unwrap_or(0.0) } else { 0.0 };
            // A resolution of zero means none.
            let resolution = angle.resolution.filter(|bit| on && *bit > 0.0);
            Ok(TableRecord::Angle(Encoder { noise: sigma, resolution, zero: 0.0 }))
        }
        (None, Some(_)) => Ok(TableRecord::CommandedRate),
        (None, None) => Ok(TableRecord::Nothing),
    }
}

/// The effects other than bias, scale error, misalignment and noise.
fn effects(truth: &Section<'_>, axes: &SignedAxes) -> Result<Model, IoError> {
    let mut effects = Model::default();
    for table in term::tables(truth, "effects")? {
        let effect = term::read(&table, Use::Effect, axes)?;
        term::refuse_triads(&table, &effect, |sensor| format!("[truth.{sensor}]"))?;
        effects.terms.push(effect);
    }
    Ok(effects)
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Switch {
    On,
    Off,
}

/// The kinds of noise that are simulated.
struct Noise {
    gyro: Switch,
    accel: Switch,
    table_angle: Switch,
}

impl Noise {
    fn read(truth: &Section<'_>) -> Result<Self, IoError> {
        let section = truth.section("noise", &["gyro", "accel", "table_angle"])?;
        let switch = |key| match &section {
            Some(section) => {
                let choice = section.choice(key, &[("on", Switch::On), ("off", Switch::Off)])?;
                Ok(choice.unwrap_or(Switch::On))
            }
            None => Ok::<Switch, IoError>(Switch::On),
        };
        let gyro = switch("gyro")?;
        Ok(Self { gyro, accel: switch("accel")?, table_angle: switch("table_angle")? })
    }

    fn of_imu(
        &self,
        rig: &Rig,
        gyro: &Sensor,
        accel: &Sensor,
    ) -> Result<Option<ImuNoise>, IoError> {
        let model = |switch: Switch, sensor: &Sensor, spec: Option<&TriadSpec>| {
            let made = match (switch, spec) {
                (Switch::Off, _) => NoiseModel::default(),
                (Switch::On, Some(spec)) => NoiseModel {
                    quantisation: spec.resolution.map(Quantisation::Rate),
                    ..NoiseModel::from(spec)
                },
                (Switch::On, None) => {
                    rig.require_imu()?;
                    NoiseModel::default()
                }
            };
            let quantisation = sensor.quantisation.or(made.quantisation);
            Ok::<NoiseModel, IoError>(NoiseModel { quantisation, ..made })
        };
        let spec = rig.imu.as_ref();
        let noise = ImuNoise {
            gyro: model(self.gyro, gyro, spec.map(|imu| &imu.gyro))?,
            accel: model(self.accel, accel, spec.map(|imu| &imu.accel))?,
        };
        Ok((noise != ImuNoise::default()).then_some(noise))
    }
}

/// The true errors of one triad.
struct Sensor {
    error: TriadError,
    quantisation: Option<Quantisation>,
}

impl Sensor {
    fn read(truth: &Section<'_>, key: &str, keys: &parameter::TriadKeys) -> Result<Self, IoError> {
        let known: Vec<&str> = parameter::KEYS.into_iter().chain(["resolution"]).collect();
        let Some(section) = truth.section(key, &known)? else {
            return Ok(Self { error: TriadError::default(), quantisation: None });
        };
        let error = parameter::read(&section, keys, LeftOut::Zero)?;
        let (rate, increment) = if key == "gyro" {
            (&kinds::GYRO_READING, &kinds::ANGLE_BIT)
        } else {
            (&kinds::ACCEL_READING, &kinds::VELOCITY_BIT)
        };
        let text = section.text("resolution", &such_as(increment))?;
        let is_rate =
            |text| Quantity::parse(text).is_ok_and(|quantity| quantity.dimension == rate.dimension);
        let quantisation = match text {
            None => None,
            Some(text) if is_rate(text) => {
                section.quantity("resolution", rate)?.map(Quantisation::Rate)
            }
            Some(_) => section.quantity("resolution", increment)?.map(Quantisation::Increment),
        };
        Ok(Self { error, quantisation })
    }
}

/// The true attitude of the simulated table axis frame, as roll, pitch and yaw \[rad\].
pub(crate) fn true_angles(scenario: &Scenario) -> EulerAngles {
    let nav_from_table: Dcm<_, _> = scenario.nav_from_table;
    nav_from_table.euler_angles()
}
