//! The observability of parameters, in words.

mod result;

use std::fmt::Write as _;

use rins_estimation::{Alias, Gauge, Identifiability, Observable};

pub use self::result::{
    GaugeResult, IdentifiabilityResult, ObservabilityResult, PredictedResult, SummandResult,
};
use rins_report::number::{estimate, figure};
use rins_report::{Cell, Tone};

/// The most parameters that a sentence names.
const MOST_NAMED: usize = 12;

/// A further parameter of a combination.
pub(crate) struct Summand<'a> {
    /// How much one of its unit counts, in the parameter's unit.
    pub(crate) coefficient: f64,
    /// Its unit.
    pub(crate) unit: &'a str,
    /// What it is called.
    pub(crate) name: String,
}

/// A combination as a person reads it, such as `gyro.misalignment.xz + 5.73 arcsec/(deg/h) × gyro.bias.x`.
pub(crate) fn sum_in_words<'a>(
    name: &str,
    unit: &str,
    others: impl IntoIterator<Item = Summand<'a>>,
) -> String {
    let mut sum = name.to_owned();
    for other in others {
        let sign = if other.coefficient < 0.0 { '−' } else { '+' };
        let size = figure(other.coefficient.abs(), 3);
        // Writing to a string cannot fail.
        let _ = write!(sum, " {sign} ");
        if other.unit != unit {
            let _ = write!(sum, "{size} {} × ", ratio(unit, other.unit));
        } else if size != "1.00" {
            let _ = write!(sum, "{size} × ");
        }
        sum.push_str(&other.name);
    }
    sum
}

/// A unit over another.
fn ratio(unit: &str, other: &str) -> String {
    if other.contains(['/', '*']) { format!("{unit}/({other})") } else { format!("{unit}/{other}") }
}

/// The observability of a parameter that the data show by itself.
pub(crate) const OBSERVABLE: &str = "observable";

/// The observability of a parameter of which the data reduce the sigma by less than a factor of two.
const PRIOR_DOMINATED: &str = "prior-dominated";

/// The observability of a parameter that does not affect the data.
const UNOBSERVABLE: &str = "unobservable";

/// The observability of a parameter that only this combination shows, and what the combination was found to be.
pub(crate) fn only_in(combination: &str, found: Option<(f64, f64, &str)>) -> String {
    let found = found.map(|(value, sigma, unit)| {
        let (value, sigma) = estimate(value, sigma);
        format!(" = {value} ± {sigma} {unit} (1σ)")
    });
    format!("observable only in the combination {combination}{}", found.unwrap_or_default())
}

/// The name of an unknown, with its run if there are several.
pub(crate) fn name(identifiability: &Identifiability, place: usize) -> String {
    let unknown = &identifiability.unknowns[place];
    match unknown.run {
        Some(run) => format!("{} of run {}", unknown.id, run + 1),
        None => unknown.id.clone(),
    }
}

/// The observability of an unknown, as a person reads it.
pub(crate) fn meaning(identifiability: &Identifiability, place: usize) -> String {
    observability(identifiability, place, None)
}

/// The same with what the combination was found to be, if one is what is observable: value and 1σ in SI units.
pub(crate) fn observability(
    identifiability: &Identifiability,
    place: usize,
    found: Option<(f64, f64)>,
) -> String {
    let (unknown, seen) = (&identifiability.unknowns[place], &identifiability.parameters[place]);
    match seen.shown {
        _ if seen.identifiable => OBSERVABLE.into(),
        Observable::Alone => PRIOR_DOMINATED.into(),
        Observable::Nothing => UNOBSERVABLE.into(),
        Observable::Combination | Observable::Part { .. } => {
            let summand = |alias: &Alias| Summand {
                coefficient: coefficient(identifiability, place, alias),
                unit: identifiability.unknowns[alias.unknown].unit.symbol,
                name: name(identifiability, alias.unknown),
            };
            let others = seen.aliases.iter().map(summand);
            let sum = sum_in_words(&name(identifiability, place), unknown.unit.symbol, others);
            let unit = unknown.unit;
            let found =
                found.map(|(value, sigma)| (value / unit.factor, sigma / unit.factor, unit.symbol));
            let gauge = seen.gauge.map(|gauge| format!("; choice of reference: {}", gauge.name));
            only_in(&sum, found) + &gauge.unwrap_or_default()
        }
    }
}

