//! The keys of time in a draft: `rate`, `time` and `gaps`.

use super::pace::{Pace, PaceUnit};
use super::page::{Page, list, short, text};
use super::sample::Sample;

/// The relative difference up to which a rate counts as an integer.
const NEAR_WHOLE: f64 = 2e-4;

/// The jitter up to which a rate is stated, in intervals.
const EVEN: f64 = 0.01;

const RATE: &str = r#""? Hz""#;

pub(super) fn write(page: &mut Page, sample: &Sample, pace: Option<&Pace>, has_table: bool) {
    let Some(pace) = pace else {
        page.remark("No column increases like a time or a sample counter.");
        page.leave("rate", RATE, "the sampling rate, as no column is a time");
        page.optional("time.column", r#""?""#, "if there is a time column, with time.unit");
        return;
    };
    write_rate(page, pace);
    if let Some(split) = pace.split {
        let columns = [pace.column, split.column].map(|column| sample.name(column));
        page.guess("time.columns", &list(columns.iter().map(String::as_str)), split.why);
        page.guess("time.unit", &list(split.units), "their sum then increases steadily");
        return write_stamp(page, has_table);
    }
    let column = text(&sample.name(pace.column));
    match &pace.column_guess {
        None => page.known("time.column", &column),
        Some(why) => page.guess("time.column", &column, why),
    }
    match &pace.unit {
        PaceUnit::Stated(unit) => page.known("time.unit", &text(unit)),
        PaceUnit::Guess(unit, why) => page.guess("time.unit", &text(unit), why),
        PaceUnit::Unknown => {
            let expected = r#""s", "ms", "us" or "ns", or "sample" for a counter, with a rate"#;
            page.leave("time.unit", r#""?""#, expected);
        }
    }
    write_stamp(page, has_table);
}

/// The key of the instant that a time stamp refers to.
fn write_stamp(page: &mut Page, has_table: bool) {
    if has_table {
        let why = r#"the most common of "start", "middle", "end"; it affects the comparison with the table"#;
        page.guess("time.stamp", r#""end""#, why);
    }
}

/// The key `rate`, and remarks on the time steps.
pub(super) fn write_rate(page: &mut Page, pace: &Pace) {
    measured(page, pace);
    match pace.interval().map(|interval| 1.0 / interval) {
        Some(rate) if pace.jitter < EVEN && (rate / rate.round() - 1.0).abs() < NEAR_WHOLE => {
            let value = text(&format!("{} Hz", rate.round()));
            page.guess("rate", &value, &format!("the nominal rate, as {rate:.3} Hz was measured"));
        }
        Some(_) => page.optional("rate", RATE, "the nominal rate, to be checked against the time"),
        None if pace.counts_samples() => {
            page.leave("rate", RATE, "the sampling rate, as the log counts samples, not time");
        }
        None => {}
    }
}

/// Writes remarks on the time steps.
fn measured(page: &mut Page, pace: &Pace) {
    let jitter = pace.jitter * 100.0;
    match pace.interval() {
        Some(interval) => page.remark(&format!(
            "Measured: {} Hz, median step {} ms, jitter {:.4} ms rms ({jitter:.1} % of a step).",
            short(1.0 / interval),
            short(interval * 1e3),
            pace.jitter * interval * 1e3
        )),
        None => page.remark(&format!(
            "Measured: median step {}, jitter {jitter:.1} % of a step.",
            short(pace.step)
        )),
    }
    if pace.gaps > 0 {
        page.remark(&format!("Gaps, steps of more than 1.5 medians: {} of those read.", pace.gaps));
    }
    if pace.halts > 0 {
        let halts = pace.halts;
        page.remark(&format!(
            "Steps that are not positive: {halts}. A row written twice is read once; any other is an error."
        ));
    }
}

/// The key `gaps`: the meaning of the increment after a gap.
pub(super) fn gaps(page: &mut Page, pace: Option<&Pace>) {
    if pace.is_some_and(|pace| pace.gaps > 0) {
        let expected = r#""accumulated" if the increment after a gap covers it, "held" if not"#;
        page.leave("gaps", r#""?""#, expected);
    }
}
