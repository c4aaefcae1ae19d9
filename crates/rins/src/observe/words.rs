//! What was found of schedules, in words.

use std::fmt::Write as _;

use rins_estimation::{Identifiability, gauge_of};
use rins_frames::units::DEG;

use rins_design::{ENOUGH, Pair};

use super::found::{ObservabilityStudy, Observed};
use crate::identifiability::{gauge_sentences, meaning, name, rank_sentence};
use crate::table::aligned;
use rins_report::number::figure;

/// A number to three digits.
fn short(value: f64) -> String {
    figure(value, 3)
}

/// What is to be said of two effects under a schedule.
pub(super) fn pair_sentences(pair: &Pair, found: &ObservabilityStudy) -> Vec<String> {
    let Some(effects) = &found.effects else { return Vec::new() };
    let mut sentences = Vec::new();
    for (place, separation) in pair.separations.iter().enumerate() {
        let (own, other) = (&effects[place].name, &effects[1 - place].name);
        let Some(worst) = separation.directions.first() else {
            sentences.push(format!("{own} is not observable beside the parameters of the model."));
            continue;
        };
        let weakest = separation
            .directions
            .iter()
            .min_by(|a, b| a.separation.total_cmp(&b.separation))
            .unwrap_or(worst);
        sentences.push(format!(
            "{own} of typical size is detected with {} sigma and separated from {other} by {} ({ENOUGH} required); kappa is {}.",
            short(weakest.detection),
            short(weakest.separation),
            short(worst.kappa)
        ));
    }
    sentences
}

/// What the search came to.
pub(super) fn proposal_sentences(found: &ObservabilityStudy) -> Vec<String> {
    let given = &found.observed[0];
    let limits = &found.limits;
    let within = format!(
        "within {} deg/s, {} deg/s^2, {} s and {} of the axis",
        short(limits.rate / DEG),
        short(limits.acceleration / DEG),
        limits.duration,
        if limits.directions == 1 {
            "one direction".into()
        } else {
            format!("{} directions", limits.directions)
        }
    );
    let Some(proposal) = &found.proposal else {
        return match (&found.effects, &given.pair, &found.wanted) {
            (Some([first, second]), Some(pair), _) if pair.is_separated() => {
                vec![format!("This schedule separates {} from {}.", first.name, second.name)]
            }
            (_, _, Some((effect, sigma))) if given.knows(effect, *sigma) => {
                vec![format!(
                    "This schedule brings {} to the sigma that was asked for.",
                    effect.name
                )]
            }
            _ => Vec::new(),
        };
    };
    let candidate = &proposal.candidate;
    let figure = match (&found.effects, &found.wanted) {
        (Some(_), _) => format!("{} sigma apart", short(proposal.reached)),
        (_, Some((effect, _))) => {
            let identifiability = proposal.joint.identifiability();
            let unit = identifiability
                .find(&effect.ids[0])
                .map(|place| identifiability.unknowns[place].unit);
            unit.map_or_else(String::new, |unit| {
                format!(
                    "{} to {} {}",
                    effect.name,
                    short(proposal.reached / unit.factor),
                    unit.symbol
                )
            })
        }
        _ => String::new(),
    };
    let mut sentences = if proposal.enough {
        vec![format!(
            "Run next: {}, {:.0} s in all. Predicted: {figure}.",
            candidate.words, candidate.duration
        )]
    } else {
        vec![format!(
            "No schedule of the library reaches it {within}; the nearest is {}: {figure}.",
            candidate.words
        )]
    };
    if proposal.enough {
        sentences
            .push(format!("It is the shortest of the library {within}; -o writes its scenario."));
    }
    if let Some([first, second]) = &found.effects {
        let ids: Vec<&str> = first.ids.iter().chain(&second.ids).map(String::as_str).collect();
        if let Some(gauge) = gauge_of(&ids).filter(|_| !proposal.enough) {
            sentences.push(format!("No schedule will: {} is a gauge. {}.", gauge.name, gauge.why));
        }
        for (own, other) in [(first, second), (second, first)] {
            if own.term.partners.contains(&other.term.id) {
                sentences
                    .push(format!("The catalogue on {}: {}.", own.name, own.term.told_apart_by));
            }
        }
    }
    sentences
}

