//! An IMU that is turned by hand from one static interval to the next, without an angle reference.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use rins_imu::{Seed, Sensor};
use serde_json::Value;

use crate::support::{list, number, result_in, rins_in, texts};

/// Gravity at the site \[m/s²\], as in the rig file.
const GRAVITY: f64 = 9.8;

/// The sample interval \[s\].
const INTERVAL: f64 = 0.02;

/// The number of samples of a static interval, and of a rotation.
const STEPS: [u32; 2] = [300, 75];

/// The accelerometer biases after each turn-on \[m/s²\]; the other errors are constant.
const BIASES: [[f64; 3]; 2] = [[0.02, -0.03, 0.01], [-0.015, 0.01, 0.025]];

/// Scale errors on the diagonal, misalignments off the diagonal.
const SHAPE: Matrix3<f64> =
    Matrix3::new(0.002, 0.001, 0.0, 0.0, -0.003, 0.0015, -0.0005, 0.0, 0.001);

/// The directions of the g-sensitivity, in units of its size.
const SENSITIVITY: Matrix3<f64> = Matrix3::new(1.0, 0.3, -0.2, 0.4, -0.8, 0.1, -0.3, 0.2, 0.6);

/// A log of `turns` quarter turns with a static interval of six seconds after each, and its rig file.
fn turned_over(folder: &Path, name: &str, bias: [f64; 3], turns: usize, seed: u64) {
    g_sensitive(folder, name, (bias, 0.0), turns, seed);
}

/// The same of gyros with a g-sensitivity \[rad/s/g\].
fn g_sensitive(folder: &Path, name: &str, (bias, by): ([f64; 3], f64), turns: usize, seed: u64) {
    let mut deviates = Seed::new(seed).stream(Sensor::Encoder);
    let mut noise = |sigma: f64| Vector3::from_fn(|_, _| sigma * deviates.sample());
    let mut body_from_start = Rotation3::<f64>::identity();
    let mut log = String::from("t,gx,gy,gz,ax,ay,az\n");
    let mut samples = 0_u32;
    let mut hold = |rate: Vector3<f64>, steps: u32| {
        for _ in 0..steps {
            let half = Rotation3::new(-rate * (0.5 * INTERVAL));
            let up = half * body_from_start * Vector3::z();
            body_from_start = half * half * body_from_start;
            let force = up * GRAVITY;
            let accel = force + SHAPE * force + Vector3::from(bias) + noise(2e-3);
            let of_force = SENSITIVITY * force * (by / GRAVITY);
            let gyro = rate + Vector3::new(2e-3, -1e-3, 5e-4) + of_force + noise(1e-3);
            samples += 1;
            let numbers = [gyro.x, gyro.y, gyro.z, accel.x, accel.y, accel.z];
            write!(log, "{:.3}", f64::from(samples) * INTERVAL).unwrap();
            for number in numbers {
                write!(log, ",{number:.9}").unwrap();
            }
            log.push('\n');
        }
    };
    for turn in 0..=turns {
        hold(Vector3::zeros(), STEPS[0]);
        // Axes in general directions, so that all static intervals differ.
        let (one, other) = (1.9 * turn as f64, 0.8 * turn as f64);
        let axis = Unit::new_normalize(Vector3::new(one.cos(), one.sin(), other.sin()));
        let rate = std::f64::consts::FRAC_PI_2 / (f64::from(STEPS[1]) * INTERVAL);
        hold(axis.into_inner() * rate, STEPS[1]);
    }
    fs::write(folder.join(format!("{name}.csv")), log).unwrap();
    let rig = format!(
        "[site]\nlatitude = \"45 deg\"\nlongitude = \"11 deg\"\nheight = \"0 m\"\ngravity = \"9.8 m/s^2\"\n\n\
         [log]\npath = \"{name}.csv\"\ntime = {{ column = \"t\", unit = \"s\" }}\n\
         gyro = {{ columns = [\"gx\", \"gy\", \"gz\"], unit = \"rad/s\" }}\n\
         accel = {{ columns = [\"ax\", \"ay\", \"az\"], unit = \"m/s^2\" }}\n\n\
         [imu.gyro]\nnoise = \"30 deg/h/sqrt(Hz)\"\nbias_sigma = \"500 deg/h\"\nscale_sigma = \"0.5 %\"\n\
         misalignment_sigma = \"0.3 deg\"\n\n\
         [imu.accel]\nnoise = \"30 ug/sqrt(Hz)\"\nbias_sigma = \"5 mg\"\nscale_sigma = \"0.5 %\"\n\
         misalignment_sigma = \"0.3 deg\"\n"
    );
    fs::write(folder.join(format!("{name}.toml")), rig).unwrap();
}

