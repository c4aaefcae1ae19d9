//! Every result, printed as JSON, deserializes to the same struct.

use std::fmt::Debug;
use std::fs;
use std::path::Path;

use rins::{
    ApplyOptions, CalibrateOptions, ConvertOptions, DiagnoseOptions, Log, ModelChoice,
    MonteCarloOptions, NavigateOptions, ObserveOptions, Outcome, Overwrite,
};
use tempfile::TempDir;

/// Asserts that a result deserializes, and that its JSON names command and schema.
fn reads_back<O: Outcome>(command: &str, outcome: &O)
where
    O::Result: PartialEq + Debug,
{
    let result = outcome.result();
    let text = serde_json::to_string(&result).unwrap();
    let read: O::Result = serde_json::from_str(&text).unwrap_or_else(|error| {
        panic!("{command}: {error}");
    });
    assert_eq!(read, result, "{command}");
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&value["schema"], &value["command"]), (&2.into(), &command.into()));
    assert!(outcome.to_string().ends_with('\n'), "{command}: a text ends with a line end");
}

fn demo() -> (TempDir, Log) {
    let folder = tempfile::tempdir().unwrap();
    let log = rins::demo::log(folder.path()).unwrap();
    (folder, log)
}

fn scenario(folder: &Path) -> std::path::PathBuf {
    let path = folder.join("scenario.toml");
    fs::write(&path, rins::demo::SCENARIO).unwrap();
    path
}

#[test]
fn what_looks_at_a_log() {
    let (_folder, log) = demo();
    reads_back("check", &rins::check(&log));
    reads_back("allan", &rins::allan(&log).unwrap());
    reads_back("align", &rins::align(&log).unwrap());
    reads_back("navigate", &rins::navigate(&log, &NavigateOptions::default()).unwrap());
}

#[test]
fn calibrations_and_what_follows_from_them() {
    let (folder, log) = demo();
    let paper = rins::calibrate(vec![log.clone()], &CalibrateOptions::default()).unwrap();
    reads_back("calibrate", &paper);
    let out = folder.path().join("out");
    paper.write(&out, Overwrite::Refuse).unwrap();
    let calibration = out.join("calibration.toml");
    reads_back("compare", &rins::compare(&calibration, &calibration).unwrap());
    let options = ApplyOptions {
        calibration,
        output: folder.path().join("compensated.csv"),
        format: None,
        extrapolate: false,
        overwrite: Overwrite::Refuse,
    };
    let rig = folder.path().join("rig.toml");
    reads_back("apply", &rins::apply(&rig, options).unwrap());
    let options =
        CalibrateOptions { model: Some(ModelChoice::Full), ..CalibrateOptions::default() };
    reads_back("calibrate", &rins::calibrate(vec![log.clone(), log], &options).unwrap());
}

#[test]
fn a_diagnosis() {
    let (folder, log) = demo();
    let model = folder.path().join("model.toml");
    let text =
        "schema = 1\nbase = \"full\"\n\n[[term]]\nid = \"gyro_g_sensitivity\"\nestimate = true\n";
    fs::write(&model, text).unwrap();
    let options = DiagnoseOptions {
        bootstrap: Some(2),
        transfer: true,
        hypothesis: Some(model),
        ..DiagnoseOptions::default()
    };
    reads_back("diagnose", &rins::diagnose(vec![log], options).unwrap());
}

#[test]
fn what_makes_files() {
    let (folder, _log) = demo();
    let at = |name: &str| folder.path().join(name);
    reads_back("init", &rins::init(&at("run.csv"), None).unwrap());
    let options =
        ConvertOptions { output: at("run.mat"), format: None, overwrite: Overwrite::Refuse };
    reads_back("convert", &rins::convert(&at("rig.toml"), options).unwrap());
    let scenario = scenario(folder.path());
    reads_back("simulate", &rins::simulate(&scenario, None).unwrap());
    let options = MonteCarloOptions::new(3, at("runs.parquet"));
    reads_back("monte-carlo", &rins::monte_carlo(&scenario, &options).unwrap());
    let options = MonteCarloOptions {
        model: ModelChoice::Full,
        ..MonteCarloOptions::new(2, at("runs-of-model.parquet"))
    };
    reads_back("monte-carlo", &rins::monte_carlo(&scenario, &options).unwrap());
    let whole = rins::merge(&[at("runs.parquet")], &at("all.parquet"), Overwrite::Refuse).unwrap();
    reads_back("merge", &whole);
}

#[test]
fn what_a_schedule_shows() {
    let (folder, _log) = demo();
    let scenario = scenario(folder.path());
    let separate = Some(["gyro_g_sensitivity", "encoder_eccentricity"].map(String::from));
    let options = ObserveOptions { separate, ..ObserveOptions::default() };
    reads_back("observe", &rins::observe(&[scenario], &options).unwrap());
}
