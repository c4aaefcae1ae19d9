//! The library returns the output of the command, byte for byte.

use std::fmt::Display;
use std::path::Path;

use rins::{CalibrateOptions, Log, ModelChoice};
use serde::Serialize;

use crate::support::rins_in;

/// Asserts that the command prints an outcome as text, and its result with `--json`.
fn says<O: rins::Outcome + Display>(folder: &Path, arguments: &str, outcome: &O)
where
    O::Result: Serialize,
{
    assert_eq!(rins_in(folder, arguments).out, outcome.to_string(), "rins {arguments}");
    let json = rins_in(folder, &format!("{arguments} --json")).out;
    let own = serde_json::to_string(&outcome.result()).unwrap() + "\n";
    assert_eq!(json, own, "rins {arguments} --json");
}

#[test]
fn a_program_prints_what_the_command_prints() {
    let folder = tempfile::tempdir().unwrap();
    rins::demo::log(folder.path()).unwrap();
    let rig = folder.path().join("rig.toml");
    let log = || Log::open(&rig).unwrap();
    let shown = rig.display();
    says(folder.path(), &format!("check {shown}"), &rins::check(&log()));
    let calibrated = |model: Option<ModelChoice>| {
        let options = CalibrateOptions { model, ..CalibrateOptions::default() };
        rins::calibrate(vec![log()], &options).unwrap()
    };
    says(folder.path(), &format!("calibrate {shown}"), &calibrated(None));
    let full = calibrated(Some(ModelChoice::Full));
    says(folder.path(), &format!("calibrate {shown} --model full"), &full);
}
