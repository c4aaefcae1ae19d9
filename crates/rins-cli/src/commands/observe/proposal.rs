//! The next test: the shortest schedule that tells two effects apart, or a parameter well enough.

use rins_io::shown;
use std::path::Path;

use anyhow::Context;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rins_estimation::{Direction, Joint, Separation, distance, separation};
use rins_frames::units::DEG;
use rins_terms::Model;
use toml::{Table, Value};

use super::chosen::Effect;
use super::library::{Candidate, Limits, candidates};
use super::schedule::{Planned, evidence};
use crate::progress;

/// By how many sigmas two effects must differ to be told apart.
pub(super) const ENOUGH: f64 = 6.0;

/// What a schedule makes of a pair of effects.
pub(super) struct Pair {
    /// The first effect against the second, and the second against the first.
    pub(super) separations: [Separation; 2],
    /// By how many sigmas the first, of its usual size, is told from the second in its worst direction; and the other way.
    pub(super) told: [f64; 2],
}

/// Where the parameters of an effect stand among the unknowns, of whichever run.
fn places(joint: &Joint, effect: &Effect) -> Vec<usize> {
    let is_of = |place: &usize| effect.ids.contains(&joint.unknowns[*place].id);
    (0..joint.unknowns.len()).filter(is_of).collect()
}

/// The information in units of the priors, with what is known beforehand of all but the two effects.
fn information(joint: &Joint, sought: &[usize]) -> DMatrix<f64> {
    let mut information = joint.information();
    for place in (0..information.nrows()).filter(|place| !sought.contains(place)) {
        information[(place, place)] += 1.0;
    }
    information
}

/// How a schedule's evidence separates two effects, in the model's company.
pub(super) fn pair(joint: &Joint, effects: &[Effect; 2]) -> Pair {
    let [first, second] = effects.each_ref().map(|effect| places(joint, effect));
    let both: Vec<usize> = first.iter().chain(&second).copied().collect();
    let information = information(joint, &both);
    let separations =
        [separation(&information, &first, &second), separation(&information, &second, &first)];
    let told = separations.each_ref().map(|separation| {
        let least = separation.directions.iter().map(|direction| direction.told);
        if separation.directions.is_empty() { 0.0 } else { least.fold(f64::INFINITY, f64::min) }
    });
    Pair { separations, told }
}

