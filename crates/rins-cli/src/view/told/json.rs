//! What data tell of parameters, for a machine.

use rins_estimation::{Identifiability, Shown};
use serde_json::{Value, json};

use super::{OBSERVABLE, Sorted, coefficient, gauges};

/// What is told of all parameters together, and how each is told.
pub(crate) fn identifiability_json(told: &Identifiability) -> Value {
    let ids = |places: &[usize]| -> Vec<&str> {
        places.iter().map(|&place| told.unknowns[place].id.as_str()).collect()
    };
    let Sorted { observable, in_combination, unobservable } = Sorted::of(told);
    let gauges: Vec<Value> = gauges(told)
        .into_iter()
        .map(|gauge| {
            let of = (0..told.seen.len()).filter(|&place| told.seen[place].gauge == Some(gauge));
            let of: Vec<usize> = of.collect();
            json!({ "name": gauge.name, "why": gauge.why, "parameters": ids(&of) })
        })
        .collect();
    json!({
        "unknowns": told.unknowns.len(),
        "rank": told.rank.rank(),
        "rank_loss": told.unknowns.len() - told.rank.rank(),
        "told_better_than_known": told.rank.kept.len(),
        "least_told": told.rank.least_told,
        "most_null": told.rank.most_null,
        "alone": ids(&observable),
        "in_combination": ids(&in_combination),
        "not_shown": ids(&unobservable),
        "gauges": gauges,
    })
}

/// What is told of a parameter.
pub(crate) fn parameter_json(told: &Identifiability, place: usize) -> Value {
    let (unknown, seen) = (&told.unknowns[place], &told.seen[place]);
    let factor = unknown.unit.factor;
    let shown = match seen.shown {
        Shown::Alone => "alone",
        Shown::Combination => "combination",
        Shown::Part { .. } => "part",
        Shown::Nothing => "nothing",
    };
    let aliases: Vec<&str> =
        seen.aliases.iter().map(|alias| told.unknowns[alias.unknown].id.as_str()).collect();
    let combination: Vec<Value> = seen
        .aliases
        .iter()
        .map(|alias| {
            let other = &told.unknowns[alias.unknown];
            json!({
                "id": other.id,
                "run": other.run.map(|run| run + 1),
                "coefficient": coefficient(told, place, alias),
                "exactly": alias.exactly,
            })
        })
        .collect();
    json!({
        "id": unknown.id,
        "run": unknown.run.map(|run| run + 1),
        "unit": unknown.unit.symbol,
        "prior_sigma": unknown.sigma / factor,
        "data_sigma": seen.data_sigma.is_finite().then_some(seen.data_sigma / factor),
        "sigma": seen.sigma / factor,
        "identifiable": seen.identifiable,
        "observability": match seen.shown {
            _ if seen.identifiable => OBSERVABLE,
            Shown::Combination | Shown::Part { .. } => "combination",
            Shown::Alone | Shown::Nothing => "prior_dominated",
        },
        "shown": shown,
        "exactly": seen.aliases.iter().any(|alias| alias.exactly),
        "aliases": aliases,
        "combination": combination,
        "gauge": seen.gauge.map(|gauge| gauge.name),
    })
}
