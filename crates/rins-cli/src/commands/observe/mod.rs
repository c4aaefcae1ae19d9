//! `rins observe`: what a schedule tells, before it is run.

mod chosen;
mod json;
mod library;
mod next;
mod page;
mod proposal;
mod schedule;
mod words;

use std::path::PathBuf;

use rins_estimation::Identifiability;
use rins_frames::units::DEG_PER_SECOND;
use rins_terms::Model;

use crate::args::Observe;
use crate::outcome::Outcome;
use crate::progress;
pub(crate) use next::{NextTest, next_test};

use chosen::Effect;
use library::Limits;
use proposal::{Goal, Pair, Proposal, pair, propose};
use schedule::{Schedule, evidence};

/// What a table does where nothing is said of it.
const USUAL_RATE: f64 = 10.0 * DEG_PER_SECOND;
const USUAL_ACCELERATION: f64 = 5.0 * DEG_PER_SECOND;

/// What was found of one schedule.
struct Observed {
    schedule: Schedule,
    told: Identifiability,
    pair: Option<Pair>,
}

/// All that was found.
struct Found {
    model: String,
    observed: Vec<Observed>,
    effects: Option<[Effect; 2]>,
    wanted: Option<(Effect, f64)>,
    limits: Limits,
    proposal: Option<Proposal>,
    /// What the proposal makes of the pair.
    proposed_pair: Option<Pair>,
}

pub(crate) fn run(arguments: &Observe) -> anyhow::Result<Outcome> {
    let effects = arguments
        .separate
        .as_ref()
        .map(|pair| Ok::<_, anyhow::Error>([chosen::effect(&pair[0])?, chosen::effect(&pair[1])?]))
        .transpose()?;
    if let Some([first, second]) = &effects {
        let shared = first.ids.iter().find(|id| second.ids.contains(id));
        anyhow::ensure!(
            shared.is_none(),
            "{} and {} are to be told apart, and both hold {}",
            first.asked,
            second.asked,
            shared.map_or("", String::as_str)
        );
    }
    let wanted = arguments.want.as_ref().map(chosen::wanted).transpose()?;
    let usual = if effects.is_some() { "baseline" } else { "full" };
    let name = arguments.model.as_deref().unwrap_or(usual);
    let mut model = chosen::model(name)?;
    let sought = effects.iter().flatten().chain(wanted.iter().map(|(effect, _)| effect));
    for effect in sought {
        model = chosen::with(model, effect);
    }
    let schedules = schedules(arguments)?;
    let limits = limits(arguments, &schedules[0]);
    let bar = progress::bar(schedules.len(), "looking at schedules");
    let mut observed = Vec::new();
    for schedule in schedules {
        let joint = evidence(&schedule.runs, &model)?;
        let pair = effects.as_ref().map(|effects| pair(&joint, effects));
        observed.push(Observed { told: joint.identifiability(), schedule, pair });
        bar.inc(1);
    }
    bar.finish_and_clear();
    let mut found = Found {
        model: name.into(),
        observed,
        effects,
        wanted,
        limits,
        proposal: None,
        proposed_pair: None,
    };
    if !arguments.compare {
        found.search(&model)?;
    }
    outcome(&found)
}

/// The schedules asked for: all scenarios as one, or each for itself.
fn schedules(arguments: &Observe) -> anyhow::Result<Vec<Schedule>> {
    if !arguments.compare {
        return Ok(vec![Schedule::of(&arguments.scenarios)?]);
    }
    let each = arguments.scenarios.iter().map(|path| {
        let together: Vec<PathBuf> = path.to_string_lossy().split('+').map(PathBuf::from).collect();
        Schedule::of(&together)
    });
    each.collect()
}

/// What the command line says of the table, or else the scenario, or else what is usual.
fn limits(arguments: &Observe, schedule: &Schedule) -> Limits {
    let fastest = schedule.runs.iter().map(schedule::Planned::fastest).fold(0.0, f64::max);
    let usual = if fastest > 0.0 { fastest } else { USUAL_RATE };
    Limits {
        rate: arguments.max_rate.unwrap_or(usual),
        acceleration: arguments
            .max_acceleration
            .or(schedule.runs[0].acceleration)
            .unwrap_or(USUAL_ACCELERATION),
        duration: arguments.max_duration,
        directions: arguments.directions,
    }
}

impl Found {
    /// Looks for the next schedule, if the given one does not do.
    fn search(&mut self, model: &Model) -> anyhow::Result<()> {
        let given = &self.observed[0];
        let goal = match (&self.effects, &given.pair, &self.wanted) {
            (Some(effects), Some(pair), _) if !pair.is_told() => Goal::separate(effects, pair),
            (None, _, Some((effect, sigma))) if !given.knows(effect, *sigma) => {
                Goal::Sigma { effect, sigma: *sigma }
            }
            _ => return Ok(()),
        };
        let proposal = propose(&given.schedule.runs[0], model, &goal, &self.limits)?;
        self.proposed_pair = self.effects.as_ref().map(|effects| pair(&proposal.joint, effects));
        self.proposal = Some(proposal);
        Ok(())
    }
}

impl Pair {
    /// Whether the effects are told apart, each of its usual size.
    fn is_told(&self) -> bool {
        self.told.iter().all(|told| *told >= proposal::ENOUGH)
    }
}

impl Observed {
    /// Whether a parameter is known to this 1σ.
    fn knows(&self, effect: &Effect, sigma: f64) -> bool {
        self.told.find(&effect.ids[0]).is_some_and(|place| self.told.seen[place].sigma <= sigma)
    }
}

fn outcome(found: &Found) -> anyhow::Result<Outcome> {
    let mut fill: Option<crate::outcome::Fill> = None;
    if let Some(proposal) = &found.proposal {
        let path = &found.observed[0].schedule.runs[0].path;
        let scenarios = proposal.scenarios(path, &found.limits)?;
        fill = Some(Box::new(move |folder| {
            for (place, text) in scenarios.iter().enumerate() {
                let path = folder.join(format!("next-{}.toml", place + 1));
                std::fs::write(&path, text).map_err(|source| rins_io::IoError::File {
                    action: "write",
                    path,
                    source,
                })?;
            }
            Ok(())
        }));
    }
    Ok(Outcome {
        json: json::json(found),
        text: words::text(found),
        report: Some(page::report(found)),
        fill,
        ..Outcome::default()
    })
}