/// What one of an alias' unit counts, in the unit of the parameter beside which it stands.
pub(crate) fn coefficient(identifiability: &Identifiability, place: usize, alias: &Alias) -> f64 {
    let factor = |place: usize| identifiability.unknowns[place].unit.factor;
    alias.coefficient * factor(alias.unknown) / factor(place)
}

/// The observability as a badge.
pub(crate) fn badge(identifiability: &Identifiability, place: usize) -> Cell {
    let seen = &identifiability.parameters[place];
    match seen.shown {
        _ if seen.identifiable => Cell::badge(Tone::Good, OBSERVABLE),
        Observable::Part { .. } if seen.gauge.is_some() => {
            Cell::badge(Tone::Neutral, "choice of reference")
        }
        Observable::Combination | Observable::Part { .. } => {
            Cell::badge(Tone::Warning, "combination")
        }
        Observable::Alone => Cell::badge(Tone::Neutral, PRIOR_DOMINATED),
        Observable::Nothing => Cell::badge(Tone::Neutral, UNOBSERVABLE),
    }
}

/// Which unknowns are observable, which only in combinations, and which not.
struct Sorted {
    observable: Vec<usize>,
    in_combination: Vec<usize>,
    unobservable: Vec<usize>,
}

impl Sorted {
    fn of(identifiability: &Identifiability) -> Self {
        let (observable, others): (Vec<usize>, Vec<usize>) = (0..identifiability.parameters.len())
            .partition(|&place| identifiability.parameters[place].identifiable);
        let in_combination = others
            .into_iter()
            .filter(|&place| !identifiability.parameters[place].aliases.is_empty())
            .collect();
        Self { observable, in_combination, unobservable: identifiability.unobservable() }
    }
}

/// How many parameters are observable, in combinations, or not.
pub(crate) fn rank_sentence(identifiability: &Identifiability) -> String {
    let Sorted { observable, in_combination, unobservable } = Sorted::of(identifiability);
    let (n, rank) = (identifiability.unknowns.len(), identifiability.rank.rank());
    let mut text = format!(
        "Of {n} parameters {} are observable and {} only in combinations",
        observable.len(),
        in_combination.len()
    );
    let (prior_dominated, unobservable): (Vec<usize>, Vec<usize>) = unobservable
        .iter()
        .partition(|&&place| identifiability.parameters[place].shown == Observable::Alone);
    for (places, status) in [(prior_dominated, PRIOR_DOMINATED), (unobservable, UNOBSERVABLE)] {
        if places.is_empty() {
            continue;
        }
        let mut names: Vec<String> =
            places.iter().take(MOST_NAMED).map(|&place| name(identifiability, place)).collect();
        if places.len() > MOST_NAMED {
            names.push(format!("{} others", places.len() - MOST_NAMED));
        }
        let verb = if places.len() == 1 { "is" } else { "are" };
        let _ = write!(text, "; {} {verb} {status}", list(&names));
    }
    let lost = match n - rank {
        0 => "there is no null space".to_string(),
        1 => "the null space has one dimension".to_string(),
        lost => format!("the null space has {lost} dimensions"),
    };
    format!("{text}; {lost}.")
}

pub(crate) fn list(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [before @ .., last] => format!("{} and {last}", before.join(", ")),
    }
}

/// The gauges met, each once.
fn gauges(identifiability: &Identifiability) -> Vec<&'static Gauge> {
    let mut met: Vec<&'static Gauge> = Vec::new();
    for gauge in identifiability.parameters.iter().filter_map(|seen| seen.gauge) {
        if !met.contains(&gauge) {
            met.push(gauge);
        }
    }
    met
}

/// The choices of reference among the parameters, a sentence for each.
pub(crate) fn gauge_sentences(identifiability: &Identifiability) -> Vec<String> {
    let sentence = |gauge: &Gauge| {
        format!(
            "Choice of reference, unobservable under every schedule: {}; {}.",
            gauge.name, gauge.why
        )
    };
    gauges(identifiability).into_iter().map(sentence).collect()
}
