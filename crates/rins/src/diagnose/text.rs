//! A diagnosis, for a terminal.

use std::fmt::Write as _;

use super::found::{DiagnosisOutcome, Named};
use super::words::{probability, separating_tests, summary};
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
    for test in separating_tests(found) {
        let _ = writeln!(text, "  > {test}");
    }
    text.push_str(
        "  > -o DIR writes the extended model to DIR/model.toml, for rins calibrate --model, and its estimates to \
         DIR/calibration.toml, for rins navigate and rins apply.\n",
    );
    text
}

fn cause_rows(named: &Named) -> Vec<Vec<String>> {
    let cause = &named.cause;
    let settings = settings_in_words(cause.term, &cause.settings, cause.sought);
    let joint = (format!("{:.1}σ", named.sigmas), probability(cause.ln_p));
    let mut rows: Vec<Vec<String>> = cause
        .parameters
        .iter()
        .enumerate()
        .map(|(place, own)| {
            let unit = own.parameter.unit;
            let (size, p) = match (place, cause.parameters.len()) {
                (0, 1) => joint.clone(),
                _ => (String::new(), String::new()),
            };
            let (value, sigma) = estimate(own.value / unit.factor, own.sigma / unit.factor);
            vec![own.parameter.id.clone(), value, sigma, unit.symbol.into(), size, p]
        })
        .collect();
    if rows.len() > 1 {
        // The significance is that of all parameters together.
        let blank = String::new;
        rows.insert(0, vec![cause.term.id.into(), blank(), blank(), blank(), joint.0, joint.1]);
    }
    if let (Some(row), false) = (rows.first_mut(), settings.is_empty()) {
        row[5] = format!("{}  ({settings})", row[5]);
    }
    rows
}
