//! Calibrations with one rate table, whose rate is off by no more than stated.

use std::fs;
use std::path::Path;

use crate::support::{list, number, parameter, result_in, rins_in};

/// The stated accuracy of the table's rate and its error [deg/s].
const ACCURACY: f64 = 0.0001;
const ERROR: f64 = 0.00008;

/// Calibrates in `folder/name` an IMU of this scale error [ppm] at this commanded rate [deg/s]; the table is faster.
fn calibrate(folder: &Path, name: &str, (scale, rate, seed): (f64, f64, u64), laboratory: &str) {
    let scenario = format!(
        r#"
[site]
latitude = "45 deg"
height = "0 m"
[log]
rate = "25 Hz"
[table]
profile = [
    {{ rate = "{} deg/s", duration = "120 s" }},
    {{ rate = "{} deg/s", duration = "120 s" }},
]
[attitude]
roll = "20 deg"
pitch = "15 deg"
yaw = "0 deg"
sigma = "0.1 deg"
[imu]
grade = "rlg"
[truth]
seed = {seed}
[truth.gyro]
scale = ["0 ppm", "0 ppm", "{scale} ppm"]
"#,
        rate + ERROR,
        -(rate + ERROR)
    );
    fs::write(folder.join("scenario.toml"), scenario).unwrap();
    let simulated = rins_in(folder, &format!("simulate scenario.toml -o run-{name}"));
    assert_eq!(simulated.code, Some(0), "{}", simulated.err);
    let rig = folder.join(format!("run-{name}/rig.toml"));
    let text = fs::read_to_string(&rig).unwrap();
    // The laboratory knows the commanded rate.
    let stated = text
        .replace(&format!("\"{} deg/s\"", rate + ERROR), &format!("\"{rate} deg/s\""))
        .replace(&format!("\"{} deg/s\"", -(rate + ERROR)), &format!("\"{} deg/s\"", -rate))
        .replace("[table]", &format!("[table]\nrate_accuracy = \"{ACCURACY} deg/s\""));
    assert_eq!(stated.matches(&format!("{rate} deg/s")).count(), 2, "{stated}");
    let day = seed + 1;
    let run = format!("\n[run]\nstarted = \"2026-01-{day:02}T08:00:00Z\"\n");
    fs::write(&rig, format!("{stated}{run}\n[lab]\nname = \"{laboratory}\"\n")).unwrap();
    let calibrated =
        rins_in(folder, &format!("calibrate run-{name}/rig.toml --model full -o {name}"));
    assert_eq!(calibrated.code, Some(0), "{}", calibrated.err);
}

/// The sigmas of the difference of the scale error about z of two calibrations.
fn differs(folder: &Path, a: &str, b: &str) -> f64 {
    let command = format!("compare {a}/calibration.toml {b}/calibration.toml");
    number(parameter(&result_in(folder, &command), "gyro.scale.z"), "/sigmas")
}

/// The error of a reference is the same in all runs of a laboratory: it hides no change between them, and what it adds at one rate and
/// not at another is no change.
#[test]
fn errors_of_a_reference_are_those_of_all_runs_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    calibrate(folder, "before", (100.0, 10.0, 1), "a");
    calibrate(folder, "same", (100.0, 10.0, 2), "a");
    calibrate(folder, "changed", (112.0, 10.0, 3), "a");
    calibrate(folder, "faster", (100.0, 20.0, 4), "a");
    calibrate(folder, "elsewhere", (106.0, 10.0, 5), "b");

    assert!(differs(folder, "before", "same").abs() < 4.0);
    assert!(differs(folder, "before", "changed") > 8.0);
    let at_other_rate = differs(folder, "before", "faster");
    assert!((-3.0..-0.5).contains(&at_other_rate), "{at_other_rate}");
    let elsewhere = differs(folder, "before", "elsewhere");
    assert!(elsewhere.abs() < 3.0, "{elsewhere}");

    let homogeneity = |runs: &str| {
        let history = result_in(folder, &format!("history {runs}"));
        let scale = list(&history, "/homogeneity").iter().find(|one| one["id"] == "gyro.scale.z");
        let told = list(&history, "/notes")
            .iter()
            .any(|one| one.as_str().unwrap().contains("table.rate_accuracy"));
        assert!(told, "{history}");
        number(scale.unwrap(), "/p_value")
    };
    let of = |names: &[&str]| -> String {
        let files: Vec<String> =
            names.iter().map(|name| format!("{name}/calibration.toml")).collect();
        files.join(" ")
    };
    assert!(homogeneity(&of(&["before", "same", "changed"])) < 1e-12);
    assert!(homogeneity(&of(&["before", "same", "faster"])) > 1e-3);
    assert!(homogeneity(&of(&["before", "same", "elsewhere"])) > 1e-3);
}