/// What is asked of the next schedule.
pub(super) enum Goal<'a> {
    /// Two effects, each in the directions in which the given schedule confuses it with the other.
    Separate { effects: &'a [Effect; 2], confused: [Vec<DVector<f64>>; 2] },
    /// One parameter to this 1σ, in SI units.
    Sigma { effect: &'a Effect, sigma: f64 },
}

impl<'a> Goal<'a> {
    /// To separate two effects where one run of the given schedule confuses them.
    pub(super) fn separate(effects: &'a [Effect; 2], given: &Pair) -> Self {
        let confused = given.separations.each_ref().map(|separation| {
            let along = |direction: &Direction| direction.along.clone();
            separation.directions.iter().map(along).collect()
        });
        Self::Separate { effects, confused }
    }

    /// What a schedule reaches, and whether that is enough: sigmas apart, or a 1σ in SI units.
    fn reached(&self, joint: &Joint) -> (f64, bool) {
        match self {
            Self::Separate { effects, confused } => {
                let [first, second] = effects.each_ref().map(|effect| places(joint, effect));
                let both: Vec<usize> = first.iter().chain(&second).copied().collect();
                let information = information(joint, &both);
                let mut least = f64::INFINITY;
                for (own, alongs) in [first, second].iter().zip(confused) {
                    for along in alongs {
                        // What belongs to a run is of this size in the first.
                        let n = along.len().min(own.len());
                        let along = along.rows(0, n).into_owned();
                        least = least.min(distance(&information, &own[..n], &along));
                    }
                }
                (least, least >= ENOUGH)
            }
            Self::Sigma { effect, sigma } => {
                let told = joint.identifiability();
                let place = told.find(&effect.ids[0]);
                let reached = place.map_or(f64::INFINITY, |place| told.seen[place].sigma);
                (reached, reached <= *sigma)
            }
        }
    }

    /// Whether one figure is nearer to the goal than another.
    fn better(&self, one: f64, other: f64) -> bool {
        match self {
            Self::Separate { .. } => one > other,
            Self::Sigma { .. } => one < other,
        }
    }
}

/// A schedule that reaches a goal, or comes nearest to it.
pub(super) struct Proposal {
    pub(super) candidate: Candidate,
    /// What it reaches: sigmas apart, or a 1σ in SI units.
    pub(super) reached: f64,
    /// Whether that is enough.
    pub(super) enough: bool,
    /// What it says.
    pub(super) joint: Joint,
}

/// The first schedule of the library that reaches the goal, or the one that comes nearest.
pub(super) fn propose(
    given: &Planned,
    model: &Model,
    goal: &Goal<'_>,
    limits: &Limits,
) -> anyhow::Result<Proposal> {
    let all = candidates(given, limits);
    let bar = progress::bar(all.len(), "looking for a schedule");
    let mut best: Option<Proposal> = None;
    let mut all = all.into_iter().peekable();
    while let Some(first) = all.next() {
        // Those of one duration are looked at together.
        let mut group = vec![first];
        while let Some(next) = all.next_if(|next| next.is_as_long_as(&group[0])) {
            group.push(next);
        }
        bar.inc(group.len() as u64);
        let tried = group
            .into_par_iter()
            .map(|candidate| {
                let joint = evidence(&candidate.runs, model)?;
                let (reached, enough) = goal.reached(&joint);
                Ok(Proposal { candidate, reached, enough, joint })
            })
            .collect::<anyhow::Result<Vec<Proposal>>>()?;
        for proposal in tried {
            if proposal.enough {
                bar.finish_and_clear();
                return Ok(proposal);
            }
            let nearer =
                best.as_ref().is_none_or(|best| goal.better(proposal.reached, best.reached));
            if nearer {
                best = Some(proposal);
            }
        }
    }
    bar.finish_and_clear();
    best.context("no schedule fits within the table's limits: a ramp takes longer than its part of any of them")
}

impl Proposal {
    /// Its scenario files, made from that of the schedule at `path`.
    pub(super) fn scenarios(&self, path: &Path, limits: &Limits) -> anyhow::Result<Vec<String>> {
        let text = std::fs::read_to_string(path).with_context(|| shown(path))?;
        let given: Table = text.parse().with_context(|| shown(path))?;
        let runs = self.candidate.runs.iter().enumerate();
        runs.map(|(place, run)| {
            let mut scenario = given.clone();
            let table = section(&mut scenario, "table");
            table.insert("profile".into(), Value::Array(self.profile()));
            let acceleration = format!("{} deg/s^2", limits.acceleration / DEG);
            table.insert("acceleration".into(), Value::String(acceleration));
            if place > 0 {
                let angles = run.nav_from_table().euler_angles();
                let named = [("roll", angles.roll), ("pitch", angles.pitch), ("yaw", angles.yaw)];
                section(&mut scenario, "truth").remove("attitude");
                let attitude = section(&mut scenario, "attitude");
                for (name, angle) in named {
                    attitude.insert(name.into(), Value::String(format!("{:.6} deg", angle / DEG)));
                }
            }
            let written = toml::to_string(&scenario)?;
            Ok(format!(
                "# {}: run {} of {}.\n{written}",
                self.candidate.words,
                place + 1,
                self.candidate.runs.len()
            ))
        })
        .collect()
    }

    fn profile(&self) -> Vec<Value> {
        let part = |segment: &rins_motion::Segment| {
            let mut part = Table::new();
            // Nine digits: a third of a rate is no decimal fraction.
            part.insert(
                "rate".into(),
                Value::String(format!("{} deg/s", rounded(segment.rate / DEG))),
            );
            part.insert(
                "duration".into(),
                Value::String(format!("{} s", rounded(segment.duration))),
            );
            Value::Table(part)
        };
        self.candidate.segments.iter().map(part).collect()
    }
}

fn rounded(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

/// The section of a file of keys, made if it is not there.
fn section<'t>(file: &'t mut Table, name: &str) -> &'t mut Table {
    let value = file.entry(name).or_insert_with(|| Value::Table(Table::new()));
    if !value.is_table() {
        *value = Value::Table(Table::new());
    }
    value.as_table_mut().expect("it is a table by now")
}
