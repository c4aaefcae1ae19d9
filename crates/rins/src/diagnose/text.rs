//! A diagnosis, for a terminal.

use std::fmt::Write as _;

use rins_estimation::Estimate;

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

/// The rows of a cause; the significance is that of all its parameters together, in a row of its own if there are several.
fn cause_rows(named: &Named) -> Vec<Vec<String>> {
    let cause = &named.cause;
    let blank = String::new;
    let of_parameter = |own: &Estimate| {
        let unit = own.parameter.unit;
        let (value, sigma) = estimate(own.value / unit.factor, own.sigma / unit.factor);
        let run = own.run.map_or_else(String::new, |run| format!(" (run {})", run + 1));
        vec![
            format!("{}{run}", own.parameter.id),
            value,
            sigma,
            unit.symbol.into(),
            blank(),
            blank(),
        ]
    };
    let mut rows: Vec<Vec<String>> = cause.parameters.iter().map(of_parameter).collect();
    if rows.len() > 1 {
        let mut joint = vec![blank(); 6];
        joint[0] = cause.term.id.into();
        rows.insert(0, joint);
    }
    if let Some(row) = rows.first_mut() {
        row[4] = format!("{:.1}σ", named.sigmas);
        let settings = settings_in_words(cause.term, &cause.settings, cause.sought);
        let p = probability(cause.ln_p);
        row[5] = if settings.is_empty() { p } else { format!("{p}  ({settings})") };
    }
    rows
}
