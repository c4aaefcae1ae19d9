//! What a rotation schedule shows, before it is run.

pub(crate) mod chosen;
mod found;
mod outcome;
mod page;
mod result;
pub(crate) mod schedule;
mod words;

use std::path::PathBuf;

use rins_design::{Limits, Pair, information};
use rins_io::InputFile;

pub use self::chosen::Want;
use self::found::{ObservabilityStudy, Observed};
pub use self::result::{
    DirectionResult, LimitsResult, ObserveResult, ProposalResult, ScheduleResult, SegmentResult,
    SeparationResult, SeparationsResult,
};
use self::schedule::Schedule;
use crate::basis::BasisResult;
use crate::error::Result;
use crate::progress::Progress;

/// What is asked of schedules.
#[derive(Clone, Debug)]
pub struct ObserveOptions {
    /// The model: `full`, `paper12`, `baseline`, `all` or a model file; by default `full`, and `baseline` where effects are to be
    /// separated.
    pub model: Option<String>,
    /// Whether each scenario is a schedule of its own; by default all together are one.
    pub compare: bool,
    /// The ids of two effects that are to be separated.
    pub separate: Option<[String; 2]>,
    /// A parameter and the 1σ that is wanted of it.
    pub want: Option<Want>,
    /// The table's fastest rate \[rad/s\]; by default the scenario's, or [`TYPICAL_RATE`](rins_design::TYPICAL_RATE) if it does not turn.
    pub max_rate: Option<f64>,
    /// The table's acceleration \[rad/s²\]; by default the scenario's, or [`TYPICAL_ACCELERATION`](rins_design::TYPICAL_ACCELERATION).
    pub max_acceleration: Option<f64>,
    /// The longest that the runs of a schedule may take together \[s\]; by default an hour.
    pub max_duration: f64,
    /// Into how many directions the axis may be brought; by default three.
    pub directions: usize,
    /// Who hears how far it is.
    pub progress: Progress,
}

impl Default for ObserveOptions {
    fn default() -> Self {
        Self {
            model: None,
            compare: false,
            separate: None,
            want: None,
            max_rate: None,
            max_acceleration: None,
            max_duration: 3600.0,
            directions: 3,
            progress: Progress::default(),
        }
    }
}

/// What schedules show, and the one to run next.
#[derive(Debug)]
pub struct Observability(Box<ObservabilityStudy>);

/// The information that the scenarios' runs would hold on the parameters of a model, without noise and without errors.
///
/// # Errors
/// If a scenario cannot be read or simulated, or the options name no model, effect or parameter.
///
/// ```
/// use rins::{ObserveOptions, Outcome};
/// let folder = tempfile::tempdir()?;
/// let scenario = folder.path().join("scenario.toml");
/// std::fs::write(&scenario, rins::demo::SCENARIO)?;
/// let observability = rins::observe(&[scenario], &ObserveOptions::default())?;
/// print!("{observability}");
/// assert_eq!(observability.result().schedules.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn observe(scenarios: &[PathBuf], options: &ObserveOptions) -> Result<Observability> {
    Ok(Observability(Box::new(found(scenarios, options)?)))
}

fn found(scenarios: &[PathBuf], options: &ObserveOptions) -> anyhow::Result<ObservabilityStudy> {
    let effects = options
        .separate
        .as_ref()
        .map(|pair| anyhow::Ok([chosen::effect(&pair[0])?, chosen::effect(&pair[1])?]))
        .transpose()?;
    if let Some([first, second]) = &effects {
        let shared = first.ids.iter().find(|id| second.ids.contains(id));
        anyhow::ensure!(
            shared.is_none(),
            "{} and {} cannot be separated: both hold {}",
            first.name,
            second.name,
            shared.map_or("", String::as_str)
        );
    }
    let wanted = options.want.as_ref().map(chosen::wanted).transpose()?;
    let usual = if effects.is_some() { "baseline" } else { "full" };
    let name = options.model.as_deref().unwrap_or(usual);
    let mut model = chosen::model(name)?;
    let sought = effects.iter().flatten().chain(wanted.iter().map(|(effect, _)| effect));
    for effect in sought {
        model = chosen::with(model, effect);
    }
    let model_file = chosen::model_file(name).map(InputFile::of).transpose()?;
    let schedules = schedules(scenarios, options.compare)?;
    let paths = schedules.iter().flat_map(|schedule| &schedule.paths);
    let files = InputFile::of_each(paths.map(PathBuf::as_path))?;
    let limits = limits(options, &schedules[0]);
    let stage = options.progress.begin("looking at schedules", Some(schedules.len()));
    let mut observed = Vec::new();
    for schedule in schedules {
        let joint = information(&schedule.runs, &model)?;
        let pair = effects.as_ref().map(|effects| Pair::of(&joint, effects));
        observed.push(Observed { identifiability: joint.identifiability(), schedule, pair });
        stage.done(observed.len());
    }
    drop(stage);
    let mut found = ObservabilityStudy {
        model: name.into(),
        observed,
        effects,
        wanted,
        limits,
        proposal: None,
        proposed_pair: None,
        scenarios: Vec::new(),
        basis: BasisResult::of_files(files).with_files(model_file),
    };
    if !options.compare {
        found.search(&model, &options.progress)?;
    }
    Ok(found)
}

/// The schedules asked for: all scenarios as one, or each for itself.
fn schedules(scenarios: &[PathBuf], compare: bool) -> anyhow::Result<Vec<Schedule>> {
    if !compare {
        return Ok(vec![Schedule::of(scenarios)?]);
    }
    let each = scenarios.iter().map(|path| {
        let together: Vec<PathBuf> = path.to_string_lossy().split('+').map(PathBuf::from).collect();
        Schedule::of(&together)
    });
    each.collect()
}

/// What the options say of the table, or else the scenario, or else what is typical.
fn limits(options: &ObserveOptions, schedule: &Schedule) -> Limits {
    let (rate, acceleration) = schedule.table(options.max_rate, options.max_acceleration);
    Limits { rate, acceleration, duration: options.max_duration, directions: options.directions }
}
