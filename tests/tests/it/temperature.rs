//! Temperature-dependent terms refer to the reference temperature of the model, in whichever run they are used.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::support::{assert_found, list, number, numbers, parameter, result_in, rins_in, texts};

/// A tilted table with a static interval and rotations in both directions, and a gyro that changes by (0.5, -0.3, 0.2) deg/h
/// and 2 ppm per kelvin; `temperature` is its temperature profile.
fn simulated(folder: &Path, name: &str, temperature: &str, seed: u32) {
    let scenario = format!(
        r#"[site]
latitude = "45 deg"
longitude = "0 deg"
height = "100 m"
[log]
rate = "20 Hz"
table_angle = {{ noise = "0.5 arcsec" }}
[table]
acceleration = "10 deg/s^2"
profile = [
    {{ rate = "0 deg/s", duration = "40 s" }},
    {{ rate = "20 deg/s", duration = "180 s" }},
    {{ rate = "-20 deg/s", duration = "180 s" }},
]
[attitude]
roll = "20 deg"
pitch = "0 deg"
yaw = "0 deg"
sigma = "0.1 deg"
[imu.gyro]
noise = "0.02 deg/h/sqrt(Hz)"
bias_sigma = "10 deg/h"
scale_sigma = "500 ppm"
misalignment_sigma = "120 arcsec"
[imu.accel]
noise = "30 ug/sqrt(Hz)"
bias_sigma = "200 ug"
scale_sigma = "300 ppm"
misalignment_sigma = "60 arcsec"
[truth]
seed = {seed}
temperature = {temperature}
gyro = {{ bias = ["1 deg/h", "2 deg/h", "-1 deg/h"], scale = ["0 ppm", "0 ppm", "100 ppm"] }}
effects = [
    {{ id = "gyro_thermal_bias", x = "0.5 deg/h/K", y = "-0.3 deg/h/K", z = "0.2 deg/h/K" }},
    {{ id = "gyro_thermal_scale", z = "2 ppm/K" }},
]
"#
    );
    fs::write(folder.join("scenario.toml"), scenario).unwrap();
    result_in(folder, &format!("simulate scenario.toml -o {name}"));
}

fn write_model(folder: &Path, opening: &str) {
    let terms = "[[term]]\nid = \"gyro_thermal_bias\"\n[[term]]\nid = \"gyro_thermal_scale\"\n";
    let model = format!("schema = 1\nbase = \"full\"\n{opening}{terms}");
    fs::write(folder.join("m.toml"), model).unwrap();
}

/// The velocity error of free navigation with a calibration \[m/s\], and the remarks on its range.
fn navigated(folder: &Path, rig: &str, more: &str) -> (f64, Value) {
    let result =
        result_in(folder, &format!("navigate {rig} --calibration cal/calibration.toml{more}"));
    let last = result["runs"].as_array().unwrap().last().unwrap();
    assert_eq!(last["name"], "compensated");
    let velocity = numbers(last, "/velocity_m_s").iter().map(|v| v * v).sum::<f64>().sqrt();
    (velocity, result)
}

