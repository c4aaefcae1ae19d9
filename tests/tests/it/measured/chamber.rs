//! A thermal cycle of a static MEMS IMU.

use std::fs;
use std::path::Path;

use nalgebra::Vector3;

use super::rig;
use crate::support::{parameter, result_in, rins_in};

/// Cooling from 52 to -18 degC and warming to 18 degC.
const FIRST_HALF: [&str; 2] = ["0 s", "4200 s"];

/// Warming from 18 to 50 degC: temperatures at which the first half saw the IMU cool.
const LATER: [&str; 2] = ["4200 s", "5300 s"];

/// The rig file of a part of the log.
fn part(folder: &Path, name: &str, [from, to]: [&str; 2]) {
    let whole = fs::read_to_string(folder.join("rig.toml")).unwrap();
    let part = whole.replace("\"0 s\", \"8400 s\"", &format!("\"{from}\", \"{to}\""));
    fs::write(folder.join(name), part).unwrap();
}

/// The root mean square of each gyro in a compensated log \[mrad/s\]: an IMU at rest reads nothing, but for the Earth's 0.07.
fn gyros(log: &Path) -> Vector3<f64> {
    let rows = fs::read_to_string(log).unwrap();
    let squares: Vec<Vector3<f64>> = rows
        .lines()
        .skip(1)
        .map(|row| {
            let fields: Vec<f64> = row.split(',').map(|field| field.parse().unwrap()).collect();
            Vector3::from_column_slice(&fields[1..4]).map(|rate| rate * rate)
        })
        .collect();
    let mean = squares.iter().sum::<Vector3<f64>>() / squares.len() as f64;
    mean.map(|square| 1e3 * square.sqrt())
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn thermal_cycle_predicts_its_other_half() {
    let folder = rig("tofupilot_thermal");
    let folder = folder.path();
    part(folder, "first.toml", FIRST_HALF);
    part(folder, "later.toml", LATER);
    let predicted = |name: &str, terms: &[&str]| {
        let list: Vec<String> = terms.iter().map(|term| format!("[[term]]\nid = {term}")).collect();
        let list = list.join("\n");
        fs::write(folder.join("model.toml"), format!("schema = 1\nbase = \"full\"\n{list}\n"))
            .unwrap();
        let found =
            result_in(folder, &format!("calibrate first.toml --model model.toml -o {name}"));
        let applied =
            format!("apply later.toml --calibration {name}/calibration.toml -o {name}.csv");
        result_in(folder, &applied);
        (found, gyros(&folder.join(format!("{name}.csv"))))
    };
    let lines = ["\"gyro_thermal_bias\"", "\"accel_thermal_bias\""];
    let curves = ["\"gyro_thermal_polynomial\"", "\"accel_thermal_polynomial\""];
    let lag = "\"gyro_thermal_lag\"\ntime_constant = \"800 s\"";
    let (_, line) = predicted("line", &lines);
    let (_, curve) = predicted("curve", &curves);
    let (found, behind) = predicted("behind", &[&curves[..], &[lag]].concat());
    // Gyro y follows a curve: over the whole cycle a line leaves 4.7 mrad/s, a cubic 0.95.
    assert!(curve.y < 0.4 * line.y, "gyro y: {line} by a line, {curve} by a curve");
    // Gyro x reads something else while it warms up than while it cools.
    assert!(behind.x < 0.75 * curve.x, "gyro x: {curve} without hysteresis, {behind} with it");
    let hysteresis = parameter(&found, "gyro_thermal_lag.x");
    assert!(hysteresis["value"].as_f64() > hysteresis["sigma"].as_f64().map(|s| 5.0 * s));
}

/// A sensor that drifts looks like one that moves: the message says how to state that it does not.
#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn drift_of_a_static_sensor_is_stated_by_the_user() {
    let folder = rig("tofupilot_thermal");
    let rig = folder.path().join("rig.toml");
    let text = fs::read_to_string(&rig).unwrap();
    let text = text.replace("static = [[\"0 s\", \"8400 s\"]]", "");
    // Without a data sheet, nothing says how far its biases may drift.
    fs::write(&rig, text.split("[imu]").next().unwrap()).unwrap();
    let refused = rins_in(folder.path(), "calibrate rig.toml");
    assert_eq!(refused.code, Some(1));
    assert!(refused.err.contains("never static"), "{}", refused.err);
    assert!(refused.err.contains("[log] static = "), "{}", refused.err);
}
