//! Compensation of a log with the errors in a calibration file.

use std::fmt;
use std::path::{Path, PathBuf};

use anyhow::Context;
use rins_imu::ImuError;
use rins_io::{
    Calibration, Converted, InputFile, Loaded, LogFile, Overwrite, convert_changed, shown,
};
use rins_terms::{Model, Surroundings, TermInstance, compensated};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::basis::BasisResult;
use crate::check::refuse_mistaken;
use crate::convert::{basis_of, format_of, remarks};
use crate::error::Result;
use crate::log::{Beyond, Log, OutsideRange, beyond};
use crate::navigate::axis_attitude;
use crate::outcome::Outcome;

/// The options of [`apply`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ApplyOptions {
    /// The calibration file.
    pub calibration: PathBuf,
    /// The new log; its rig file lies beside it and ends in `.toml`.
    pub output: PathBuf,
    /// The format of the new log; by default it follows from the extension of its name.
    pub format: Option<LogFile>,
    /// Whether readings are compensated at temperatures far outside the calibrated range.
    pub extrapolate: bool,
    /// Whether existing files may be replaced.
    pub overwrite: Overwrite,
}

/// A compensated log that was written.
#[derive(Debug)]
pub struct Applied {
    rig: String,
    options: ApplyOptions,
    format: LogFile,
    undone: Vec<&'static str>,
    beyond: Beyond,
    converted: Converted,
    basis: BasisResult,
}

/// The result of `rins apply`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ApplyResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `apply`.
    pub command: String,
    /// The rig file.
    pub rig: String,
    /// The calibration file.
    pub calibration: String,
    /// The new log.
    pub log: String,
    /// The rig file of the new log.
    pub new_rig: String,
    /// The format of the new log.
    pub format: String,
    /// How many samples were written.
    pub samples: usize,
    /// The ids of the terms that were compensated.
    pub compensated: Vec<String>,
    /// What of the log lies outside of what the calibration covers.
    pub outside_calibrated_range: Option<OutsideRange>,
    /// The same in sentences.
    pub notes: Vec<String>,
    /// Whether the new log, read again, is the same to the last bit.
    pub exact: bool,
    /// What the format has no room for.
    pub left_out: Vec<String>,
    /// The time of the log from which the new one counts \[s\].
    pub time_origin_s: f64,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// Compensates a log with a calibration file, and writes the compensated log with its rig file.
///
/// # Errors
/// If a file cannot be read or written, if units, signs or axes are wrong, or if the calibration does not cover the log.
///
/// ```
/// use rins::{ApplyOptions, CalibrateOptions, Outcome, Overwrite};
/// let folder = tempfile::tempdir()?;
/// let log = rins::demo::log(folder.path())?;
/// let rig = folder.path().join("rig.toml");
/// rins::calibrate(vec![log], &CalibrateOptions::default())?
///     .write(&folder.path().join("out"), Overwrite::Refuse)?;
/// let applied = rins::apply(
///     &rig,
///     ApplyOptions {
///         calibration: folder.path().join("out/calibration.toml"),
///         output: folder.path().join("compensated.csv"),
///         format: None,
///         extrapolate: false,
///         overwrite: Overwrite::Refuse,
///     },
/// )?;
/// assert!(applied.result().compensated.contains(&"gyro.misalignment".to_owned()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn apply(rig: &Path, options: ApplyOptions) -> Result<Applied> {
    Ok(applied(rig, options)?)
}

