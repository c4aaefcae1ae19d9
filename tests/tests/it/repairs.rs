//! What of a log was repaired or left out is in every result.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::support::{result_in, rins_in, texts};

/// The demo's run with two samples lost at the rest's end, a line written twice, and a cut end.
fn imperfect() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let demo = rins_tests::workspace().join("crates/rins-cli/data/demo");
    let rig = fs::read_to_string(demo.join("rig.toml")).unwrap();
    let rig = rig.replace("rate = \"25 Hz\"\n", "rate = \"25 Hz\"\ngaps = \"held\"\n");
    fs::write(folder.path().join("rig.toml"), rig).unwrap();
    let log = fs::read_to_string(demo.join("run.csv")).unwrap();
    let mut lines: Vec<&str> = log.lines().collect();
    lines.drain(201..203);
    lines.insert(100, lines[99]);
    fs::write(folder.path().join("run.csv"), lines.join("\n")).unwrap();
    folder
}

fn told(result: &Value) -> Vec<&str> {
    texts(result, "/repairs")
}

#[test]
fn every_result_tells_what_was_repaired_and_left_out() {
    let folder = imperfect();
    let expected = [
        "run.csv: 1 line(s), from 101 on, repeat the line before and are left out",
        "run.csv:9500: the last line has no line end and is left out: it may be cut short",
        "1 gap(s), 0.120 s in all, the longest of 0.120 s after 8.000 s: the mean rate of the sample after each is held over it",
    ];
    for command in ["check", "align", "navigate", "calibrate"] {
        let result = result_in(folder.path(), &format!("{command} rig.toml -o {command}"));
        assert_eq!(told(&result), expected, "{command}");
        let page = read(folder.path(), &format!("{command}/report.html"));
        assert!(page.contains("the last line has no line end"), "{command}");
        let shown = rins_in(folder.path(), &format!("{command} rig.toml"));
        assert!(expected.iter().all(|words| shown.out.contains(words)), "{}", shown.out);
    }
    let converted = result_in(folder.path(), "convert rig.toml -o new.parquet");
    assert_eq!(told(&converted), expected);
    // What was converted has nothing left but the gap, over which it has already been held.
    let again = result_in(folder.path(), "check new.toml");
    let [gap] = told(&again)[..] else { panic!("{again}") };
    assert!(gap.ends_with("the increment after each is taken to cover it"), "{gap}");
}

#[test]
fn a_log_without_faults_has_no_repairs() {
    let folder = tempfile::tempdir().unwrap();
    let demo = result_in(folder.path(), "demo -o demo");
    assert_eq!(demo.get("repairs"), None, "the demo reads no log of the user's");
    assert!(told(&result_in(folder.path(), "check demo/rig.toml")).is_empty());
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}
