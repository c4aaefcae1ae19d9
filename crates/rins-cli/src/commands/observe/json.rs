//! What was found of schedules, for a machine.

use rins_estimation::Separation;
use rins_frames::units::DEG;
use serde_json::{Value, json};

use super::proposal::ENOUGH;
use super::{Found, Observed, Pair, Proposal};
use crate::view::told::{identifiability_json, parameter_json};

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
        (0..told.unknowns.len()).map(|place| parameter_json(told, place)).collect();
    let mut value = identifiability_json(told);
    value["name"] = json!(schedule.name);
    value["scenarios"] = json!(paths);
    value["duration_s"] = json!(schedule.duration());
    value["parameters"] = json!(parameters);
    value["separation"] = json!(pair.as_ref().map(|pair| separation(pair, found)));
    value
}

/// A number, or null if it is infinite.
fn finite(value: f64) -> Value {
    if value.is_finite() { json!(value) } else { Value::Null }
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
