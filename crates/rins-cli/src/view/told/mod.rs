//! What data tell of parameters, in words.

mod json;

use std::fmt::Write as _;

use rins_estimation::{Alias, Gauge, Identifiability, Shown};

pub(crate) use self::json::{identifiability_json, parameter_json};
use crate::number::figure;
use crate::report::{Cell, Tone};

/// How many of those of which nothing is told are named in a sentence.
const MOST_NAMED: usize = 12;

/// What stands beside a parameter in a sum.
pub(crate) struct Summand<'a> {
    /// How much one of its unit counts, in the parameter's unit.
    pub(crate) coefficient: f64,
    /// Its unit.
    pub(crate) unit: &'a str,
    /// What it is called.
    pub(crate) name: String,
}

/// A sum as a person reads it, such as `only gyro.misalignment.xz + 5.73 arcsec/(deg/h) × gyro.bias.x`.
pub(crate) fn sum_in_words<'a>(
    name: &str,
    unit: &str,
    others: impl IntoIterator<Item = Summand<'a>>,
) -> String {
    let mut sum = format!("only {name}");
    for other in others {
        let sign = if other.coefficient < 0.0 { '-' } else { '+' };
        let size = figure(other.coefficient.abs(), 3);
        // Writing to a string cannot fail.
        let _ = write!(sum, " {sign} ");
        if other.unit != unit {
            let _ = write!(sum, "{size} {unit}/({}) × ", other.unit);
        } else if size != "1.00" {
            let _ = write!(sum, "{size} × ");
        }
        sum.push_str(&other.name);
    }
    sum
}

/// What is told of a parameter alone.
pub(crate) const ITSELF: &str = "itself";

/// The name of an unknown, with its run if there are several.
pub(crate) fn name(told: &Identifiability, place: usize) -> String {
    let unknown = &told.unknowns[place];
    match unknown.run {
        Some(run) => format!("{} of run {}", unknown.id, run + 1),
        None => unknown.id.clone(),
    }
}

/// What of an unknown is told, as a person reads it.
pub(crate) fn meaning(told: &Identifiability, place: usize) -> String {
    let (unknown, seen) = (&told.unknowns[place], &told.seen[place]);
    match seen.shown {
        Shown::Alone if seen.identifiable => ITSELF.into(),
        Shown::Alone => "itself, hardly better than it was known".into(),
        Shown::Nothing => "nothing that was not known before".into(),
        Shown::Combination | Shown::Part { .. } => {
            let summand = |alias: &Alias| Summand {
                coefficient: coefficient(told, place, alias),
                unit: told.unknowns[alias.unknown].unit.symbol,
                name: name(told, alias.unknown),
            };
            let others = seen.aliases.iter().map(summand);
            let sum = sum_in_words(&name(told, place), unknown.unit.symbol, others);
            let gauge = seen.gauge.map(|gauge| format!("; a choice of {}", gauge.name));
            sum + &gauge.unwrap_or_default()
        }
    }
}

/// What one of an alias' unit counts, in the unit of the parameter beside which it stands.
pub(crate) fn coefficient(told: &Identifiability, place: usize, alias: &Alias) -> f64 {
    let factor = |place: usize| told.unknowns[place].unit.factor;
    alias.coefficient * factor(alias.unknown) / factor(place)
}

/// The same as a badge.
pub(crate) fn badge(told: &Identifiability, place: usize) -> Cell {
    let seen = &told.seen[place];
    match seen.shown {
        _ if seen.identifiable => Cell::badge(Tone::Good, "identifiable"),
        Shown::Part { .. } if seen.gauge.is_some() => Cell::badge(Tone::Neutral, "gauge"),
        Shown::Combination | Shown::Part { .. } => Cell::badge(Tone::Warning, "combination"),
        Shown::Alone | Shown::Nothing => Cell::badge(Tone::Neutral, "not shown"),
    }
}

/// Which unknowns are told alone, which only in sums, and which not at all.
struct Sorted {
    alone: Vec<usize>,
    in_combination: Vec<usize>,
    not_shown: Vec<usize>,
}

impl Sorted {
    fn of(told: &Identifiability) -> Self {
        let (alone, others): (Vec<usize>, Vec<usize>) =
            (0..told.seen.len()).partition(|&place| told.seen[place].identifiable);
        let (not_shown, in_combination) =
            others.into_iter().partition(|&place| told.seen[place].aliases.is_empty());
        Self { alone, in_combination, not_shown }
    }
}

/// How many are told how, in a sentence or two.
pub(crate) fn rank_sentence(told: &Identifiability) -> String {
    let Sorted { alone, in_combination, not_shown } = Sorted::of(told);
    let (n, rank) = (told.unknowns.len(), told.rank.rank());
    let mut text = format!(
        "Of {n} parameters the data tell {} by themselves and {} only in combinations",
        alone.len(),
        in_combination.len()
    );
    if !not_shown.is_empty() {
        let mut names: Vec<String> =
            not_shown.iter().take(MOST_NAMED).map(|&place| name(told, place)).collect();
        if not_shown.len() > MOST_NAMED {
            names.push(format!("{} others", not_shown.len() - MOST_NAMED));
        }
        let _ = write!(text, ", and nothing of {}", list(&names));
    }
    let lost = match n - rank {
        0 => "no combination is invisible altogether".to_string(),
        1 => "one combination is exactly invisible".to_string(),
        lost => format!("{lost} combinations are exactly invisible"),
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
fn gauges(told: &Identifiability) -> Vec<&'static Gauge> {
    let mut met: Vec<&'static Gauge> = Vec::new();
    for gauge in told.seen.iter().filter_map(|seen| seen.gauge) {
        if !met.contains(&gauge) {
            met.push(gauge);
        }
    }
    met
}

/// What no schedule tells, a sentence for each gauge met.
pub(crate) fn gauge_sentences(told: &Identifiability) -> Vec<String> {
    let sentence =
        |gauge: &Gauge| format!("Gauge, under every schedule: {}: {}.", gauge.name, gauge.why);
    gauges(told).into_iter().map(sentence).collect()
}
