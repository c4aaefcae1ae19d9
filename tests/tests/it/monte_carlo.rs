//! Campaigns: the output does not depend on threads, shards and interruptions.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread::sleep;
use std::time::{Duration, Instant};

use rins_tests::rins;
use tempfile::tempdir;

use crate::support::{list, number, result_in, rins_in};

/// The paper's simulation over 36 s, at two rates and without biases.
pub(crate) fn scenario(folder: &Path) {
    let paper = rins_tests::workspace().join("scenarios/paper/simulation.toml");
    let text = fs::read_to_string(paper).unwrap();
    let short = text.replace("\"360 s\"", "\"36 s\"").replace(
        "bias = [\"0.05 deg/h\", \"0.05 deg/h\", \"0.05 deg/h\"]",
        "bias = [\"0 deg/h\", \"0 deg/h\", \"0 deg/h\"]",
    );
    assert!(short != text && !short.contains("0.05 deg/h\""));
    let grid = "\n[grid]\n\"table.profile.0.rate\" = { from = \"5 deg/s\", to = \"10 deg/s\", steps = 2 }\n";
    fs::write(folder.join("scenario.toml"), short + grid).unwrap();
}

const CAMPAIGN: &str = "monte-carlo scenario.toml --runs 150 --seed 3";

fn bytes(folder: &Path, name: &str) -> Vec<u8> {
    fs::read(folder.join(name)).unwrap()
}

#[test]
fn bytes_are_the_same_for_any_threads_and_shards() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    scenario(folder);
    result_in(folder, &format!("{CAMPAIGN} -o one.parquet --threads 1"));
    result_in(folder, &format!("{CAMPAIGN} -o three.parquet --threads 3"));
    assert!(bytes(folder, "one.parquet") == bytes(folder, "three.parquet"));
    for shard in 1..=2 {
        result_in(folder, &format!("{CAMPAIGN} -o part{shard}.parquet --shard {shard}/2"));
    }
    result_in(folder, "merge part2.parquet part1.parquet -o merged.parquet");
    assert!(bytes(folder, "one.parquet") == bytes(folder, "merged.parquet"));
    let page = fs::read_to_string(folder.join("merged.html")).unwrap();
    assert!(page.contains("Errors over their sigmas"));
    let left: Vec<_> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert!(left.iter().all(|name| !name.to_string_lossy().ends_with(".part")), "{left:?}");
}

#[test]
fn an_interrupted_campaign_is_continued_to_the_same_bytes() {
    // It must run for some seconds before it is killed.
    const LONGER: &str = "monte-carlo scenario.toml --runs 1500 --seed 3";
    let folder = tempdir().unwrap();
    let folder = folder.path();
    scenario(folder);
    result_in(folder, &format!("{LONGER} -o whole.parquet"));

    let mut command = rins();
    command.args(LONGER.split_whitespace()).args(["-o", "cut.parquet", "--threads", "1"]);
    let mut child =
        command.current_dir(folder).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let journal = folder.join("cut.parquet.part");
    let finished = || fs::read_to_string(&journal).is_ok_and(|text| text.contains("\nend "));
    let begun = Instant::now();
    while !finished() && child.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < Duration::from_secs(60), "no chunk of runs is written");
        sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(!folder.join("cut.parquet").exists(), "it was not interrupted");
    let refused = rins_in(folder, &format!("{LONGER} -o cut.parquet"));
    assert_eq!(refused.code, Some(1));
    assert!(refused.err.contains("--resume"), "{}", refused.err);
    let other = "monte-carlo scenario.toml --runs 1500 --seed 4 --resume -o cut.parquet";
    let other = rins_in(folder, other);
    assert_eq!(other.code, Some(1));
    assert!(other.err.contains("another campaign"), "{}", other.err);
    // A line that a crash has truncated does not count.
    let mut text = fs::read_to_string(&journal).unwrap();
    text.push_str("chunk 1 64\n3ff0");
    fs::write(&journal, text).unwrap();
    result_in(folder, &format!("{LONGER} -o cut.parquet --resume"));
    assert!(bytes(folder, "whole.parquet") == bytes(folder, "cut.parquet"));
}

#[test]
fn a_campaign_says_whether_covariances_are_honest() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    scenario(folder);
    let result = result_in(folder, &format!("{CAMPAIGN} -o a.parquet"));
    assert_eq!(result["command"], "monte-carlo");
    let cells = list(&result, "/cells");
    assert_eq!(cells.len(), 2);
    assert_eq!(cells[1]["grid"]["table.profile.0.rate"], "10 deg/s");
    for cell in cells {
        assert_eq!(number(cell, "/runs").to_bits(), 150_f64.to_bits());
        let nees = number(cell, "/nees");
        assert!((2.0..4.0).contains(&nees), "{nees}");
        assert!(number(cell, "/parameters/2/coverage_95") > 0.85);
    }
    // The effect of a misalignment is proportional to the rate: half the rate gives twice the sigma.
    let claimed = |cell: usize| number(&cells[cell], "/parameters/0/sigma_rms");
    assert!((claimed(0) / claimed(1) - 2.0).abs() < 0.1);
}

