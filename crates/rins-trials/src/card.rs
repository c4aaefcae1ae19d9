//! The score card: a page of the book, from a journal.

use std::fmt::Write as _;

use crate::breakdown::{
    by_effect, by_level, by_schedule, confusion, detection, faint, outside, reliability,
};
use crate::draw::Kind;
use crate::hide::Hidden;
use crate::journal::Record;
use crate::laboratory::{Level, Schedule};
use crate::score::{in_set, is_plain, meant, ones};
use crate::statistics::Share;

/// The page for these records.
pub fn card(records: &[Record]) -> String {
    let mut page = String::from(HEAD);
    let (timed, records): (Vec<&Record>, Vec<&Record>) =
        records.iter().partition(|record| record.timed);
    let answered: Vec<&Record> =
        records.iter().copied().filter(|record| record.answered()).collect();
    let failures = Share::count(records.iter().map(|record| !record.answered()));
    let _ = writeln!(
        page,
        "{} trials were run; {} ended without an answer. Brackets give counts and the bounds of Clopper and Pearson at 95 %.\n",
        records.len(),
        failures.hits
    );
    table(&mut page, &targets(&answered, &timed));
    page.push_str("\n## By schedule\n\n");
    by_schedule(&mut page, &answered);
    page.push_str("\n## By noise and table\n\n");
    by_level(&mut page, &answered);
    page.push_str("\n## Detection\n\n");
    detection(&mut page, &answered);
    page.push('\n');
    faint(&mut page, &answered);
    page.push_str("\n## Stated probabilities\n\n");
    reliability(&mut page, &answered);
    page.push_str("\n## By effect\n\n");
    by_effect(&mut page, &answered);
    page.push_str("\n## Confusion matrix\n\n");
    confusion(&mut page, &answered);
    page.push_str("\n## Outside the catalogue\n\n");
    outside(&mut page, &answered);
    page
}

const HEAD: &str = "# Blind trials

Blind trials test the diagnosis with runs from an independent simulator. `rins-blind` uses no other crate of this workspace. It
simulates an oversampled motion: a table with a servo, cogging and friction, attitudes as quaternions, rates and forces by
differences, sensor errors on every short step. `rins diagnose` gets the log and the rig file. The truth is kept apart.
`cargo xtask blind` runs trials, and `cargo xtask blind --card` writes this page from their results.

Each trial draws:

- a site and the tilt of the spin axis (15 to 35 deg);
- an IMU: gyro noise 0.005 to 0.05 deg/h/√Hz, constant errors over decades;
- an encoder and a temperature;
- a schedule of 360 to 540 s at 50 or 100 Hz;
- the unmodeled error: none (35 %), one effect of the catalogue (40 %), two effects (10 %), or an effect outside the catalogue (15 %).

The size of an effect is a multiple of its Cramér-Rao bound, in a random direction among those that the run shows. All sigmas
below are multiples of this bound.

";

/// A figure, its target, and its value with bounds.
type Row = (&'static str, &'static str, String);

fn table(page: &mut String, rows: &[Row]) {
    page.push_str("| figure | target | found |\n| --- | --- | --- |\n");
    for (figure, target, found) in rows {
        let _ = writeln!(page, "| {figure} | {target} | {found} |");
    }
}

