//! Sample runs of an independent generator: the known truth is recovered.

use std::path::{Path, PathBuf};

use rins_frames::units::{ARCSEC, DEG, PPM};
use rins_tests::outside_data;
use serde_json::Value;

use crate::support::{list, magnitude, number, result_in, texts};

/// The minimum sigma: the errors due to accelerometer errors, which are not in the sigma
/// of the model.
const ANGLE_FLOOR: f64 = 0.03;
const SCALE_FLOOR: f64 = 0.1;

fn sample(name: &str) -> PathBuf {
    outside_data(&format!("synthetic/{name}"))
}

fn calibrated(run: &Path) -> Value {
    result_in(run, "calibrate --model paper12 rig.toml")
}

/// The Earth rate about the spin axis of `C_s^n = Rz(yaw) Rx(pitch) Ry(roll)`, from the axis'
/// north and up components.
fn earth_rate_about_spin_axis(truth: &Value, latitude: f64) -> f64 {
    const EARTH_RATE: f64 = 7.292115e-5;
    let [roll, pitch, yaw] =
        [0, 1, 2].map(|angle| number(truth, &format!("/rpy_deg/{angle}")) * DEG);
    let north = roll.sin() * yaw.sin() - pitch.sin() * roll.cos() * yaw.cos();
    let up = pitch.cos() * roll.cos();
    EARTH_RATE * (latitude.cos() * north + latitude.sin() * up)
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn one_constant_rate_shows_combinations_and_says_so() {
    let run = sample("paper_constant_rate");
    let truth = std::fs::read_to_string(run.join("truth.json")).unwrap();
    let truth: Value = serde_json::from_str(&truth).unwrap();
    let rate = 10.0 * DEG + earth_rate_about_spin_axis(&truth, 34.25 * DEG);
    let result = calibrated(&run);
    assert_eq!(result["model"], "paper12");
    let expected = [
        ("gyro.misalignment.xz", "gyro.bias.x", 0, "arcsec", ARCSEC, ANGLE_FLOOR),
        ("gyro.misalignment.yz", "gyro.bias.y", 1, "arcsec", ARCSEC, ANGLE_FLOOR),
        ("gyro.scale.z", "gyro.bias.z", 2, "ppm", PPM, SCALE_FLOOR),
    ];
    let parameters = list(&result, "/parameters");
    assert_eq!(parameters.len(), expected.len());
    for (parameter, (id, alias, axis, unit, factor, floor)) in parameters.iter().zip(expected) {
        assert_eq!((&parameter["id"], &parameter["unit"]), (&id.into(), &unit.into()));
        assert_eq!(parameter["identifiable"], false, "{id}");
        assert_eq!(texts(parameter, "/aliases"), [alias]);
        let coupling = number(&truth, &format!("/Mg/{axis}/2"));
        let combination = (coupling + number(&truth, &format!("/bg/{axis}")) / rate) / factor;
        let (value, sigma) = (number(parameter, "/value"), number(parameter, "/sigma"));
        let off = (value - combination).abs();
        assert!(off < 4.0 * sigma.max(floor), "{id}: {combination} found as {value} ± {sigma}");
        // Without the bias it would not be the truth: the test is sensitive to it.
        assert!((value - coupling / factor).abs() > 4.0 * sigma.max(floor), "{id}");
    }
    let before = magnitude(&result, "/navigation/before/velocity_m_s");
    let after = magnitude(&result, "/navigation/after/velocity_m_s");
    assert!(before > 100.0 * after, "{before} m/s before, {after} m/s after");
}

/// Several rates distinguish the errors from the biases, but a model without biases does not fit them.
#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn several_rates_show_that_the_model_lacks_something() {
    for name in ["clean_multirate", "encoder_latency_reversal"] {
        let run = sample(name);
        let result = calibrated(&run);
        assert_eq!(result["consistency"]["model_fits"], false, "{name}");
        for parameter in list(&result, "/parameters") {
            assert_eq!(parameter["identifiable"], true, "{name}: {parameter}");
            assert!(texts(parameter, "/aliases").is_empty(), "{name}: {parameter}");
        }
    }
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn every_sample_run_is_taken() {
    for name in ["lever_arm_multirate", "g_sensitivity_dwell", "thermal_and_asymmetry"] {
        let run = sample(name);
        let checked = result_in(&run, "check rig.toml");
        assert!(texts(&checked, "/suspicions").is_empty(), "{name}: {checked}");
        let result = calibrated(&run);
        let correlation = list(&result, "/correlation");
        for (row, parameter) in list(&result, "/parameters").iter().enumerate() {
            assert!(number(parameter, "/value").is_finite() && number(parameter, "/sigma") > 0.0);
            assert_eq!(correlation[row][row], 1.0, "{name}");
        }
        let before = magnitude(&result, "/navigation/before/velocity_m_s");
        let after = magnitude(&result, "/navigation/after/velocity_m_s");
        assert!(before > 10.0 * after, "{name}: {before} m/s before, {after} m/s after");
    }
}
