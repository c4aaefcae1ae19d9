//! The rotation schedule that a calibration gains most from, within the limits of a table and a duration.

mod goal;
mod notes;
mod outcome;
mod page;
mod result;
mod study;
mod words;

use std::path::PathBuf;

use rins_design::{Criterion, Effect, Limits, Optimization};
use rins_frames::SignedAxes;
use rins_frames::units::DEG;
use rins_io::{Axes, InputFile, MissionFile};
use rins_motion::Segment;
use rins_report::number::figure;
use rins_terms::{Model, Owner};

pub use self::goal::DesignGoal;
use self::goal::{InService, model_for, objective};
pub use self::result::{
    ComparedResult, DesignResult, DesignedRunResult, DesignedSegmentResult, MotionResult,
    ScaleBoundResult,
};
use self::study::{Compared, DesignStudy};
use crate::basis::BasisResult;
use crate::error::Result;
use crate::observe::chosen;
use crate::observe::schedule::{Changes, ScenarioBase, Schedule};
use crate::progress::Progress;

/// The name of the power-on of the runs, if the scenario has none.
const SERIES: &str = "one power-on";

/// What a schedule is designed for.
#[derive(Clone, Debug)]
pub struct DesignOptions {
    /// The goal.
    pub goal: DesignGoal,
    /// The model: `full`, `paper12`, `baseline`, `all` or a model file; by default `full`, and `baseline` where effects are to be
    /// separated.
    pub model: Option<String>,
    /// The duration of all runs together \[s\]; by default that of the scenarios.
    pub duration: Option<f64>,
    /// The table's fastest rate \[rad/s\]; by default the scenario's, or [`TYPICAL_RATE`](rins_design::TYPICAL_RATE) if it does not turn.
    pub max_rate: Option<f64>,
    /// The table's acceleration \[rad/s²\]; by default the scenario's, or [`TYPICAL_ACCELERATION`](rins_design::TYPICAL_ACCELERATION).
    pub max_acceleration: Option<f64>,
    /// The largest number of orientations of the axis.
    pub directions: usize,
    /// The tilts that the axis can have \[rad\]; by default any from 0 to 90 deg.
    pub tilts: Option<Vec<f64>>,
    /// The axes of the IMU that can be mounted along the spin axis; by default that of the first scenario.
    pub mountings: Vec<Axes>,
    /// A mission file: the site, axis and first scheme of a system in service, for a position error. By default it is at the
    /// scenario's site and attitude and turns back and forth at the fastest rate.
    pub service: Option<PathBuf>,
    /// Who hears how far it is.
    pub progress: Progress,
}

impl DesignOptions {
    /// The options for a goal, with the defaults of the command.
    pub fn new(goal: DesignGoal) -> Self {
        Self {
            goal,
            model: None,
            duration: None,
            max_rate: None,
            max_acceleration: None,
            directions: 3,
            tilts: None,
            mountings: Vec::new(),
            service: None,
            progress: Progress::default(),
        }
    }
}

/// An optimal schedule beside the usual ones.
#[derive(Debug)]
pub struct Design(Box<DesignStudy>);

/// The schedule that is optimal for a goal, for the IMU, the site and the table of these scenarios.
///
/// # Errors
/// If a file cannot be read, the options name no model, effect or parameter, or no schedule is within the limits.
///
/// ```
/// use rins::design::{DesignGoal, DesignOptions};
/// use rins::Outcome;
/// let folder = tempfile::tempdir()?;
/// let scenario = folder.path().join("scenario.toml");
/// std::fs::write(&scenario, rins::demo::SCENARIO)?;
/// let goal = DesignGoal::Parameter("gyro.scale.z".into());
/// let options = DesignOptions { duration: Some(120.0), directions: 1, ..DesignOptions::new(goal) };
/// let design = rins::design(&[scenario], &options)?;
/// let result = design.result();
/// // The equivalence theorem: no schedule of this duration is better by more than the gap.
/// assert!(result.gap < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn design(scenarios: &[PathBuf], options: &DesignOptions) -> Result<Design> {
    Ok(Design(Box::new(designed(scenarios, options)?)))
}

fn designed(scenarios: &[PathBuf], options: &DesignOptions) -> anyhow::Result<DesignStudy> {
    let goal = &options.goal;
    let usual = if matches!(goal, DesignGoal::Separation(_)) { "baseline" } else { "full" };
    let name = options.model.as_deref().unwrap_or(usual);
    let (model, effects) = model_for(goal, name)?;
    let schedule = Schedule::of(scenarios)?;
    let limits = limits(options, &schedule)?;
    let mountings = mountings(options, &effects)?;
    let mut inputs: Vec<InputFile> =
        InputFile::of_each(schedule.paths.iter().map(PathBuf::as_path))?;
    let service = service(options, &schedule, &limits, &mut inputs)?;
    let model_file = chosen::model_file(name).map(InputFile::of).transpose()?;
    let objective = objective(goal, (&model, &effects), &schedule, &service)?;
    let stage = options.progress.begin("optimizing the schedule", None);
    let optimization = Optimization {
        given: &schedule.runs,
        model: &model,
        objective: &objective,
        limits: &limits,
        tilts: options.tilts.as_deref(),
        mountings: &mountings,
    };
    let optimal = optimization
        .run(|candidates| stage.at(&format!("optimizing the schedule, {candidates} candidates")))?;
    stage.at("comparing schedules");
    let mut compared = vec![Compared::given(&schedule, &model, &objective)?];
    for usual in rins_design::usual_schedules(&schedule.runs[0], &limits, &mountings) {
        compared.push(Compared::of(usual.words.clone(), &usual.runs, &model, &objective)?);
    }
    drop(stage);
    compared.push(Compared::optimal(&optimal));
    let base = ScenarioBase::read(&schedule.paths[0])?;
    let (criterion, _) = objective.criterion(&[]);
    Ok(DesignStudy {
        name: schedule.name.clone(),
        model: name.into(),
        goal: goal.clone(),
        scenarios: files(&base, &optimal, &schedule, &limits)?,
        bound: criterion.bound(optimal.approximate, optimal.gap),
        efficiency: criterion
            .efficiency(optimal.value, criterion.bound(optimal.approximate, optimal.gap)),
        gyro_noise: schedule.runs[0].imu.gyro.noise_density,
        is_time_dependent: is_time_dependent(&model),
        criterion: kind(&criterion),
        optimal,
        compared,
        limits,
        service,
        basis: BasisResult::of_files(inputs).with_files(model_file),
    })
}

