//! The basis of every result: the program, its inputs, the item and its measurement, repairs and assumptions.

use std::fs;
use std::path::Path;

use rins_testing::{data_sheets, site};
use serde_json::Value;

use crate::support::{list, numbers, result_in, rins_in, texts};

const SCENARIO: &str = concat!(
    site!(),
    data_sheets!(),
    r#"[log]
rate = "20 Hz"
table_angle = { noise = "1 arcsec" }
[table]
acceleration = "10 deg/s^2"
profile = [{ rate = "0 deg/s", duration = "20 s" }, { rate = "20 deg/s", duration = "40 s" }]
[attitude]
roll = "30 deg"
pitch = "20 deg"
yaw = "40 deg"
sigma = "0.05 deg"
[run]
maker = "Example Gyros"
serial = "FOG-0012"
started = "2026-11-26T10:00:00Z"
[lab]
name = "Inertial laboratory"
[truth]
seed = 3
temperature = { start = "21 degC", ramp = "60 K/h" }
"#
);

/// A simulated run with its calibration.
fn calibrated(folder: &Path) {
    fs::write(folder.join("scenario.toml"), SCENARIO).unwrap();
    result_in(folder, "simulate scenario.toml -o run");
    result_in(folder, "calibrate run/rig.toml --model full -o cal");
}

/// The paths and the digests of the inputs of a result.
fn inputs(result: &Value) -> Vec<(String, String)> {
    let of = |input: &Value, key: &str| input[key].as_str().unwrap().to_owned();
    let all = list(result, "/provenance/inputs").iter();
    all.map(|input| (of(input, "path"), of(input, "sha256"))).collect()
}

#[test]
fn every_result_has_its_basis() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    calibrated(folder);
    let log = ["run/rig.toml", "run/run.csv"];
    let calibration = "cal/calibration.toml";
    let with = |more: &str| [log[0], log[1], more].map(String::from).to_vec();
    let only = |path: &str| vec![path.to_owned()];
    let log = || log.map(String::from).to_vec();
    for (command, expected) in [
        ("check run/rig.toml".to_owned(), log()),
        ("align run/rig.toml".to_owned(), log()),
        ("allan run/rig.toml".to_owned(), log()),
        ("calibrate run/rig.toml --model paper12".to_owned(), log()),
        ("calibrate run/rig.toml --model cal/model.toml".to_owned(), with("cal/model.toml")),
        ("diagnose run/rig.toml --hypothesis h.toml".to_owned(), with("h.toml")),
        (format!("navigate run/rig.toml --calibration {calibration}"), with(calibration)),
        (format!("apply run/rig.toml --calibration {calibration} -o new.csv"), with(calibration)),
        ("convert run/rig.toml -o other.parquet".to_owned(), log()),
        ("init run/run.csv".to_owned(), only("run/run.csv")),
        (format!("compare {calibration} {calibration}"), only(calibration)),
        ("observe scenario.toml".to_owned(), only("scenario.toml")),
        ("simulate scenario.toml -o again".to_owned(), only("scenario.toml")),
        ("monte-carlo scenario.toml --runs 2 -o runs.parquet".to_owned(), only("scenario.toml")),
    ] {
        let hypothesis = "schema = 1\nbase = \"full\"\n[[term]]\nid = \"encoder_latency\"\n";
        fs::write(folder.join("h.toml"), hypothesis).unwrap();
        let result = result_in(folder, &command);
        let found: Vec<String> = inputs(&result).into_iter().map(|(path, _)| path).collect();
        assert_eq!(found, expected, "{command}");
        assert_eq!(result["provenance"]["version"], env!("CARGO_PKG_VERSION"), "{command}");
        assert!(result["repairs"].is_array() && result["assumptions"].is_array(), "{command}");
        for measured in list(&result, "/provenance/measured") {
            assert_eq!(measured["started"], "2026-11-26T10:00:00Z", "{command}");
            assert_eq!(measured["laboratory"], "Inertial laboratory", "{command}");
            assert!(measured["operator"].is_null(), "{command}");
            assert_eq!(result["provenance"]["item"]["serial"], "FOG-0012", "{command}");
        }
    }
}

#[test]
fn a_digest_is_that_of_the_bytes_and_the_calibration_keeps_it() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    calibrated(folder);
    let before = result_in(folder, "check run/rig.toml");
    let temperature = numbers(&before["provenance"]["measured"][0], "/temperature_degc");
    // A minute at 60 K/h.
    assert!((temperature[1] - temperature[0] - 1.0).abs() < 0.1, "{temperature:?}");
    let file = fs::read_to_string(folder.join("cal/calibration.toml")).unwrap();
    for (path, digest) in inputs(&before) {
        assert_eq!(digest.len(), 64);
        assert!(file.contains(&digest) && file.contains(&path), "{file}");
    }
    let page = fs::read_to_string(folder.join("cal/report.html")).unwrap();
    assert!(page.contains("Provenance") && page.contains("not stated"), "no basis on the page");
    assert!(page.contains("Example Gyros") && page.contains("FOG-0012"));

    let mut rig = fs::read_to_string(folder.join("run/rig.toml")).unwrap();
    rig.push_str("# A remark.\n");
    fs::write(folder.join("run/rig.toml"), rig).unwrap();
    let after = result_in(folder, "check run/rig.toml");
    let [before, after] = [inputs(&before), inputs(&after)];
    assert_ne!(before[0].1, after[0].1);
    assert_eq!(before[1], after[1]);

    let wrong = file.replace("sha256 = [\"", "sha256 = [\"x");
    fs::write(folder.join("wrong.toml"), wrong).unwrap();
    let refused = rins_in(folder, "navigate run/rig.toml --calibration wrong.toml");
    assert_eq!(refused.code, Some(1));
    assert!(refused.err.contains("64 hexadecimal digits"), "{}", refused.err);
}

#[test]
fn an_assumed_data_sheet_is_an_assumption() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("scenario.toml"), SCENARIO).unwrap();
    result_in(folder, "simulate scenario.toml -o run");
    let stated = result_in(folder, "calibrate run/rig.toml --model full");
    assert!(texts(&stated, "/assumptions").is_empty(), "{stated:#}");
    let rig = fs::read_to_string(folder.join("run/rig.toml")).unwrap();
    let mut is_kept = true;
    let lines = rig.lines().filter(|line| {
        if line.starts_with('[') {
            is_kept = !line.starts_with("[imu");
        }
        is_kept
    });
    fs::write(folder.join("run/bare.toml"), lines.collect::<Vec<_>>().join("\n")).unwrap();
    let bare = result_in(folder, "calibrate run/bare.toml --model full");
    let told = texts(&bare, "/assumptions");
    assert!(told[0].contains("states no data sheet"), "{told:?}");
}
