//! The catalogue's effects as hidden ones, and as their rivals.

use rins_blind::Effect;
use rins_terms::{Chosen, Term, catalogue};

/// What the baseline holds anyway, what is a choice of frame, and what leaves nothing behind.
const NEVER_HIDDEN: [&str; 11] = [
    "gyro.bias",
    "gyro.scale",
    "gyro.misalignment",
    "accel.bias",
    "accel.scale",
    "accel.misalignment",
    "axis.attitude",
    "axis.azimuth",
    "mounting",
    "encoder.zero",
    "table_rate_ripple",
];

/// The orders of the table angle at which rivals are tried.
const ORDERS: [f64; 12] = [-4.0, -3.0, -2.0, -1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 12.0];

/// The parts of a run after which something happens.
const PARTS: u32 = 16;

/// Whether a term is a signal that can be hidden in a run.
pub fn is_hideable(term: &Term) -> bool {
    term.is_signal() && !NEVER_HIDDEN.contains(&term.id)
}

/// A term with its numbers, as the generator takes it.
pub fn hidden(chosen: &Chosen) -> Effect {
    Effect::new(chosen.term.id, &chosen.values, &chosen.settings)
}

/// Every effect in every shape that a run of `duration` \[s\] could show, but for lines of any frequency.
pub(crate) fn rivals(duration: f64) -> Vec<Chosen> {
    let mut rivals = Vec::new();
    for term in catalogue::CATALOGUE.iter().copied().filter(|term| is_hideable(term)) {
        let chosen = Chosen::new(term).estimated();
        let with = |name: &str, values: &[f64]| -> Vec<Chosen> {
            let setting = term.settings.iter().find(|setting| setting.name == name);
            let fits =
                |value: &&f64| setting.is_some_and(|s| (s.within.0..=s.within.1).contains(*value));
            values.iter().filter(fits).map(|&v| chosen.clone().with_setting(name, v)).collect()
        };
        let has = |name: &str| term.settings.iter().any(|setting| setting.name == name);
        if has("frequency") {
            continue;
        }
        if has("time") {
            let part = |number| duration * (f64::from(number) + 0.5) / f64::from(PARTS);
            rivals.extend(with("time", &(0..PARTS).map(part).collect::<Vec<_>>()));
        } else if has("time_constant") {
            rivals.extend(with("time_constant", &[0.03, 0.1, 0.3].map(|part| part * duration)));
        } else if has("order") {
            rivals.extend(with("order", &ORDERS));
        } else {
            rivals.push(chosen);
        }
    }
    rivals
}

/// The effects of the shape that another one has: of its order, frequency or time.
pub(crate) fn alike(chosen: &Chosen) -> Vec<Chosen> {
    let own = chosen.term.settings.iter().zip(&chosen.settings);
    own.flat_map(|(setting, &value)| {
        let has = move |term: &&'static Term| {
            let same = term.settings.iter().find(|other| other.name == setting.name);
            same.is_some_and(|s| (s.within.0..=s.within.1).contains(&value))
        };
        let terms = catalogue::CATALOGUE.iter().copied().filter(|term| is_hideable(term));
        terms
            .filter(has)
            .map(move |term| Chosen::new(term).estimated().with_setting(setting.name, value))
    })
    .collect()
}
