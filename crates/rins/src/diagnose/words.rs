//! What a diagnosis found, in plain words.

use rins_diagnosis::Unexplained;
use rins_terms::catalogue;

use super::found::{ByChance, DiagnosisOutcome, Named, Verdict};
use super::gain::{failed_prediction, gain_sentence};
use super::structure::{size_in_words, structure_in_words};
use crate::homogeneity::{HeldOutComparison, RunComparison};
use crate::settings::{settings_in_words, symbol};
use rins_report::number::{estimate, figure};

/// How many of the estimates that moved are told in words.
const SHIFTS_TOLD: usize = 3;

/// A delay is a convention of time stamps if it is off whole halves of a sample by less than this part of one.
const CONVENTION: f64 = 0.02;

/// A delay of so many negative sigmas is less than none.
const AHEAD: f64 = 3.0;

/// The result: what was wrong, by how much, how sure, and what it did.
pub(super) fn summary(found: &DiagnosisOutcome) -> Vec<String> {
    let mut sentences = vec![headline(found)];
    sentences.extend(found.causes.iter().filter_map(doubt));
    sentences.extend(found.comparison.as_ref().into_iter().flat_map(RunComparison::differences));
    sentences.extend(found.held_out.iter().flat_map(HeldOutComparison::summary));
    sentences.extend(found.unexplained.iter().map(|one| remainder(found, one)));
    if found.causes.is_empty() {
        sentences.extend(failed_prediction(&found.gain));
    } else {
        sentences.push(damage(found));
        sentences.push(gain_sentence(&found.gain));
        sentences.extend(found.transfer.as_ref().map(gain_sentence));
    }
    sentences.extend(found.causes.iter().filter(|named| !named.plausible).map(|named| {
        format!(
            "The {} is larger than is plausible for such an instrument: look for another cause with a similar signature.",
            named.cause.term.name
        )
    }));
    if found.causes.iter().any(is_ahead_of_its_time) {
        sentences.push(
            "A negative latency of an encoder is not plausible: a latency of gyros and accelerometers of the same size has the same signature."
                .to_owned(),
        );
    }
    if found.causes.iter().any(|named| is_convention(found, named)) {
        sentences.push(
            "A latency of whole or half samples is a convention of the log: state it by `latency` under [log] table_angle, or by \
             another `stamp`."
                .to_owned(),
        );
    }
    if let Some(ByChance { draws, share }) = found.by_chance {
        sentences.push(format!(
            "Of {draws} runs that were simulated with the extended model and diagnosed, {} % have a false detection; 1 % is allowed.",
            figure(100.0 * share, 2)
        ));
    }
    if !found.untestable.is_empty() {
        sentences.push(format!(
            "{} effects of the catalogue are not testable with this run: it can neither confirm nor exclude them.",
            found.untestable.len()
        ));
    }
    sentences.extend(found.certificate.remarks.iter().cloned());
    sentences
}

/// Whether a latency of the table angle is negative, and not by chance.
fn is_ahead_of_its_time(named: &Named) -> bool {
    let delay = named.cause.parameters.first();
    named.cause.term.is(&catalogue::ENCODER_LATENCY)
        && delay.is_some_and(|delay| delay.value < -AHEAD * delay.sigma)
}

/// Whether the table's angle is late, or early, by whole samples or by half ones.
fn is_convention(found: &DiagnosisOutcome, named: &Named) -> bool {
    let samples = named.cause.parameters.first().and_then(|delay| found.in_samples(delay));
    let is = |samples: f64| {
        let halves = (2.0 * samples).round();
        halves != 0.0 && (2.0 * samples - halves).abs() < CONVENTION
    };
    named.cause.term.is(&catalogue::ENCODER_LATENCY) && samples.is_some_and(is)
}

fn headline(found: &DiagnosisOutcome) -> String {
    if found.verdict == Verdict::Adequate && !found.causes.is_empty() {
        let supposed: Vec<&str> = found.causes.iter().map(|named| named.cause.term.name).collect();
        return format!(
            "The model ({}) is adequate without the hypothesis ({}), which is not significant in this run.",
            found.certificate.model,
            supposed.join(", ")
        );
    }
    if found.verdict == Verdict::Adequate {
        return format!(
            "The model ({}) is adequate: no effect of the catalogue is significant in this run, and the residuals are noise.",
            found.certificate.model
        );
    }
    if found.causes.is_empty() {
        return format!(
            "The model ({}) does not explain this run, and no effect of the catalogue does either.",
            found.certificate.model
        );
    }

    let effects: Vec<String> = found
        .causes
        .iter()
        .map(|named| {
            format!(
                "{} ({}), {}, significance {:.0}σ, p = {}",
                named.cause.term.name,
                named.cause.term.cause,
                amplitude(found, named),
                named.sigmas,
                probability(named.cause.ln_p)
            )
        })
        .collect();
    match &effects[..] {
        [only] => format!("One unmodeled effect was identified: {only}."),
        several => {
            format!("{} unmodeled effects were identified: {}.", several.len(), several.join("; "))
        }
    }
}

