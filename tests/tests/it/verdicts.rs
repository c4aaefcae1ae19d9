//! `rins check` has a verdict on each possible gross error of a log.

use std::fs;
use std::path::Path;

use rins_tests::outside_data;
use serde_json::Value;
use tempfile::TempDir;

use crate::support::{Finished, list, object, result_in, rins_in};

const ITEMS: [&str; 19] = [
    "rate and jitter",
    "gaps",
    "duplicates",
    "time order",
    "finite",
    "stuck",
    "saturated",
    "spikes",
    "quantization",
    "units",
    "rate or increment",
    "signs and axes",
    "table's motion",
    "clock ratio",
    "latency",
    "temperature",
    "static intervals",
    "turns",
    "what it can show",
];

/// The word and the sentence of the verdict on one item.
fn verdict<'v>(check: &'v Value, item: &str) -> (&'v str, &'v str) {
    let found = list(check, "/verdicts").iter().find(|verdict| verdict["check"] == item);
    let found = found.unwrap_or_else(|| panic!("no verdict on {item} in {check:#}"));
    (found["verdict"].as_str().unwrap(), found["finding"].as_str().unwrap())
}

/// The demo's run, with replacements in its rig file and in its log.
fn run(rig: [&str; 2], log: impl Fn(Vec<String>) -> Vec<String>) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let demo = rins_tests::workspace().join("crates/rins/data/demo");
    let text = fs::read_to_string(demo.join("rig.toml")).unwrap();
    assert!(text.contains(rig[0]), "{text}");
    fs::write(folder.path().join("rig.toml"), text.replacen(rig[0], rig[1], 1)).unwrap();
    let lines = fs::read_to_string(demo.join("run.csv")).unwrap();
    let lines = log(lines.lines().map(str::to_owned).collect());
    fs::write(folder.path().join("run.csv"), lines.join("\n") + "\n").unwrap();
    folder
}

const SAME: [&str; 2] = ["", ""];

#[test]
fn a_good_run_has_nothing_odd() {
    let folder = run(SAME, |lines| lines);
    let check = result_in(folder.path(), "check rig.toml -o out");
    let items: Vec<&str> = list(&check, "/verdicts")
        .iter()
        .map(|verdict| verdict["check"].as_str().unwrap())
        .collect();
    assert_eq!(items, ITEMS);
    for item in ITEMS {
        let (word, says) = verdict(&check, item);
        assert!(["good", "fact"].contains(&word) && !says.is_empty(), "{item}: {word}: {says}");
    }
    let (_, shows) = verdict(&check, "what it can show");
    assert!(
        shows.contains("rins align: tilt and azimuth")
            && shows.contains("the rates 20.01, -20.00 deg/s")
    );
    let page = fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    assert!(
        ITEMS.iter().all(|item| page.contains(&item.replace('\'', "&#39;")) || page.contains(item))
    );
}

/// A change of the log, the item that shows it, the verdict, and its text.
type Row = (&'static str, fn(Vec<String>) -> Vec<String>, &'static str, &'static str);

fn field(line: &str, place: usize, change: impl Fn(f64) -> f64) -> String {
    let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
    fields[place] = format!("{:e}", change(fields[place].parse().unwrap()));
    fields.join(",")
}

fn each(lines: &[String], change: impl Fn(usize, &str) -> String) -> Vec<String> {
    lines.iter().enumerate().map(|(k, l)| if k == 0 { l.clone() } else { change(k, l) }).collect()
}

const FAULTS: [Row; 7] = [
    (
        "duplicates",
        |mut lines| {
            lines.insert(50, lines[49].clone());
            lines
        },
        "odd",
        "1 repeated line(s)",
    ),
    (
        "rate and jitter",
        |lines| each(&lines, |k, line| field(line, 0, |t| t + 0.004 * (k as f64 * 1.7).sin())),
        "odd",
        "% of an interval",
    ),
    (
        "spikes",
        |lines| {
            each(&lines, |k, line| if k == 300 { field(line, 4, |a| a + 5.0) } else { line.into() })
        },
        "bad",
        "accel.x has 1 spike(s)",
    ),
    (
        "stuck",
        |lines| each(&lines, |_, line| field(line, 4, |_| 0.2)),
        "bad",
        "accel.x repeats one reading throughout",
    ),
    (
        "quantization",
        |lines| each(&lines, |_, line| field(line, 4, |a| (a / 1e-3).round() * 1e-3)),
        "fact",
        "accel.x 1.000 mm/s",
    ),
    (
        "units",
        |lines| each(&lines, |_, line| field(line, 3, f64::to_degrees)),
        "bad",
        "readings in deg were declared as rad",
    ),
    (
        "signs and axes",
        |lines| each(&lines, |_, line| field(line, 5, |a| -a)),
        "bad",
        "accel.y had the wrong sign",
    ),
];

#[test]
fn each_fault_shows_where_it_belongs() {
    for (item, spoil, word, words) in FAULTS {
        let folder = run(SAME, spoil);
        let check = object(&rins_in(folder.path(), "check rig.toml --json"));
        let (found, says) = verdict(&check, item);
        assert_eq!(found, word, "{item}: {says}");
        assert!(says.contains(words), "{item}: {says}");
        assert_conclusion(folder.path(), item, word);
        if word == "bad" {
            for command in ["align", "calibrate", "diagnose", "navigate"] {
                let refused = rins_in(folder.path(), &format!("{command} rig.toml"));
                assert_eq!(refused.code, Some(1), "{item}: {command}: {}", refused.out);
                assert!(refused.out.is_empty() && !refused.err.is_empty(), "{item}: {command}");
            }
        }
    }
}

/// Asserts that the last line of a check names the item with its word, and that the exit code agrees.
fn assert_conclusion(folder: &Path, item: &str, word: &str) {
    let Finished { code, out, .. } = rins_in(folder, "check rig.toml");
    let last = out.trim_end().lines().last().unwrap();
    let named = last.contains(item) && last.contains(&format!("{word}: "));
    assert!(named || word == "fact", "{item}: {last}");
    assert_eq!(last.contains("bad: "), code == Some(1), "{item}: {last}");
}

/// The rig file states a latency of ten seconds for a table without latency.
#[test]
fn last_line_follows_from_the_verdicts() {
    let folder =
        run(["unit = \"rad\", noise", "unit = \"rad\", latency = \"10 s\", noise"], |lines| lines);
    assert_conclusion(folder.path(), "latency", "odd");
    let good = rins_in(run(SAME, |lines| lines).path(), "check rig.toml");
    assert_eq!(
        (good.code, good.out.trim_end().lines().last()),
        (Some(0), Some("  no anomaly found"))
    );
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn a_late_table_is_told_by_how_much() {
    let run = outside_data("synthetic/encoder_latency_reversal");
    let check = result_in(Path::new(&run), "check rig.toml");
    let (word, says) = verdict(&check, "latency");
    assert_eq!(word, "odd", "{says}");
    let late = says
        .split_once("the latency of the table's angle is ")
        .and_then(|(_, rest)| rest.split_once(" ms"));
    let late: f64 = late.unwrap().0.parse().unwrap();
    // The latency in that run is 60 microseconds.
    assert!((late - 0.060).abs() < 0.003, "{says}");
    let clean = outside_data("synthetic/clean_multirate");
    assert_eq!(verdict(&result_in(Path::new(&clean), "check rig.toml"), "latency").0, "good");
}
