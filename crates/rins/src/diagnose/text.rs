//! A diagnosis, for a terminal.

use std::fmt::Write as _;

use super::found::{DiagnosisOutcome, Named};
use super::words::{next_steps, probability, summary};
use crate::settings::settings_in_words;
use crate::table::aligned;
use rins_report::number::estimate;

/// The summary for a terminal: what was found in plain words, then the figures.
pub(super) fn diagnosis_text(found: &DiagnosisOutcome) -> String {
    let mut text = format!("{}\n", found.title());
    for sentence in summary(found) {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {sentence}");
    }
    if found.causes.is_empty() {
        return text;
    }
    let mut rows = vec![
        ["parameter", "value", "sigma", "unit", "significance", "p"].map(String::from).to_vec(),
    ];
    for named in &found.causes {
        rows.extend(cause_rows(named));
    }
    let _ = write!(text, "\n{}", aligned(&rows));
    for step in next_steps(found) {
        let _ = writeln!(text, "  > {step}");
    }
    text
}

fn cause_rows(named: &Named) -> Vec<Vec<String>> {
    let cause = &named.cause;
    let settings = settings_in_words(cause.term, &cause.settings, cause.sought);
    let mut rows: Vec<Vec<String>> = cause
        .parameters
        .iter()
        .enumerate()
        .map(|(place, own)| {
            let unit = own.parameter.unit;
            let (size, p) = match place {
                0 => (format!("{:.1}σ", named.sigmas), probability(cause.ln_p)),
                _ => (String::new(), String::new()),
            };
            let (value, sigma) = estimate(own.value / unit.factor, own.sigma / unit.factor);
            vec![own.parameter.id.clone(), value, sigma, unit.symbol.into(), size, p]
        })
        .collect();
    if let (Some(row), false) = (rows.first_mut(), settings.is_empty()) {
        row[5] = format!("{}  ({settings})", row[5]);
    }
    rows
}