/// What no effect explains, and what harm it may do.
fn remainder(found: &DiagnosisOutcome, one: &Unexplained) -> String {
    let size = size_in_words(one).map_or_else(String::new, |size| format!(", {size}"));
    let fit = &found.certificate.fit;
    let worst: Vec<String> = one
        .worst
        .iter()
        .filter_map(|(id, value)| {
            let unit = fit.parameter(id)?.parameter.unit;
            Some(format!("{id} by {} {}", figure(value / unit.factor, 2), unit.symbol))
        })
        .collect();
    let harm = if worst.is_empty() {
        String::new()
    } else {
        format!("; at worst it biases {}", worst.join(", "))
    };
    format!(
        "Unexplained residual structure, on {}: {}{size}, p = {}{harm}.",
        one.channel,
        structure_in_words(one),
        probability(one.ln_p)
    )
}

/// A cause's amplitude: its parameters that are not zero, with their sigma.
fn amplitude(found: &DiagnosisOutcome, named: &Named) -> String {
    let cause = &named.cause;
    let largest = cause
        .parameters
        .iter()
        .map(|estimate| (estimate.value / estimate.sigma).abs())
        .fold(0.0, f64::max);
    // What is not seen at all would only hide what is.
    let told = cause.parameters.iter().filter(|estimate| {
        let size = (estimate.value / estimate.sigma).abs();
        size > 2.0_f64.min(largest) || size >= largest
    });
    let mut parts: Vec<String> = told
        .map(|own| {
            let (unit, name) = (own.parameter.unit, &own.parameter.id);
            let name = name.rsplit('.').next().unwrap_or(name);
            let (value, sigma) = estimate(own.value / unit.factor, own.sigma / unit.factor);
            let samples = found
                .in_samples(own)
                .map_or_else(String::new, |count| format!(" ({} samples)", figure(count, 3)));
            let symbol = symbol(unit);
            format!("{name} = {value} ± {sigma} {symbol}{samples}").trim_end().to_owned() + " (1σ)"
        })
        .collect();
    let settings = settings_in_words(cause.term, &cause.settings, cause.sought);
    if !settings.is_empty() {
        parts.push(settings);
    }
    parts.join(", ")
}

/// The effects from which a cause is not distinguished.
fn doubt(named: &Named) -> Option<String> {
    let alternatives = alternatives(named);
    let next = match (&named.next_test, &named.no_next_test) {
        (Some(test), _) => format!(
            " A run that separates it from the {}, by {} sigma: {}.",
            test.from.name,
            figure(test.sigmas, 2),
            test.words
        ),
        (None, Some(why)) => format!(" No discriminating test can be proposed: {why}."),
        (None, None) => String::new(),
    };
    (!alternatives.is_empty()).then(|| {
        format!(
            "This run does not distinguish the {} from: {alternatives}.{next}",
            named.cause.term.name
        )
    })
}

/// The alternatives to a cause, in words.
pub(super) fn alternatives(named: &Named) -> String {
    let alternatives = named
        .cause
        .rivals
        .iter()
        .map(|rival| format!("{} ({})", rival.term.name, odds_in_words((-rival.odds).exp())));
    alternatives.collect::<Vec<_>>().join(", ")
}

fn odds_in_words(odds: f64) -> String {
    match odds {
        ..1.05 => "equally probable".into(),
        1.05..9.5 => format!("{odds:.1} times less probable"),
        _ => format!("{odds:.0} times less probable"),
    }
}

/// What the causes did to the estimates as long as they were not in the model.
fn damage(found: &DiagnosisOutcome) -> String {
    if found.shifts.is_empty() {
        return format!(
            "Without {} in the model no estimate is biased by more than its sigma.",
            these_effects(found)
        );
    }
    let told: Vec<String> = found
        .shifts
        .iter()
        .take(SHIFTS_TOLD)
        .map(|shift| {
            let unit = shift.before.parameter.unit;
            format!(
                "{} by {} {} ({:.1}σ)",
                shift.before.parameter.id,
                figure((shift.before.value - shift.after.value) / unit.factor, 3).replace('-', "−"),
                unit.symbol,
                shift.sigmas().abs()
            )
        })
        .collect();
    let more = found.shifts.len() - told.len();
    let more = if more == 0 { String::new() } else { format!(", and {more} more") };
    format!(
        "Without {} in the model the estimates are biased: {}{more}.",
        these_effects(found),
        told.join(", ")
    )
}

fn these_effects(found: &DiagnosisOutcome) -> &'static str {
    if found.causes.len() == 1 { "this effect" } else { "these effects" }
}

/// For each effect that is not distinguished from others, the test that does.
pub(super) fn separating_tests(found: &DiagnosisOutcome) -> Vec<String> {
    found
        .causes
        .iter()
        .filter(|named| !named.cause.rivals.is_empty())
        .map(|named| {
            format!(
                "To distinguish the {}: {}.",
                named.cause.term.name, named.cause.term.told_apart_by
            )
        })
        .collect()
}

/// A probability, from its logarithm, which may be of any size.
pub(super) fn probability(ln_p: f64) -> String {
    let power = ln_p / std::f64::consts::LN_10;
    if power > -3.0 {
        return format!("{:.3}", ln_p.exp());
    }
    let whole = power.floor();
    format!("{:.0}e{whole:.0}", 10.0_f64.powf(power - whole).floor().max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_probability_beyond_all_numbers_is_still_told() {
        assert_eq!(probability((0.25_f64).ln()), "0.250");
        assert_eq!(probability((3.2e-7_f64).ln()), "3e-7");
        assert_eq!(probability(-1204.0), "1e-523");
    }
}
