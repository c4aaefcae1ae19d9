//! The effects that are tried on a run: every term of the catalogue, in every shape that could differ.

use rins_estimation::{Reference, Run};
use rins_terms::{Chosen, Model, Need, Term, catalogue};

/// Choices of a frame: nothing could be named by them that a baseline does not hold.
const GAUGES: [&str; 2] = ["mounting", "encoder.zero"];

/// How many times of an event are tried over a run.
const EVENTS: u32 = 16;

/// The orders of the table angle that are tried, signed where a term takes both signs.
const ORDERS: [f64; 9] = [-3.0, -2.0, -1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0];

/// A temperature that changes by less \[K\] shows no effect of temperature.
const LEAST_WARMING: f64 = 0.05;

/// A term in one shape, to be tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The term, all its parameters estimated.
    pub chosen: Chosen,
    /// How many independent shapes stand behind this one: what a test of the best of them costs.
    pub looks: f64,
}

/// What is tried on `run` beyond `model`.
///
/// Terms that the model estimates already, that need what the run does not have, or whose shape is an unknown
/// frequency are left out.
pub fn candidates(run: &Run, model: &Model) -> Vec<Candidate> {
    catalogue::CATALOGUE
        .iter()
        .copied()
        .filter(|term| term.is_signal() && !GAUGES.contains(&term.id))
        .filter(|term| !model.terms.iter().any(|chosen| chosen.term.id == term.id))
        .filter(|term| term.needs.iter().all(|need| offers(run, *need)))
        .flat_map(|term| shapes(run, term))
        .collect()
}

fn offers(run: &Run, need: Need) -> bool {
    match need {
        Need::Temperature => run.recording.temperature.as_ref().is_some_and(|list| {
            let most = list.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            most - list.iter().copied().fold(f64::INFINITY, f64::min) > LEAST_WARMING
        }),
        Need::TableAngle => matches!(run.rig.reference, Reference::Encoder { .. }),
        // Where rates, tilts or senses are too few, the information says so by itself.
        _ => true,
    }
}

/// A term in each of its shapes.
fn shapes(run: &Run, term: &'static Term) -> Vec<Candidate> {
    let duration = run.recording.times[run.recording.len() - 1] - run.recording.times[0];
    let chosen = Chosen::new(term).estimated();
    let named = |name: &str| term.settings.iter().find(|setting| setting.name == name);
    let within = |name: &str, value: f64| {
        named(name).is_some_and(|setting| (setting.within.0..=setting.within.1).contains(&value))
    };
    let of = |name: &str, values: Vec<f64>, looks: f64| {
        let fitting: Vec<f64> = values.into_iter().filter(|value| within(name, *value)).collect();
        let each = (looks / fitting.len() as f64).max(1.0);
        fitting
            .into_iter()
            .map(|value| Candidate {
                chosen: chosen.clone().with_setting(name, value),
                looks: each,
            })
            .collect()
    };
    if named("frequency").is_some() {
        Vec::new()
    } else if named("time").is_some() {
        let times =
            (0..EVENTS).map(|event| duration * (f64::from(event) + 0.5) / f64::from(EVENTS));
        of("time", times.collect(), f64::from(EVENTS))
    } else if named("time_constant").is_some() {
        of("time_constant", [0.03, 0.1, 0.3].map(|part| part * duration).to_vec(), 3.0)
    } else if named("order").is_some() {
        of("order", ORDERS.to_vec(), ORDERS.len() as f64)
    } else {
        vec![Candidate { chosen, looks: 1.0 }]
    }
}
