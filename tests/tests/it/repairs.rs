//! Repairs and omissions while reading a log are in every result.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::support::{number, object, parameter, result_in, rins_in, texts};

/// The demo's run with two samples lost at the end of the static interval, a repeated line, and a truncated end.
fn imperfect() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let demo = rins_tests::workspace().join("crates/rins/data/demo");
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
    // In a converted log only the gap remains, over which the rate has already been held.
    let again = result_in(folder.path(), "check new.toml");
    let [gap] = told(&again)[..] else { panic!("{again}") };
    assert!(gap.ends_with("the increment after each is taken to cover it"), "{gap}");
}

#[test]
fn a_log_without_faults_has_no_repairs() {
    let folder = tempfile::tempdir().unwrap();
    let demo = result_in(folder.path(), "demo -o demo");
    assert!(told(&demo).is_empty());
    assert!(told(&result_in(folder.path(), "check demo/rig.toml")).is_empty());
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

/// Repeated samples are removed for the paper's model too. Its filter has no state for the error due to their loss: if that is
/// significant the innovations show it, and the result always states it.
#[test]
fn the_paper_s_model_takes_out_repeated_samples_and_is_not_wrong_in_silence() {
    let mut close = 0;
    for draw in 0..20_u32 {
        let folder = tempfile::tempdir().unwrap();
        let (rate, length) = ([8, 15, 25, 40][draw as usize % 4], [1, 2, 5, 10][draw as usize / 5]);
        let share = 0.002 * f64::from(1 + draw % 5);
        let scenario = format!(
            r#"[site]
latitude = "45 deg"
longitude = "0 deg"
height = "0 m"
[log]
rate = "50 Hz"
table_angle = {{ noise = "1 arcsec" }}
[table]
acceleration = "20 deg/s^2"
profile = [
    {{ rate = "0 deg/s", duration = "20 s" }},
    {{ rate = "{rate} deg/s", duration = "60 s" }},
    {{ rate = "-{rate} deg/s", duration = "60 s" }},
]
[attitude]
roll = "30 deg"
pitch = "0 deg"
yaw = "30 deg"
sigma = "0.1 deg"
[imu.gyro]
noise = "0.05 deg/h/sqrt(Hz)"
bias_sigma = "0.1 deg/h"
scale_sigma = "500 ppm"
misalignment_sigma = "120 arcsec"
[imu.accel]
noise = "30 ug/sqrt(Hz)"
bias_sigma = "200 ug"
scale_sigma = "300 ppm"
misalignment_sigma = "60 arcsec"
[truth]
seed = {draw}
gyro = {{ bias = ["0 deg/h", "0 deg/h", "0 deg/h"], scale = ["0 ppm", "0 ppm", "300 ppm"], misalignment = {{ xz = "60 arcsec", yz = "-80 arcsec" }} }}
effects = [{{ id = "stuck_samples", share = {share}, length = {length} }}]
"#
        );
        fs::write(folder.path().join("scenario.toml"), scenario).unwrap();
        result_in(folder.path(), "simulate scenario.toml -o run");
        let finished = rins_in(folder.path(), "calibrate run/rig.toml --model paper12 --json");
        if finished.out.is_empty() {
            assert_eq!(finished.code, Some(1), "{}", finished.err);
            continue;
        }
        let result = object(&finished);
        let told = texts(&result, "/notes").iter().any(|note| note.contains("treated as lost"));
        assert!(told, "draw {draw}: {:?}", texts(&result, "/notes"));
        let truth =
            [("xz", 60.0), ("yz", -80.0)].map(|(axes, t)| (format!("gyro.misalignment.{axes}"), t));
        let off =
            truth.into_iter().chain([("gyro.scale.z".to_owned(), 300.0)]).map(|(id, truth)| {
                let found = parameter(&result, &id);
                ((number(found, "/value") - truth) / number(found, "/sigma")).abs()
            });
        let worst = off.fold(0.0, f64::max);
        let verdict = &result["consistency"]["verdict"];
        assert!(worst < 4.0 || *verdict == "misfit", "draw {draw}: {worst} sigma, {verdict}");
        close += u32::from(worst < 4.0);
    }
    assert!(close >= 10, "{close} of 20 within four sigma");
}