#[test]
fn calibration_is_as_good_in_a_run_that_starts_at_another_temperature() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulated(folder, "warming", r#"{ start = "10 degC", ramp = "270 K/h" }"#, 1);
    simulated(folder, "warm", r#"{ start = "38 degC", ramp = "10 K/h" }"#, 2);
    simulated(folder, "cold", r#""12 degC""#, 3);
    simulated(folder, "hot", r#""75 degC""#, 4);
    write_model(folder, "");
    let found = result_in(folder, "calibrate warming/rig.toml --model m.toml -o cal");
    // Values refer to 20 degC, as in the simulation.
    for (id, truth) in [
        ("gyro.scale.z", 100.0),
        ("gyro_thermal_scale.z", 2.0),
        ("gyro.bias.x", 1.0),
        ("gyro.bias.y", 2.0),
        ("gyro_thermal_bias.x", 0.5),
        ("gyro_thermal_bias.y", -0.3),
    ] {
        assert_found(&found, id, truth);
    }
    let file = fs::read_to_string(folder.join("cal/calibration.toml")).unwrap();
    assert!(file.contains("reference_temperature = \"20 degC\""), "{file}");
    assert!(file.contains("[range]\ntemperature = [\"10"), "{file}");
    let own = navigated(folder, "warming/rig.toml", "").0;
    for run in ["warm", "cold"] {
        let (velocity, result) = navigated(folder, &format!("{run}/rig.toml"), "");
        // A reference at the run's initial temperature would leave degrees per hour: meters per second.
        assert!(velocity < own + 0.02, "{run}: {velocity} m/s, {own} where it was calibrated");
        assert_eq!(result["notes"], Value::Array(Vec::new()), "{run}");
    }
    // 35 K outside a calibrated range of 30 K.
    let far = rins_in(folder, "navigate hot/rig.toml --calibration cal/calibration.toml");
    assert_eq!(far.code, Some(1));
    assert!(
        far.err.contains("Temperature 75.0 to 75.0 degC, calibrated from 10.0 to"),
        "{}",
        far.err
    );
    assert!(far.err.contains("--extrapolate"), "{}", far.err);
    let (_, result) = navigated(folder, "hot/rig.toml", " --extrapolate");
    let outside = number(&result, "/outside_calibrated_range/temperature_degc/outside");
    assert!((34.0..36.0).contains(&outside), "{outside}");
    assert!(texts(&result, "/notes")[0].contains("K outside; the coefficients then add, 1σ, "));
    let command = "apply hot/rig.toml --calibration cal/calibration.toml -o clean.csv";
    let refused = rins_in(folder, command);
    assert_eq!((refused.code, folder.join("clean.csv").exists()), (Some(1), false));
    let applied = result_in(folder, &format!("{command} --extrapolate"));
    assert_eq!(applied["outside_calibrated_range"], result["outside_calibrated_range"]);
}

#[test]
fn runs_at_different_temperatures_share_a_scale_error_at_the_reference() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulated(folder, "cold", r#""10 degC""#, 5);
    simulated(folder, "warm", r#""40 degC""#, 6);
    for (opening, scale) in [("", 100.0), ("reference_temperature = \"35 degC\"\n", 130.0)] {
        write_model(folder, opening);
        let found = result_in(folder, "calibrate cold/rig.toml warm/rig.toml --model m.toml");
        assert_found(&found, "gyro.scale.z", scale);
        assert_found(&found, "gyro_thermal_scale.z", 2.0);
        assert_eq!(parameter(&found, "gyro_thermal_scale.z")["observability"], "observable");
    }
}

#[test]
fn log_without_temperature_and_temperatures_in_kelvin_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulated(folder, "run", r#"{ start = "10 degC", ramp = "270 K/h" }"#, 7);
    write_model(folder, "");
    result_in(folder, "calibrate run/rig.toml --model m.toml -o cal");
    let rig = fs::read_to_string(folder.join("run/rig.toml")).unwrap();
    let lines = rig.lines().filter(|line| !line.starts_with("temperature"));
    let rig: Vec<&str> = lines.collect();
    fs::write(folder.join("run/none.toml"), rig.join("\n")).unwrap();
    for command in [
        "calibrate run/none.toml --model m.toml",
        "navigate run/none.toml --calibration cal/calibration.toml",
        "apply run/none.toml --calibration cal/calibration.toml -o clean.csv",
    ] {
        let refused = rins_in(folder, command);
        assert_eq!(refused.code, Some(1), "{command}");
        let says = "gyro_thermal_bias, which depends on temperature, and the log has none";
        assert!(refused.err.contains(says), "{command}: {}", refused.err);
    }
    write_model(folder, "reference_temperature = \"293 K\"\n");
    let refused = rins_in(folder, "calibrate run/rig.toml --model m.toml");
    assert_eq!(refused.code, Some(1));
    assert!(refused.err.contains("a temperature such as \"20 degC\""), "{}", refused.err);
}

/// A coefficient that is unobservable in any single run, because each has one temperature: three soaks show it.
#[test]
fn scale_error_that_differs_between_soaks_is_named_as_its_temperature_coefficient() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (name, temperature, seed) in [("a", 20, 8), ("b", 40, 9), ("c", 60, 10)] {
        simulated(folder, name, &format!("\"{temperature} degC\""), seed);
    }
    let found = result_in(folder, "diagnose a/rig.toml b/rig.toml c/rig.toml");
    let causes: Vec<&str> =
        list(&found, "/causes").iter().map(|cause| cause["effect"].as_str().unwrap()).collect();
    assert_eq!(causes, ["gyro_thermal_scale"], "{found}");
    let cause = &list(&found, "/causes")[0];
    let coefficient = &list(cause, "/parameters")[0];
    let (value, sigma) = (number(coefficient, "/value"), number(coefficient, "/sigma"));
    assert!((value - 2.0).abs() < 4.0 * sigma, "{coefficient}");
    assert_eq!(cause["settings"]["reference_temperature"]["value"], 20.0, "{cause}");
}