fn shown<'r>(result: &'r Value, id: &str, run: Option<u64>) -> &'r Value {
    let of = |parameter: &&Value| parameter["id"] == id && parameter["run"].as_u64() == run;
    list(result, "/parameters").iter().find(of).unwrap()
}

/// Asserts that a parameter in this unit agrees with the truth of the log.
fn assert_found(parameter: &Value, truth: f64, unit: f64) {
    let (value, sigma) = (number(parameter, "/value"), number(parameter, "/sigma"));
    let off = (value - truth / unit) / sigma;
    assert!(off.abs() < 4.0, "{off} sigma: {parameter}");
    assert_eq!(parameter["identifiable"], true, "{parameter}");
}

const MICRO_G: f64 = 9.80665e-6;

#[test]
fn every_rest_is_used_and_told_of_in_a_line() {
    let folder = tempfile::tempdir().unwrap();
    turned_over(folder.path(), "rig", BIASES[0], 13, 1);
    let result = result_in(folder.path(), "calibrate rig.toml");
    assert_eq!(result["runs"][0]["static_intervals_used"], 14);
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let bias = shown(&result, &format!("accel.bias.{name}"), None);
        assert_found(bias, BIASES[0][axis], MICRO_G);
        let scale = shown(&result, &format!("accel.scale.{name}"), None);
        assert_found(scale, SHAPE[(axis, axis)], 1e-6);
    }
    // The rotations between them show the gyros.
    let scale = shown(&result, "gyro.scale.x", None);
    assert_eq!(scale["identifiable"], true, "{scale}");
    assert_found(scale, 0.0, 1e-6);
    let told = rins_in(folder.path(), "calibrate rig.toml").out;
    assert_eq!(told.matches("14 static intervals").count(), 1, "{told}");
    assert!(!told.contains("axis.attitude"), "{told}");
}

#[test]
fn two_logs_share_the_sensors_and_not_the_switching_on() {
    let folder = tempfile::tempdir().unwrap();
    turned_over(folder.path(), "may", BIASES[0], 9, 2);
    turned_over(folder.path(), "june", BIASES[1], 9, 3);
    let result = result_in(folder.path(), "calibrate may.toml june.toml -o out");
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        assert_found(
            shown(&result, &format!("accel.scale.{name}"), None),
            SHAPE[(axis, axis)],
            1e-6,
        );
        for (run, biases) in (1..).zip(BIASES) {
            let bias = shown(&result, &format!("accel.bias.{name}"), Some(run));
            assert_found(bias, biases[axis], MICRO_G);
        }
    }
    assert!(folder.path().join("out/calibration-2.toml").is_file());
}

/// Two attitudes give no more information than one.
#[test]
fn a_log_of_few_attitudes_is_calibrated_on_its_longest_rest() {
    let folder = tempfile::tempdir().unwrap();
    turned_over(folder.path(), "rig", BIASES[0], 1, 4);
    let result = result_in(folder.path(), "calibrate rig.toml");
    assert!(result["runs"][0]["static_intervals_used"].is_null(), "{result:#}");
    assert!(texts(&result, "/notes")[0].contains("longest static interval"), "{result:#}");
}

/// A consumer MEMS: gyro biases that change with the attitude are no reason to refuse the static intervals. Whether the effect is
/// estimated depends on its size alone: what is small is within the noise model.
#[test]
fn g_sensitive_gyros_refuse_no_tumble() {
    let folder = tempfile::tempdir().unwrap();
    let degrees = |by: f64| by.to_radians();
    for (seed, by) in (1..).zip([0.002, 0.01, 0.05, 0.2].map(degrees)) {
        g_sensitive(folder.path(), "rig", (BIASES[0], by), 13, seed);
        let result = result_in(folder.path(), "calibrate rig.toml");
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let bias = shown(&result, &format!("accel.bias.{name}"), None);
            assert_found(bias, BIASES[0][axis], MICRO_G);
            let scale = shown(&result, &format!("accel.scale.{name}"), None);
            assert_found(scale, SHAPE[(axis, axis)], 1e-6);
        }
        if result["model"] == "full with gyro_g_sensitivity" {
            let told = texts(&result, "/notes");
            assert!(
                told.iter().any(|note| note.contains("gyro biases differ between the attitudes"))
            );
            let found = shown(&result, "gyro_g_sensitivity.xy", None);
            assert_eq!(found["unit"], "deg/h/g");
            let truth = SENSITIVITY[(0, 1)] * by.to_degrees() * 3600.0;
            let off = (number(found, "/value") - truth) / number(found, "/sigma");
            assert!(off.abs() < 4.0, "{off} sigma: {found}");
        } else {
            assert!(by < degrees(0.03), "{} deg/s/g", by.to_degrees());
        }
    }
}
