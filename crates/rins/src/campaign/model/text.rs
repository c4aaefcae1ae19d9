//! A campaign of a model as text.

use std::fmt::Write as _;

use rins_campaign::{PosteriorStatistics, QuantityStatistics};
use rins_io::Heading;
use rins_report::number::{estimate, figure};

use super::result::{Verdicts, in_words};
use super::scored::Scored;
use crate::campaign::outcome::label;

/// How the campaign was made, in one sentence.
pub(super) fn setting(heading: &Heading) -> String {
    let Some(model) = &heading.identity.model else { return String::new() };
    let truth = match model.truth.as_str() {
        "prior" => "true values drawn from the prior in each run",
        _ => "true values of the scenario",
    };
    let noise = match model.noise.as_str() {
        "likely" => "noise parameters estimated",
        _ => "noise parameters of the data sheet",
    };
    format!("model {}, {} parameters; {truth}; {noise}", model.name, model.parameters)
}

/// The verdict on the NEES of a scenario, in words.
pub(super) fn size(statistics: &PosteriorStatistics) -> &'static str {
    if statistics.is_consistent() {
        "consistent with their covariances"
    } else if statistics.nees > statistics.nees_bounds[1] {
        "larger than their covariances"
    } else {
        "smaller than their covariances"
    }
}

/// The verdict on the ranks of a scenario, in a sentence.
pub(super) fn ranks(verdicts: &Verdicts) -> String {
    match verdicts.failed() {
        0 => format!(
            "the ranks of all {} tested parameters and combinations are uniform (family-wise level 1 %)",
            verdicts.tested
        ),
        failed => format!(
            "the ranks of {failed} of {} tested parameters and combinations are not uniform (family-wise level 1 %)",
            verdicts.tested
        ),
    }
}

/// A p-value with two digits.
pub(super) fn p_value(value: f64) -> String {
    if value < 1e-3 { format!("{value:.0e}") } else { figure(value, 2) }
}

pub(super) fn text(heading: &Heading, scored: &[Scored<'_>], title: &str) -> String {
    let mut text = format!("{title}\n  {}\n", setting(heading));
    for cell in scored {
        let name = label(&heading.keys, cell.values);
        let Some((statistics, verdicts)) = &cell.statistics else {
            let _ = writeln!(
                text,
                "\n  {name}: {} runs, {} failed; too few for statistics",
                cell.runs, cell.failed
            );
            if let Some(failure) = &cell.failure {
                let _ = writeln!(text, "    first failure: {failure}");
            }
            continue;
        };
        let [least, most] = statistics.nees_bounds;
        let _ = writeln!(
            text,
            "\n  {name}: {} runs with estimates, {} failed, {} not converged; errors are {}\n    \
             NEES {:.3}, expected {:.3} (consistent from {least:.3} to {most:.3}), NIS {:.4} of 1\n    \
             {}",
            statistics.runs,
            cell.failed,
            cell.not_converged,
            size(statistics),
            statistics.nees,
            statistics.nees_dof,
            statistics.nis_ratio,
            ranks(verdicts)
        );
        if let Some(failure) = &cell.failure {
            let _ = writeln!(text, "    first failure: {failure}");
        }
        let _ = writeln!(
            text,
            "    {:22} {:26} {:23} {:21} {:>8}",
            "parameter", "bias (1σ)", "RMS error/σ [95 %]", "coverage 68/95/99.7 %", "p ranks"
        );
        let rows = cell.parameters.iter().zip(&statistics.parameters).enumerate();
        for (place, (parameter, quantity)) in rows {
            let (bias, sigma) = estimate(quantity.mean_error, quantity.mean_error_sigma);
            let bias = format!("{bias} ± {sigma} {}", parameter.unit);
            let observability = verdicts.observability[place].words();
            let verdict = match verdicts.parameters[place] {
                Some(false) => ", ranks not uniform",
                _ => "",
            };
            let _ = writeln!(
                text,
                "    {:22} {bias:26} {} {observability}{verdict}",
                parameter.id,
                figures(quantity)
            );
        }
        let _ = writeln!(text, "    well-determined combinations, in units of the prior sigmas");
        let ids = cell.ids();
        for (place, quantity) in statistics.of_combinations.iter().enumerate() {
            let verdict = if verdicts.combinations[place] { "" } else { ", ranks not uniform" };
            let _ = writeln!(
                text,
                "    {:<22} {:26} {} {}{verdict}",
                place + 1,
                format!("σ {}", figure(quantity.sigma_rms, 3)),
                figures(quantity),
                in_words(&statistics.combinations, place, &ids)
            );
        }
    }
    text
}

/// The ratio, the coverage and the p-value of a quantity.
fn figures(quantity: &QuantityStatistics) -> String {
    let [low, high] = quantity.rms_ratio_interval_95;
    let covered = quantity.coverage.map(|one| format!("{:.1}", 100.0 * one.fraction));
    format!(
        "{:23} {:21} {:>8}",
        format!("{:.3} [{low:.3}, {high:.3}]", quantity.rms_ratio),
        covered.join(" / "),
        p_value(quantity.p_value)
    )
}
