//! A MEMS on a level rate table: gyros that cannot determine north, and no attitude in the rig file.

use std::fs;
use std::path::Path;

use rins_testing::site;
use serde_json::Value;

use crate::support::{assert_found, list, number, parameter, result_in, texts};

/// The table at `rate` \[deg/s\], forward and back, with an effect.
fn scenario(rate: f64, effects: &str, seed: u32) -> String {
    let site = site!();
    format!(
        r#"{site}
[log]
rate = "50 Hz"
table_angle = {{ noise = "20 arcsec" }}

[table]
acceleration = "100 deg/s^2"
profile = [
    {{ rate = "0 deg/s", duration = "12 s" }},
    {{ rate = "{rate} deg/s", duration = "20 s" }},
    {{ rate = "-{rate} deg/s", duration = "20 s" }},
    {{ rate = "0 deg/s", duration = "12 s" }},
]

[attitude]
roll = "0 deg"
pitch = "0 deg"
yaw = "30 deg"
sigma = "0.5 deg"

[imu.gyro]
noise = "0.01 deg/s/sqrt(Hz)"
bias_sigma = "0.1 deg/s"
scale_sigma = "1 %"
misalignment_sigma = "1 deg"

[imu.accel]
noise = "150 ug/sqrt(Hz)"
bias_sigma = "20 mg"
scale_sigma = "1 %"
misalignment_sigma = "1 deg"

[truth]
seed = {seed}
effects = [{effects}]

[truth.gyro]
bias = ["40 deg/h", "-70 deg/h", "100 deg/h"]
scale = ["1000 ppm", "-2000 ppm", "4000 ppm"]
misalignment = {{ xy = "0 arcsec", xz = "0 arcsec", yx = "0 arcsec", yz = "0 arcsec", zx = "0 arcsec", zy = "0 arcsec" }}
"#
    )
}

/// Simulates a scenario into `folder`/run, and removes the attitude from its rig file.
fn without_attitude(folder: &Path, scenario: &str) {
    fs::write(folder.join("scenario.toml"), scenario).unwrap();
    result_in(folder, "simulate scenario.toml -o run --force");
    let rig = folder.join("run/rig.toml");
    let text = fs::read_to_string(&rig).unwrap();
    let (before, attitude) = text.split_once("[attitude]").unwrap();
    let (_, after) = attitude.split_once("\n[").unwrap();
    fs::write(&rig, format!("{before}[{after}")).unwrap();
}

/// The model is the one that is possible, and the result names it.
#[test]
fn model_is_full_where_the_attitude_is_unknown() {
    let folder = tempfile::tempdir().unwrap();
    for seed in 1..=3 {
        without_attitude(folder.path(), &scenario(90.0, "", seed));
        let result = result_in(folder.path(), "calibrate run/rig.toml");
        assert_eq!(result["model"], "full");
        let says = |note: &&str| note.contains("The model is full, as paper12 is not possible");
        assert!(texts(&result, "/notes").iter().any(says));
        assert_found(&result, "gyro.scale.z", 4000.0);
        assert_found(&result, "gyro.bias.z", 100.0);
        assert!(number(parameter(&result, "gyro.scale.z"), "/sigma") < 30.0);
    }
}

/// An IMU at 6 cm from the axis of a fast level table: no error of axes, but a lever arm.
#[test]
fn lever_arm_on_a_fast_level_table_is_identified() {
    let folder = tempfile::tempdir().unwrap();
    let effect = r#"{ id = "accel_lever_arm", r_x = "60 mm" }"#;
    without_attitude(folder.path(), &scenario(200.0, effect, 1));
    let check = result_in(folder.path(), "check run/rig.toml");
    let bad: Vec<&Value> =
        list(&check, "/verdicts").iter().filter(|verdict| verdict["verdict"] == "bad").collect();
    assert!(bad.is_empty(), "{bad:?}");
    let result = result_in(folder.path(), "diagnose run/rig.toml");
    assert_eq!(result["causes"][0]["effect"], "accel_lever_arm");
    let arm = list(&result, "/causes/0/parameters")
        .iter()
        .find(|parameter| parameter["id"] == "accel_lever_arm.r_x")
        .unwrap();
    let (value, sigma) = (number(arm, "/value"), number(arm, "/sigma"));
    assert!((value - 60.0).abs() < 4.0 * sigma && sigma < 0.5, "{value} ± {sigma} mm");
}
