//! What a model leaves unexplained in logs, and the effects that explain it.

mod found;
mod gain;
mod measured;
mod outcome;
mod overlay;
mod report;
mod result;
mod structure;
mod testable;
mod text;
mod words;

use std::path::{Path, PathBuf};

use rins_io::{InputFile, ModelFile, shown};
use rins_terms::TermInstance;

use self::found::{DiagnosisOutcome, Request};
pub use self::measured::{ConsistentResult, DriftPairResult, GainResult, PairResult};
pub use self::result::{
    AlternativeResult, CauseParameterResult, CauseResult, DiagnoseResult, FalseAlarmsResult,
    NextTestResult, SettingResult, ShiftResult, UnexplainedResult, UntestableResult, WorstResult,
};
use crate::basis::BasisResult;
use crate::error::Result;
use crate::log::Log;
use crate::options::{ModelChoice, NamedModel, NoiseChoice};
use crate::preparation::{EstimationProblem, Prepared};
use crate::progress::Progress;

/// What a diagnosis is asked for.
#[derive(Clone, Debug)]
pub struct DiagnoseOptions {
    /// The model that the logs are taken to follow: by default all of eq. (1), and the attitude of the axis.
    pub model: ModelChoice,
    /// The log on which the gain is measured; by default the last 30 % of every segment.
    pub held_out: Option<Log>,
    /// Whether the gain is measured at the table's fastest rate too, with what was found at slower ones.
    pub transfer: bool,
    /// A model file whose effects are evaluated in place of a search.
    pub hypothesis: Option<PathBuf>,
    /// Whether the noise is estimated, as it is by default, or the data sheet trusted.
    pub noise: NoiseChoice,
    /// How many runs, simulated with the extended model and the estimated noise, are diagnosed to estimate the false alarm rate.
    pub bootstrap: Option<u32>,
    /// Who hears how far it is.
    pub progress: Progress,
}

impl Default for DiagnoseOptions {
    fn default() -> Self {
        Self {
            model: ModelChoice::Full,
            held_out: None,
            transfer: false,
            hypothesis: None,
            noise: NoiseChoice::default(),
            bootstrap: None,
            progress: Progress::default(),
        }
    }
}

/// What a model leaves unexplained, the effects that explain it, and what they gain.
#[derive(Debug)]
pub struct Diagnosis {
    found: Box<DiagnosisOutcome>,
    basis: BasisResult,
}

/// Estimates a model from the logs of one IMU, and searches the catalogue for effects that it lacks.
///
/// # Errors
/// If units, signs or axes are mistaken, if the logs are not of one IMU, or if the model cannot be estimated from them.
///
/// # Panics
/// If there are no logs.
///
/// ```no_run
/// use rins::{DiagnoseOptions, Log, Outcome};
/// let log = Log::open("rig.toml")?;
/// let diagnosis = rins::diagnose(vec![log], DiagnoseOptions::default())?;
/// print!("{diagnosis}");
/// for cause in diagnosis.result().causes {
///     println!("{}: p = {:e}", cause.effect, cause.p_value);
/// }
/// # Ok::<(), rins::Error>(())
/// ```
pub fn diagnose(logs: Vec<Log>, options: DiagnoseOptions) -> Result<Diagnosis> {
    Ok(diagnosed(logs, options)?)
}

fn diagnosed(logs: Vec<Log>, options: DiagnoseOptions) -> anyhow::Result<Diagnosis> {
    let stage = options.progress.begin("preparing", None);
    let prepared = |log: Log| anyhow::Ok(Prepared::of(log, options.noise)?.alone());
    let runs = logs.into_iter().map(prepared).collect::<anyhow::Result<Vec<_>>>()?;
    let held_out = options.held_out.map(prepared).transpose()?;
    drop(stage);
    let named = NamedModel::of(&options.model, &runs[0].loaded.rig.spin)?;
    let case = EstimationProblem::of(runs, named, options.noise)?;
    if let Some(held_out) = &held_out {
        case.ensure_same_imu(held_out)?;
    }
    let hypothesis_file = options.hypothesis.as_deref().map(InputFile::of).transpose()?;
    let of_runs = case.runs.iter().chain(&held_out).map(|run| &run.basis);
    let basis = BasisResult::together(of_runs)
        .with_files(case.model_file.clone().into_iter().chain(hypothesis_file));
    let supposed = options.hypothesis.as_deref().map(|file| hypothesis(file, &case)).transpose()?;
    let asked =
        Request { supposed, held_out, transfer: options.transfer, bootstrap: options.bootstrap };
    let found = Box::new(DiagnosisOutcome::of(case, &asked, &options.progress)?);
    Ok(Diagnosis { found, basis })
}

/// The effects of a model file beyond a case's model.
fn hypothesis(file: &Path, case: &EstimationProblem) -> anyhow::Result<Vec<TermInstance>> {
    let mut terms = ModelFile::read_along(file, &case.runs[0].loaded.rig.spin)?.model.terms;
    terms.retain(|chosen| !case.model.terms.iter().any(|own| own.term.is(chosen.term)));
    let silent = terms.iter().find(|chosen| !chosen.term.is_signal());
    if let Some(chosen) = silent {
        anyhow::bail!(
            "{}: {} adds to no signal: noise is estimated with every model",
            shown(file),
            chosen.term.id
        );
    }
    anyhow::ensure!(
        !terms.is_empty(),
        "{}: no hypothesis to evaluate: it holds no term that the model does not have",
        shown(file)
    );
    Ok(terms)
}
