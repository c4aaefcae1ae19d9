//! What was found of schedules, for a machine.

use rins_estimation::{Alias, Identifiability, Separation, Shown};
use rins_frames::units::DEG;
use serde_json::{Value, json};

use super::proposal::ENOUGH;
use super::{Found, Observed, Pair, Proposal};

pub(super) fn json(found: &Found) -> Value {
    let schedules: Vec<Value> =
        found.observed.iter().map(|observed| schedule(observed, found)).collect();
    json!({
        "schema": 1,
        "command": "observe",
        "model": found.model,
        "schedules": schedules,
        "limits": {
            "rate_deg_s": found.limits.rate / DEG,
            "acceleration_deg_s2": found.limits.acceleration / DEG,
            "duration_s": found.limits.duration,
            "directions": found.limits.directions,
        },
        "proposal": found.proposal.as_ref().map(|proposal| proposed(proposal, found)),
    })
}

fn schedule(observed: &Observed, found: &Found) -> Value {
    let Observed { schedule, told, pair } = observed;
    let paths: Vec<String> =
        schedule.runs.iter().map(|run| run.path.display().to_string()).collect();
    let parameters: Vec<Value> =
        (0..told.unknowns.len()).map(|place| parameter(told, place)).collect();
    json!({
        "name": schedule.name,
        "scenarios": paths,
        "duration_s": schedule.duration(),
        "unknowns": told.unknowns.len(),
        "rank": told.rank.rank(),
        "rank_loss": told.unknowns.len() - told.rank.rank(),
        "told_better_than_known": told.rank.kept.len(),
        "least_told": told.rank.least_told,
        "most_null": told.rank.most_null,
        "parameters": parameters,
        "separation": pair.as_ref().map(|pair| separation(pair, found)),
    })
}

/// A number, or null if it is infinite.
fn finite(value: f64) -> Value {
    if value.is_finite() { json!(value) } else { Value::Null }
}

fn parameter(told: &Identifiability, place: usize) -> Value {
    let (unknown, seen) = (&told.unknowns[place], &told.seen[place]);
    let factor = unknown.unit.factor;
    let id = |place: usize| told.unknowns[place].id.clone();
    let (shown, exactly, aliases): (&str, bool, Vec<String>) = match &seen.shown {
        Shown::Alone => ("alone", false, Vec::new()),
        Shown::Combination(aliases) => (
            "combination",
            aliases.iter().any(|alias| alias.exactly),
            aliases.iter().map(|alias| id(alias.unknown)).collect(),
        ),
        Shown::Part { of, exactly } => ("part", *exactly, of.iter().copied().map(id).collect()),
        Shown::Nothing => ("nothing", false, Vec::new()),
    };
    let combination: Vec<Value> = match &seen.shown {
        Shown::Combination(aliases) => {
            aliases.iter().map(|alias| summand(told, alias, factor)).collect()
        }
        _ => Vec::new(),
    };
    json!({
        "id": unknown.id,
        "run": unknown.run.map(|run| run + 1),
        "unit": unknown.unit.symbol,
        "prior_sigma": unknown.sigma / factor,
        "data_sigma": finite(seen.data_sigma / factor),
        "sigma": seen.sigma / factor,
        "identifiable": seen.identifiable,
        "shown": shown,
        "exactly": exactly,
        "aliases": aliases,
        "combination": combination,
        "gauge": seen.gauge.map(|gauge| gauge.name),
    })
}

fn summand(told: &Identifiability, alias: &Alias, factor: f64) -> Value {
    let unknown = &told.unknowns[alias.unknown];
    json!({
        "id": unknown.id,
        "run": unknown.run.map(|run| run + 1),
        "coefficient": alias.coefficient * unknown.unit.factor / factor,
        "exactly": alias.exactly,
    })
}

fn separation(pair: &Pair, found: &Found) -> Value {
    let asked = |place: usize| found.effects.as_ref().map(|effects| effects[place].asked.clone());
    let of = |place: usize| {
        let separation: &Separation = &pair.separations[place];
        let directions: Vec<Value> = separation
            .directions
            .iter()
            .map(|direction| {
                json!({
                    "kappa": finite(direction.kappa),
                    "seen_sigma": direction.seen,
                    "told_sigma": direction.told,
                    "along": direction.along.as_slice(),
                })
            })
            .collect();
        json!({
            "effect": asked(place),
            "from": asked(1 - place),
            "kappa": finite(separation.kappa()),
            "told_sigma": pair.told[place],
            "directions": directions,
            "absorbed": separation.absorbed[0],
        })
    };
    json!({ "enough_sigma": ENOUGH, "told": pair.is_told(), "each": [of(0), of(1)] })
}

fn proposed(proposal: &Proposal, found: &Found) -> Value {
    let candidate = &proposal.candidate;
    let profile: Vec<Value> = candidate
        .segments
        .iter()
        .map(|part| json!({ "rate_deg_s": part.rate / DEG, "duration_s": part.duration }))
        .collect();
    let attitudes: Vec<Value> = candidate
        .runs
        .iter()
        .map(|run| crate::view::euler_json(&run.nav_from_table().euler_angles()))
        .collect();
    let files: Vec<String> =
        (1..=candidate.runs.len()).map(|place| format!("next-{place}.toml")).collect();
    let sigma = found.wanted.as_ref().and_then(|(effect, _)| {
        let told = proposal.joint.identifiability();
        let place = told.find(&effect.ids[0])?;
        Some(told.seen[place].sigma / told.unknowns[place].unit.factor)
    });
    json!({
        "schedule": candidate.words,
        "duration_s": candidate.duration,
        "profile": profile,
        "attitude_deg": attitudes,
        "enough": proposal.enough,
        "told_sigma": if found.effects.is_some() { json!(proposal.reached) } else { Value::Null },
        "sigma": sigma,
        "separation": found.proposed_pair.as_ref().map(|pair| separation(pair, found)),
        "files": files,
    })
}
