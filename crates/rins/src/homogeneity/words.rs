//! The comparison of runs in words.

use std::collections::BTreeSet;

use rins_history::{Cause, Conditions, Variation};
use rins_io::date_text;
use rins_report::number::{estimate, figure};
use rins_report::{Item, Section};

use super::comparison::RunComparison;
use crate::consistency::probability;
use crate::log::DAY;
use crate::table::captioned;

/// The caption of the table of the homogeneity tests.
pub(crate) const HOMOGENEITY: &str = "Test of homogeneity. p: all other parameters are the same in all runs; beside others: those with \
                                      smaller p-values are not";

impl RunComparison {
    /// What differs between the runs, in words; nothing if nothing does.
    pub(crate) fn differences(&self) -> Vec<String> {
        let differ = self.inhomogeneous().next().is_some() || !self.causes().is_empty();
        if differ { summary(self) } else { Vec::new() }
    }

    /// The same for an estimate from all runs together.
    pub(crate) fn differences_of_joint_estimate(&self) -> Vec<String> {
        let mut sentences = self.differences();
        if !sentences.is_empty() {
            sentences.push(
                "The runs were estimated together as if these parameters were the same in all: their values are means, and their 1σ too \
                 small."
                    .into(),
            );
        }
        sentences
    }

    /// The section of a report page.
    pub(crate) fn section(&self) -> Section {
        let table = captioned(HOMOGENEITY, &homogeneity(self));
        Section {
            heading: "The same in all runs?".into(),
            intro: "Each run was estimated by itself.".into(),
            items: vec![Item::Table(table)],
        }
    }
}

/// What varies, and how.
pub(crate) fn summary(comparison: &RunComparison) -> Vec<String> {
    let total = comparison.homogeneity.len();
    let differing: Vec<&str> = comparison.inhomogeneous().map(|one| one.id.as_str()).collect();
    let units: BTreeSet<usize> =
        comparison.history.runs().iter().map(|run| run.conditions.unit).collect();
    let runs = match units.len() {
        1 => "the runs".into(),
        units => format!("the runs of {units} units"),
    };
    let mut sentences = vec![if differing.is_empty() {
        format!(
            "None of {total} parameters differs significantly between {runs} (p > 0.01, family-wise)."
        )
    } else {
        format!(
            "{} of {total} parameters differ between {runs}: {}.",
            differing.len(),
            differing.join(", ")
        )
    }];
    for cause in comparison.causes() {
        sentences.push(format!(
            "{}: {}, {}; p {}.",
            cause.id,
            cause.variation.kind().name(),
            amount(comparison, cause),
            probability(cause.ln_p.exp())
        ));
        if let [_, _, ..] = cause.alternatives[..] {
            let alternatives = cause.alternatives.iter().map(|one| {
                let of = if one.id == cause.id { String::new() } else { format!("{}: ", one.id) };
                format!("{of}{} ({:.0} %)", one.kind.name(), 100.0 * one.probability)
            });
            sentences
                .push(format!("  Credible set: {}.", alternatives.collect::<Vec<_>>().join("; ")));
        }
    }
    let is_named = |id: &str| {
        comparison
            .causes()
            .iter()
            .any(|cause| cause.id == id || cause.alternatives.iter().any(|one| one.id == id))
    };
    let unnamed: Vec<&str> = differing.into_iter().filter(|id| !is_named(id)).collect();
    if !unnamed.is_empty() {
        let but = if units.len() > 1 { " beyond the spread of the units" } else { "" };
        sentences.push(format!("No variation{but} is significant for {}.", unnamed.join(", ")));
    }
    sentences
}

