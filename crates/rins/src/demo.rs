//! Calibration and diagnosis of an embedded run, without any preparation.

use std::fmt;
use std::path::{Path, PathBuf};

use anyhow::Context;
use rins_io::InputFile;
use rins_report::Report;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::basis::BasisResult;
use crate::calibrate::{CalibrateOptions, CalibrateResult, Calibration, calibrate};
use crate::diagnose::{DiagnoseOptions, DiagnoseResult, Diagnosis, diagnose};
use crate::error::Result;
use crate::log::Log;
use crate::outcome::Outcome;
use crate::progress::Progress;

/// The rig file of the embedded run.
pub const RIG: &str = include_str!("../data/demo/rig.toml");

/// Its log, simulated by `rins simulate` from [`SCENARIO`].
pub const LOG: &str = include_str!("../data/demo/run.csv");

/// The scenario of the embedded run.
pub const SCENARIO: &str = include_str!("../data/demo/scenario.toml");

/// The embedded run, calibrated by the paper's filter and diagnosed.
#[derive(Debug)]
pub struct Demo {
    calibration: Calibration,
    diagnosis: Diagnosis,
}

/// The result of `rins demo`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DemoResult {
    /// The calibration of the embedded run, by the paper's filter; `command` is `demo`.
    #[serde(flatten)]
    pub calibration: CalibrateResult,
    /// Its diagnosis.
    pub diagnosis: DiagnoseResult,
}

/// Writes the embedded run into a folder, as `rig.toml` and `run.csv`, and reads it like any other log.
///
/// # Errors
/// If the files cannot be written.
///
/// ```
/// let folder = tempfile::tempdir()?;
/// let log = rins::demo::log(folder.path())?;
/// assert!(log.loaded.recording.len() > 1000);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn log(folder: &Path) -> Result<Log> {
    let write = |name: &str, content: &str| {
        std::fs::write(folder.join(name), content)
            .with_context(|| format!("cannot write the embedded {name}"))
    };
    write("rig.toml", RIG)?;
    write("run.csv", LOG)?;
    let log = Log::open(folder.join("rig.toml"))?;
    let inputs = log.inputs.into_iter().map(|input| {
        // Of the embedded run only the names are the same everywhere.
        let name = input.path.file_name().map(PathBuf::from);
        InputFile { path: name.unwrap_or_default(), ..input }
    });
    let inputs = inputs.collect();
    Ok(Log { name: "the embedded demo run".into(), inputs, ..log })
}

/// Calibrates and diagnoses the embedded run.
///
/// # Errors
/// If temporary files cannot be written.
pub fn demo(progress: &Progress) -> Result<Demo> {
    let folder = tempfile::tempdir().context("no temporary folder for the embedded run")?;
    let log = log(folder.path())?;
    let options = CalibrateOptions { progress: progress.clone(), ..CalibrateOptions::default() };
    let calibration = calibrate(vec![log.clone()], &options)?;
    // The run contains more effects than the paper's filter has states for.
    let options = DiagnoseOptions { progress: progress.clone(), ..DiagnoseOptions::default() };
    Ok(Demo { calibration, diagnosis: diagnose(vec![log], options)? })
}

impl fmt::Display for Demo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n{}", self.calibration, self.diagnosis)
    }
}

impl Outcome for Demo {
    type Result = DemoResult;

    fn result(&self) -> DemoResult {
        DemoResult {
            calibration: CalibrateResult { command: "demo".into(), ..self.calibration.result() },
            diagnosis: self.diagnosis.result(),
        }
    }

    fn basis(&self) -> BasisResult {
        self.calibration.basis()
    }

    fn report(&self) -> Option<Report> {
        let mut report = self.calibration.report()?;
        let further = self.diagnosis.report()?;
        report.summary.extend(further.summary);
        report.sections.extend(further.sections);
        Some(report)
    }

    fn files(&self) -> Vec<(String, Vec<u8>)> {
        let mut files = self.calibration.files();
        let further = self.diagnosis.files().into_iter();
        files.extend(further.map(|(name, content)| (format!("extended-{name}"), content)));
        files.push(("rig.toml".into(), RIG.into()));
        files.push(("run.csv".into(), LOG.into()));
        files
    }
}