fn applied(rig: &Path, options: ApplyOptions) -> anyhow::Result<Applied> {
    let ApplyOptions { calibration: file, output, format, extrapolate, overwrite } = &options;
    let format = format_of(output, *format)?;
    let calibration = Calibration::read(file)?;
    let mut found = Beyond::default();
    let converted = convert_changed(rig, output, format, *overwrite, |loaded| {
        found = compensate(loaded, &calibration, *extrapolate)?;
        anyhow::Ok(format!("Written by `rins apply` with the calibration {}.", shown(file)))
    })?;
    let triads = Model::from(&calibration.error);
    let terms = triads.terms.iter().chain(&calibration.terms.terms);
    let is_undone = |chosen: &&TermInstance| chosen.values.iter().any(|value| *value != 0.0);
    let undone = terms.filter(is_undone).map(|chosen| chosen.term.id).collect();
    let basis = basis_of(&converted)?.with_files([InputFile::of(file)?]);
    Ok(Applied { rig: shown(rig), format, undone, beyond: found, converted, basis, options })
}

impl Log {
    /// The log compensated with a calibration file, in memory, and what of it lies outside of what the calibration covers, in
    /// sentences.
    ///
    /// # Errors
    /// As [`apply`].
    pub fn compensated(
        &self,
        calibration: &Path,
        extrapolate: bool,
    ) -> Result<(Self, Vec<String>)> {
        let mut log = self.clone();
        let found = compensate(&mut log.loaded, &Calibration::read(calibration)?, extrapolate)?;
        log.inputs.push(InputFile::of(calibration)?);
        Ok((log, found.notes))
    }
}

/// Compensates a log with a calibration; returns what of it lies outside of what the calibration covers.
fn compensate(
    loaded: &mut Loaded,
    calibration: &Calibration,
    extrapolate: bool,
) -> anyhow::Result<Beyond> {
    refuse_mistaken(loaded)?;
    let run = calibration.in_run(&loaded.rig.spin)?;
    let found = beyond(calibration, &run.1, loaded, extrapolate)?;
    undo(run, loaded).with_context(|| shown(&calibration.path))?;
    Ok(found)
}

impl fmt::Display for Applied {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "Compensated {} by {}\n  {} samples to {} as {}, read by {}\n  compensated: {}",
            self.rig,
            shown(&self.options.calibration),
            self.converted.samples,
            shown(&self.options.output),
            self.format.name(),
            shown(&self.converted.rig),
            self.undone.join(", ")
        )?;
        let lines = self.beyond.notes.iter().cloned().chain(remarks(&self.converted));
        lines.into_iter().try_for_each(|line| writeln!(f, "  {line}"))
    }
}

impl Outcome for Applied {
    type Result = ApplyResult;

    fn result(&self) -> ApplyResult {
        let Self { rig, options, format, undone, beyond, converted, .. } = self;
        ApplyResult {
            schema: crate::SCHEMA,
            command: "apply".into(),
            rig: rig.clone(),
            calibration: shown(&options.calibration),
            log: shown(&options.output),
            new_rig: shown(&converted.rig),
            format: format.name().into(),
            samples: converted.samples,
            compensated: undone.iter().map(|id| (*id).to_owned()).collect(),
            outside_calibrated_range: beyond.outside.clone(),
            notes: beyond.notes.clone(),
            exact: converted.differences.is_empty(),
            left_out: converted.left_out.iter().map(|name| (*name).to_owned()).collect(),
            time_origin_s: converted.time_origin,
            basis: self.basis.clone(),
        }
    }

    fn basis(&self) -> BasisResult {
        self.basis.clone()
    }
}

/// Compensates the readings of a run with a calibration.
fn undo((error, terms): (ImuError, Model), loaded: &mut Loaded) -> anyhow::Result<()> {
    if terms.terms.is_empty() {
        // Eq. (1) is inverted sample by sample, for every direction of the axis.
        let compensation = error.compensation()?;
        for sample in &mut loaded.recording.increments {
            *sample = compensation.compensate(sample);
        }
        return Ok(());
    }
    let around = Surroundings::new(loaded.station, axis_attitude(loaded)?);
    let mut model = Model::from(&error);
    model.terms.extend(terms.terms);
    loaded.recording = compensated(&model, around, &loaded.recording)?;
    Ok(())
}