/// The size of a variation, with its unit.
pub(super) fn amount(comparison: &RunComparison, cause: &Cause) -> String {
    let unit = comparison.unit(&cause.id);
    let runs = comparison.history.runs();
    let range = |of: fn(&Conditions) -> Option<f64>| {
        let all = runs.iter().filter_map(|run| of(&run.conditions));
        let [low, high] = all
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        (low, high)
    };
    let with = |(value, sigma): (f64, f64), unit: &str| {
        let (value, sigma) = estimate(value, sigma);
        format!("{value} ± {sigma} {unit}")
    };
    let first = cause.amplitudes.first().copied().unwrap_or_default();
    let per = |size: f64| (first.0 / size, first.1 / size);
    match cause.variation {
        Variation::Drift => {
            let (low, high) = range(|one| one.date);
            let days = high - low;
            format!(
                "{}, {} over {} days",
                with(per(days), &format!("{unit}/day")),
                with(first, unit),
                figure(days, 3)
            )
        }
        Variation::DriftSincePowerOn => {
            let (low, high) = range(|one| one.since_power_on);
            let minutes = (high - low) / 60.0;
            format!(
                "{}, {} over {} min",
                with(per(minutes), &format!("{unit}/min")),
                with(first, unit),
                figure(minutes, 3)
            )
        }
        Variation::WarmUp { time_constant } => format!(
            "{} at power-on, time constant about {} min",
            with(first, unit),
            figure(time_constant / 60.0, 2)
        ),
        Variation::Temperature { degree } => {
            let (low, high) = range(|one| one.temperature);
            let of = coefficients(&cause.amplitudes, high - low);
            let each = of.iter().enumerate().map(|(place, one)| {
                let power = match place {
                    0 => "K".into(),
                    power => format!("K^{}", power + 1),
                };
                with(*one, &format!("{unit}/{power}"))
            });
            let about = if degree > 1 {
                format!(" about {} °C", figure(0.5 * (low + high), 3))
            } else {
                String::new()
            };
            format!("{}{about}", each.collect::<Vec<_>>().join(", "))
        }
        Variation::Hysteresis => {
            format!("{} more while the temperature rises than while it falls", with(first, unit))
        }
        Variation::TurnOn | Variation::Scatter => {
            format!("about {} {unit} (1σ)", figure(cause.scale, 2))
        }
        Variation::Walk => format!("about {} {unit} (1σ) over all runs", figure(cause.scale, 2)),
        Variation::Change { instant, .. } => {
            let when = if runs.iter().all(|run| run.conditions.date.is_some()) {
                format!("about {}", date_text(instant * DAY))
            } else {
                let before = runs.iter().enumerate().filter(|(place, _)| (*place as f64) < instant);
                format!("after run {}", before.count())
            };
            format!("{} {when}", with(first, unit))
        }
        Variation::Unit { unit: which } => format!("unit {} by {}", which + 1, with(first, unit)),
        Variation::Run { run } => format!("{} by {}", comparison.names[run], with(first, unit)),
    }
}

/// The coefficients of a polynomial of the temperature about the middle of its range, by powers of a kelvin, from those of the Legendre
/// polynomials.
fn coefficients(legendre: &[(f64, f64)], range: f64) -> Vec<(f64, f64)> {
    // x runs from -1 to 1 over the range.
    let per = 2.0 / range;
    let at = |place: usize| legendre.get(place).copied().unwrap_or_default();
    let [first, second, third] = [at(0), at(1), at(2)];
    let linear = (0.5 * first.0 - 0.75 * third.0, f64::hypot(0.5 * first.1, 0.75 * third.1));
    let each =
        [(linear, per), (second, per * per), ((1.25 * third.0, 1.25 * third.1), per.powi(3))];
    let scaled = each.map(|((value, sigma), factor)| (factor * value, factor * sigma));
    scaled[..legendre.len().min(3)].to_vec()
}

/// A p-value in a table, from its logarithm.
pub(super) fn p_value(ln_p: f64) -> String {
    probability(ln_p.exp()).trim_start_matches("= ").into()
}

/// The test of homogeneity as a table.
pub(crate) fn homogeneity(comparison: &RunComparison) -> Vec<Vec<String>> {
    let mut rows = vec![
        ["parameter", "smallest", "largest", "mean 1σ", "p", "p beside others", "unit"]
            .map(String::from)
            .to_vec(),
    ];
    for (one, unit) in comparison.homogeneity.iter().zip(&comparison.units) {
        let values: Vec<(f64, f64)> = one.values.iter().flatten().copied().collect();
        let extreme = |pick: fn(f64, f64) -> f64| {
            values.iter().map(|(value, _)| *value).reduce(pick).unwrap_or(f64::NAN)
        };
        let sigma = values.iter().map(|(_, sigma)| sigma).sum::<f64>() / values.len() as f64;
        rows.push(vec![
            one.id.clone(),
            figure(extreme(f64::min), 5),
            figure(extreme(f64::max), 5),
            figure(sigma, 2),
            p_value(one.ln_p),
            p_value(one.ln_p_beside),
            (*unit).into(),
        ]);
    }
    rows
}