pub(super) fn text(found: &ObservabilityStudy) -> String {
    let mut text = String::new();
    if found.observed.len() > 1 {
        text.push_str(&aligned(&comparison(found)));
        for observed in &found.observed {
            for sentence in observed.pair.iter().flat_map(|pair| pair_sentences(pair, found)) {
                let _ = writeln!(text, "  {}: {sentence}", observed.schedule.name);
            }
        }
        return text;
    }
    let observed = &found.observed[0];
    let identifiability = &observed.identifiability;
    let _ = writeln!(
        text,
        "Schedule {}, duration {:.0} s",
        observed.schedule.name,
        observed.schedule.duration()
    );
    let _ = writeln!(text, "  {}\n", rank_sentence(identifiability));
    let heading =
        ["parameter", "unit", "prior σ", "σ, data only*", "σ, data and prior", "observability"];
    let mut rows = vec![heading.map(String::from).to_vec()];
    rows.extend(
        (0..identifiability.unknowns.len()).map(|place| row(identifiability, place).to_vec()),
    );
    text.push_str(&aligned(&rows));
    text.push_str(
        "  * of the combination, if it is one; the null space is fixed at its prior mean\n",
    );
    for sentence in gauge_sentences(identifiability) {
        let _ = writeln!(text, "  {sentence}");
    }
    let sentences: Vec<String> = observed
        .pair
        .iter()
        .flat_map(|pair| pair_sentences(pair, found))
        .chain(proposal_sentences(found))
        .collect();
    if !sentences.is_empty() {
        text.push('\n');
    }
    for sentence in sentences {
        let _ = writeln!(text, "  {sentence}");
    }
    text
}

/// A parameter as cells of a table.
pub(super) fn row(identifiability: &Identifiability, place: usize) -> [String; 6] {
    let (unknown, seen) = (&identifiability.unknowns[place], &identifiability.parameters[place]);
    let factor = unknown.unit.factor;
    [
        name(identifiability, place),
        unknown.unit.symbol.into(),
        short(unknown.sigma / factor),
        short(seen.data_sigma / factor),
        short(seen.sigma / factor),
        meaning(identifiability, place),
    ]
}

/// Schedules side by side: their sigmas, and what they do not tell.
pub(super) fn comparison(found: &ObservabilityStudy) -> Vec<Vec<String>> {
    let line = |head: &str, of: &dyn Fn(&Observed) -> String| {
        let mut row = vec![head.to_string()];
        row.extend(found.observed.iter().map(of));
        row.push(String::new());
        row
    };
    let mut rows = vec![
        line("schedule", &|observed| observed.schedule.name.clone()),
        line("duration [s]", &|observed| format!("{:.0}", observed.schedule.duration())),
        line("null space", &|observed| {
            (observed.identifiability.unknowns.len() - observed.identifiability.rank.rank())
                .to_string()
        }),
    ];
    if found.effects.is_some() {
        rows.push(line("kappa of the pair", &|observed| {
            let worst = observed
                .pair
                .as_ref()
                .map(|pair| pair.separations[0].kappa().max(pair.separations[1].kappa()));
            worst.map_or_else(String::new, short)
        }));
        rows.push(line("separation [sigma]", &|observed| {
            observed
                .pair
                .as_ref()
                .map_or_else(String::new, |pair| short(pair.separation[0].min(pair.separation[1])))
        }));
    }
    for unknown in found.observed[0]
        .identifiability
        .unknowns
        .iter()
        .filter(|unknown| unknown.run.is_none_or(|run| run == 0))
    {
        let head = format!("{} [{}]", unknown.id, unknown.unit.symbol);
        rows.push(line(&head, &|observed| {
            let identifiability = &observed.identifiability;
            identifiability.find(&unknown.id).map_or_else(String::new, |place| {
                let mark = if identifiability.parameters[place].identifiable { "" } else { " *" };
                format!(
                    "{}{mark}",
                    short(identifiability.parameters[place].sigma / unknown.unit.factor)
                )
            })
        }));
    }
    rows.push(line("* not observable by itself", &|_| String::new()));
    rows
}