#[test]
fn a_campaign_of_any_model_says_how_its_posteriors_agree_with_the_truth() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    scenario(folder);
    let campaign = "monte-carlo scenario.toml --runs 3 --seed 3 --model full --noise given";
    let result = result_in(folder, &format!("{campaign} -o a.parquet"));
    assert_eq!((&result["model"], &result["truth"]), (&"full".into(), &"prior".into()));
    for cell in list(&result, "/cells") {
        assert_eq!(list(cell, "/parameters").len(), 27);
        let band = [list(cell, "/rank_band/points"), list(cell, "/rank_band/lower")];
        for parameter in list(cell, "/parameters") {
            assert_eq!(list(parameter, "/posterior/coverage").len(), 3);
            let curve = list(parameter, "/posterior/ecdf_difference");
            assert!(band.iter().all(|edge| edge.len() == curve.len()));
        }
    }
    let page = fs::read_to_string(folder.join("a.html")).unwrap();
    assert!(page.contains("Rank of the true value in its posterior"));
    for (arguments, code, words) in [
        ("--runs 0", 2, "0 is not in 1..=100000000"),
        ("--runs 2 --model half", 2, "expected paper12, full or a model file"),
        ("--runs 2 --model none.toml", 1, "none.toml"),
    ] {
        let refused =
            rins_in(folder, &format!("monte-carlo scenario.toml {arguments} -o x.parquet"));
        assert_eq!(refused.code, Some(code), "{arguments}: {}", refused.err);
        assert!(refused.err.contains(words), "{arguments}: {}", refused.err);
    }
}

#[test]
fn parts_that_do_not_belong_together_are_refused() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    scenario(folder);
    for (seed, shard) in [(3, 1), (4, 2)] {
        let campaign = format!("monte-carlo scenario.toml --runs 70 --seed {seed}");
        result_in(folder, &format!("{campaign} --shard {shard}/2 -o s{seed}.parquet"));
    }
    fs::write(folder.join("text.parquet"), "no Parquet").unwrap();
    for (parts, word) in [
        ("s3.parquet s4.parquet", "not of the campaign"),
        ("s3.parquet", "shard 2 is missing"),
        ("s3.parquet s3.parquet", "given twice"),
        ("text.parquet", "text.parquet"),
        ("none.parquet", "none.parquet"),
    ] {
        let refused = rins_in(folder, &format!("merge {parts} -o whole.parquet"));
        assert_eq!(refused.code, Some(1), "{parts}");
        assert!(refused.err.contains(word), "{parts}: {}", refused.err);
        assert!(!folder.join("whole.parquet").exists());
    }
}

#[test]
fn campaigns_that_no_computer_finishes_are_refused() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    scenario(folder);
    let text = fs::read_to_string(folder.join("scenario.toml")).unwrap();
    let (base, _) = text.split_once("\n[grid]\n").unwrap();
    let grid = "[grid]\n\"site.height\" = { from = \"0 m\", to = \"1000 m\", steps = 1000 }\n";
    fs::write(folder.join("long.toml"), format!("{}\n{grid}", base.replace("36 s", "1 h")))
        .unwrap();
    for (arguments, words) in [
        ("scenario.toml --runs 100000000", "make shards of them, such as --shard 1/2"),
        ("long.toml --runs 100000000 --shard 1/10000", "more than 10000000000 runs"),
        ("long.toml --runs 64", "split the grid into several campaigns"),
    ] {
        let refused = rins_in(folder, &format!("monte-carlo {arguments} -o x.parquet"));
        assert_eq!(refused.code, Some(1), "{arguments}: {}", refused.err);
        assert!(refused.err.contains(words), "{arguments}: {}", refused.err);
        assert!(refused.err.contains("toml"), "{arguments}: {}", refused.err);
    }
}

#[test]
fn a_grid_that_is_none_is_refused_with_its_line() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    scenario(folder);
    let text = fs::read_to_string(folder.join("scenario.toml")).unwrap();
    let (base, _) = text.split_once("\n[grid]\n").unwrap();
    for (grid, words) in [
        ("\"table.profile.3.rate\" = [\"1 deg/s\"]", ["table.profile.3.rate", "no "]),
        ("\"imu.gyro.noise\" = \"0.1 deg/h/sqrt(Hz)\"", ["imu.gyro.noise", "a list"]),
        ("\"imu.gyro.noise\" = [\"0.1 deg/h\"]", ["noise", "deg/h"]),
        ("\"imu.gyro.noize\" = [\"0.1 deg/h\"]", ["noize", "unknown"]),
        (
            "\"site.height\" = { from = \"0 m\", to = \"1 km\", steps = 3 }",
            ["site.height", "a range"],
        ),
    ] {
        fs::write(folder.join("bad.toml"), format!("{base}\n[grid]\n{grid}\n")).unwrap();
        let refused = rins_in(folder, "monte-carlo bad.toml --runs 2 -o x.parquet");
        assert_eq!(refused.code, Some(1), "{grid}: {}", refused.out);
        assert!(refused.err.contains("bad.toml:"), "{grid}: {}", refused.err);
        for word in words {
            assert!(refused.err.contains(word), "{grid}: {}", refused.err);
        }
    }
}
