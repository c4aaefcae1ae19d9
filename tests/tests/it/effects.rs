//! Effects of a scenario: simulated, contained in the truth, and compensated by a calibration with these effects.

use std::fs;

use rins_testing::assert_close;
use rins_tests::workspace;
use serde_json::Value;

use crate::support::{list, magnitude, number, result_in};

/// A table that rotates in both directions, an IMU with a lever arm, a temperature-dependent bias, and an
/// encoder with eccentricity.
const SCENARIO: &str = r#"
[site]
latitude = "45 deg"
longitude = "0 deg"
height = "0 m"

[log]
rate = "20 Hz"
table_angle = {}

[table]
acceleration = "5 deg/s^2"
profile = [{ rate = "10 deg/s", duration = "60 s" }, { rate = "-20 deg/s", duration = "60 s" }]

[attitude]
roll = "25 deg"
pitch = "0 deg"
yaw = "0 deg"
sigma = "0.1 deg"

[truth]
seed = 1
temperature = { start = "20 degC", ramp = "60 K/h" }
gyro = { scale = ["0 ppm", "0 ppm", "300 ppm"] }
noise = { gyro = "off", accel = "off", table_angle = "off" }
effects = [
    { id = "accel_lever_arm", r_x = "40 mm", r_y = "-25 mm" },
    { id = "gyro_thermal_bias", x = "3 deg/h/K" },
    { id = "encoder_harmonic", order = 3, cos = "10 arcsec" },
]
"#;

/// The calibration that compensates them.
const CALIBRATION: &str = r#"
schema = 2

[gyro]
bias = ["0 deg/h", "0 deg/h", "0 deg/h"]
scale = ["0 ppm", "0 ppm", "300 ppm"]
misalignment = { xy = "0 arcsec", xz = "0 arcsec", yx = "0 arcsec", yz = "0 arcsec", zx = "0 arcsec", zy = "0 arcsec" }

[accel]
bias = ["0 ug", "0 ug", "0 ug"]
scale = ["0 ppm", "0 ppm", "0 ppm"]
misalignment = { xy = "0 arcsec", xz = "0 arcsec", yx = "0 arcsec", yz = "0 arcsec", zx = "0 arcsec", zy = "0 arcsec" }

[[term]]
id = "accel_lever_arm"
r_x = "40 mm"
r_y = "-25 mm"
sigma = { r_x = "1 mm", r_y = "1 mm" }

[[term]]
id = "gyro_thermal_bias"
x = "3 deg/h/K"

[[term]]
id = "encoder_harmonic"
order = 3
cos = "10 arcsec"
"#;

#[test]
fn what_is_simulated_is_told_and_undone() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scenario.toml"), SCENARIO).unwrap();
    fs::write(folder.path().join("calibration.toml"), CALIBRATION).unwrap();
    result_in(folder.path(), "simulate scenario.toml -o run");

    let truth = fs::read_to_string(folder.path().join("run/truth.json")).unwrap();
    let truth: Value = serde_json::from_str(&truth).unwrap();
    let ids: Vec<&Value> = list(&truth, "/effects").iter().map(|effect| &effect["id"]).collect();
    assert_eq!(ids, ["accel_lever_arm", "gyro_thermal_bias", "encoder_harmonic"]);
    assert_eq!(truth["effects"][0]["parameters"][1]["id"], "accel_lever_arm.r_y");
    assert_eq!(truth["effects"][0]["parameters"][1]["unit"], "mm");
    assert_close!(number(&truth, "/effects/0/parameters/1/value"), -25.0, 1e-12);
    assert_eq!(truth["effects"][2]["settings"][0]["name"], "order");

    let result = result_in(folder.path(), "navigate run/rig.toml --calibration calibration.toml");
    let runs = list(&result, "/runs");
    let velocity = |run: &str| {
        let run = runs.iter().find(|found| found["name"] == run).unwrap();
        magnitude(run, "/velocity_m_s")
    };
    // The remainder is due to the start: the table angle before the first sample is computed from the z gyro and the angle
    // after it, and the Earth rotates by half an arcsecond meanwhile.
    let (before, after) = (velocity("as recorded"), velocity("compensated"));
    assert!(before > 0.3, "{before} m/s");
    assert!(after < 5e-3 * before, "{before} m/s before, {after} m/s after");
}

/// The shipped schedules are scenarios: each is simulated.
#[test]
fn every_schedule_is_simulated() {
    let folder = tempfile::tempdir().unwrap();
    let schedules = workspace().join("scenarios/schedules");
    let mut files: Vec<_> = fs::read_dir(&schedules)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    files.sort();
    assert_eq!(files.len(), 11);
    for (place, file) in files.iter().enumerate() {
        let scenario = schedules.join(file);
        let command = format!("simulate {} -o run{place}", scenario.display());
        let result = result_in(folder.path(), &command);
        // 360 s at 50 Hz, in one run, two, or three.
        let runs = match file.split_once('-').unwrap().0 {
            "v" | "vi" => 2,
            "vii" => 3,
            _ => 1,
        };
        assert_eq!(result["samples"], 18_000 / runs, "{file}");
        let rig = folder.path().join(format!("run{place}/rig.toml"));
        let run = rins_io::read(&rig).unwrap().recording;
        assert!(run.table_angle.is_some(), "{file}");
    }
}