fn targets(records: &[&Record], timed: &[&Record]) -> Vec<Row> {
    let clean: Vec<&&Record> =
        records.iter().filter(|r| r.kind == Kind::Nothing && is_plain(r)).collect();
    let on = |level: Level| {
        let of_level = clean.iter().filter(|record| record.level == level);
        Share::count(of_level.map(|record| record.false_names().next().is_some())).text()
    };
    let ones = ones(records);
    let strong = |low, high| ones.iter().filter(meant(low, high));
    let sets = |low, high| Share::count(strong(low, high).map(in_set)).text();
    let seen = |low, high| Share::count(strong(low, high).map(|(r, _)| r.detected())).text();
    let firsts = ones.iter().filter(|(r, h)| h.is_separable() && r.first().is_some());
    let right = |(r, h): &(&Record, &Hidden)| r.first().is_some_and(|named| named.effect == h.id);
    let covered = ones.iter().filter(|(_, h)| h.strength >= 6.0).flat_map(|(r, _)| r.covered());
    let both = records.iter().filter(|r| r.kind == Kind::Two && is_plain(r));
    let beyond: Vec<&&Record> = records
        .iter()
        .filter(|r| is_plain(r))
        .filter(|r| r.outside.as_ref().is_some_and(|o| o.remainder.is_some_and(|r| r >= 15.0)))
        .collect();
    let flagged = |r: &&&Record| !r.answer.unexplained.is_empty();
    let misnamed = |r: &&&Record| !r.answer.causes.is_empty() && r.answer.unexplained.is_empty();
    let clean_after = |(r, h): &(&Record, &Hidden)| {
        r.set_with(&h.id).is_some() && r.answer.causes.len() == 1 && r.answer.unexplained.is_empty()
    };
    let times = |of: &[&Record]| seconds(of.iter().map(|r| r.answer.seconds).collect());
    vec![
        ("effect reported without unmodeled error, white noise", "≤ 1 %", on(Level::White)),
        (
            "effect reported without unmodeled error, with bias instability of 0.005 deg/h",
            "≤ 1 %",
            on(Level::Flicker),
        ),
        (
            "residual structure reported without unmodeled error",
            "≤ 1 %",
            Share::count(clean.iter().map(|r| !r.answer.unexplained.is_empty())).text(),
        ),
        ("detected at 6.5 σ", "≥ 95 %", seen(6.5, 6.5)),
        ("detected at 8 σ", "", seen(8.0, 8.0)),
        ("detected at 9 σ and above", "100 %", seen(9.0, 200.0)),
        ("truth in the credible set at 8 σ", "≥ 98 %", sets(8.0, 8.0)),
        ("truth in the credible set at 12 σ and above", "≥ 99.5 %", sets(12.0, 200.0)),
        (
            "most probable effect correct where the schedule separates, s/κ ≥ 5",
            "≥ 95 %",
            Share::count(firsts.map(right)).text(),
        ),
        ("mean size of the credible set at 12 σ, three rates", "≤ 2", mean_size(&ones, 12.0)),
        ("mean size of the credible set at 100 σ, three rates", "≤ 1.5", mean_size(&ones, 100.0)),
        (
            "coverage of the 95 % interval of the amplitude, s ≥ 6",
            "93 – 97 %",
            Share::count(covered).text(),
        ),
        (
            "no other effect and no residual structure, 8 σ and above",
            "≥ 95 %",
            Share::count(strong(8.0, 200.0).map(clean_after)).text(),
        ),
        ("held-out gain where one effect of 6 σ and above was reported", "improved", gains(&ones)),
        ("held-out gain over the gain with the true model, s ≥ 6", "≥ 0.9", of_the_true(&ones)),
        (
            "held-out rise of the log score without unmodeled error, mean",
            "≥ -0.5 nat",
            mean_rise(&clean),
        ),
        (
            "outside the catalogue, remainder ≥ 15 σ: residual structure reported",
            "≥ 95 %",
            Share::count(beyond.iter().map(flagged)).text(),
        ),
        (
            "outside the catalogue, remainder ≥ 15 σ: effect reported, no residual structure",
            "≤ 2 %",
            Share::count(beyond.iter().map(misnamed)).text(),
        ),
        (
            "two effects of 10 σ, both in credible sets",
            "≥ 90 %",
            Share::count(both.map(|r| r.hidden.iter().all(|h| r.set_with(&h.id).is_some()))).text(),
        ),
        (
            "time for 720 s at 100 Hz, two threads: median, 95th percentile, maximum",
            "< 10 s",
            times(timed),
        ),
        ("time of one diagnosis, one thread: median, 95th percentile, maximum", "", times(records)),
    ]
}

fn mean_size(ones: &[(&Record, &Hidden)], at: f64) -> String {
    let sizes: Vec<f64> = ones
        .iter()
        .filter(meant(at, at))
        .filter(|(record, _)| record.schedule == Schedule::ThreeRates)
        .filter_map(|(record, hidden)| Some(record.set_with(&hidden.id)?.set().count() as f64))
        .collect();
    if sizes.is_empty() {
        return "no such trial".into();
    }
    format!("{:.2} ({} sets)", sizes.iter().sum::<f64>() / sizes.len() as f64, sizes.len())
}

/// Rise of the log score of the held-out data \[nats\]; zero if no effect was reported.
fn rise(record: &Record) -> Option<f64> {
    if record.answer.causes.is_empty() {
        Some(0.0)
    } else {
        record.answer.gain["log_score_rise"].as_f64()
    }
}

fn mean_rise(clean: &[&&Record]) -> String {
    let rises: Vec<f64> = clean.iter().filter_map(|record| rise(record)).collect();
    if rises.is_empty() {
        return "no such trial".into();
    }
    format!("{:.2} nat ({} runs)", rises.iter().sum::<f64>() / rises.len() as f64, rises.len())
}

fn gains(ones: &[(&Record, &Hidden)]) -> String {
    let measured = ones.iter().filter(|(record, hidden)| {
        hidden.strength >= 6.0 && record.answer.gain["log_score_rise"].is_f64()
    });
    Share::count(measured.map(|(record, _)| record.answer.gain["verdict"] == "improved")).text()
}

/// Ratio of the gain with the reported effects to the gain with the true effects, as a ratio of sums over all trials with both:
/// for one trial it is the ratio of two small differences.
fn of_the_true(ones: &[(&Record, &Hidden)]) -> String {
    let measured: Vec<(f64, f64)> = ones
        .iter()
        .filter_map(|(record, _)| Some((rise(record)?, record.answer.true_gain?)))
        .collect();
    if measured.is_empty() {
        return "no such trial".into();
    }
    let (named, real) = measured.iter().fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
    format!("{:.3} ({} runs)", named / real, measured.len())
}

fn seconds(mut times: Vec<f64>) -> String {
    times.sort_by(f64::total_cmp);
    let Some(&longest) = times.last() else { return "none".into() };
    format!("{:.1}, {:.1}, {longest:.1} s", times[times.len() / 2], times[times.len() * 19 / 20])
}