fn kind(criterion: &Criterion) -> &'static str {
    match criterion {
        Criterion::Variance(_) => "variance",
        Criterion::Determinant(_) => "determinant",
        Criterion::Distance(_) => "distance",
    }
}

/// Whether a term has settings, such as the time of an event: the additivity of motions does not hold for it.
fn is_time_dependent(model: &Model) -> bool {
    model.terms.iter().any(|chosen| !chosen.settings.is_empty())
}

fn limits(options: &DesignOptions, schedule: &Schedule) -> anyhow::Result<Limits> {
    let (rate, acceleration) = schedule.table(options.max_rate, options.max_acceleration);
    let duration = options.duration.unwrap_or_else(|| schedule.duration());
    let ramp = rate / acceleration;
    let least = SHORTEST + 2.0 * ramp;
    anyhow::ensure!(
        duration >= least,
        "a duration of {duration} s is too short for a schedule: a ramp to {} deg/s at {} deg/s^2 takes {ramp:.1} s, and at least {least:.1} s \
         are needed",
        figure(rate / DEG, 3),
        figure(acceleration / DEG, 3)
    );
    anyhow::ensure!(
        duration <= LONGEST,
        "a duration of {duration} s is longer than a calibration on a table: at most {LONGEST} s are possible"
    );
    for tilt in options.tilts.iter().flatten() {
        anyhow::ensure!(
            (0.0..=180.0 * DEG).contains(tilt),
            "a tilt of {} deg: the angle of the axis from the vertical is 0 deg to 180 deg",
            tilt / DEG
        );
    }
    Ok(Limits { rate, acceleration, duration, directions: options.directions })
}

/// The axes of the mountings, each once; none for that of the scenario.
fn mountings(options: &DesignOptions, effects: &[Effect]) -> anyhow::Result<Vec<SignedAxes>> {
    let mut mountings: Vec<SignedAxes> = Vec::new();
    for axes in options.mountings.iter().map(|axes| SignedAxes::from(*axes)) {
        if !mountings.contains(&axes) {
            mountings.push(axes);
        }
    }
    let of_run = effects.iter().find(|effect| effect.term.owner == Owner::Run);
    if let (Some(effect), true) = (of_run, mountings.len() > 1) {
        anyhow::bail!(
            "{} belongs to one mounting of the IMU: a schedule of several mountings cannot be optimized for it",
            effect.name
        );
    }
    Ok(mountings)
}

/// The shortest duration of a schedule without its ramps \[s\].
const SHORTEST: f64 = 10.0;

/// The longest duration of a schedule \[s\].
const LONGEST: f64 = 86400.0;

fn service(
    options: &DesignOptions,
    schedule: &Schedule,
    limits: &Limits,
    inputs: &mut Vec<InputFile>,
) -> anyhow::Result<InService> {
    if let Some(path) = &options.service {
        inputs.push(InputFile::of(path)?);
        return Ok(InService::of(&MissionFile::read(path)?));
    }
    let run = &schedule.runs[0];
    let turn = |rate: f64| Segment { rate, duration: std::f64::consts::TAU / rate.abs() };
    Ok(InService {
        words: format!("reciprocating at {} deg/s", figure(limits.rate / DEG, 3)),
        station: run.station(),
        nav_from_table: run.nav_from_table(),
        axes: run.axes(),
        cycle: vec![turn(limits.rate), turn(-limits.rate)],
    })
}

/// The scenario files of the schedule.
fn files(
    base: &ScenarioBase,
    optimal: &rins_design::OptimalSchedule,
    schedule: &Schedule,
    limits: &Limits,
) -> anyhow::Result<Vec<String>> {
    let first = &schedule.runs[0];
    let given = first.nav_from_table();
    let count = optimal.runs.len();
    let series = (count > 1).then_some(SERIES);
    let runs = optimal.runs.iter().enumerate();
    runs.map(|(place, run)| {
        let attitude = run.planned.nav_from_table();
        let is_given = (attitude.matrix() - given.matrix()).abs().max() < 1e-9;
        let title = format!("Optimal schedule: run {} of {count}.", place + 1);
        let axes = run.planned.axes();
        base.with(&Changes {
            title,
            segments: &run.segments,
            acceleration: limits.acceleration,
            attitude: (!is_given).then_some(attitude),
            spin: (axes != first.axes()).then(|| Axes::from(axes).spin_name()),
            series,
        })
    })
    .collect()
}
