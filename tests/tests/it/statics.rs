//! The static intervals of a log, in the search and use by every command.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use nalgebra::{Rotation3, Vector3};
use rins_imu::{Seed, Sensor};
use serde_json::Value;
use tempfile::TempDir;

use crate::support::{list, number, numbers, parameter, result_in, rins_in};

/// Gravity at the site of the logs \[m/s²\], as in the rig files.
const GRAVITY: f64 = 9.8;

const DEG: f64 = std::f64::consts::PI / 180.0;

/// The tolerance for the ends of an interval \[s\].
const WITHIN: f64 = 0.3;

/// The errors of the sensors of a log, with their data sheet.
struct Imu {
    /// The biases \[rad/s\], \[m/s²\].
    bias: [[f64; 3]; 2],
    /// The 1σ of a sample \[rad/s\], \[m/s²\].
    noise: [f64; 2],
    /// The bias of each gyro per specific force along it \[(rad/s)/(m/s²)\].
    g_sensitivity: f64,
    /// `[imu.gyro]` and `[imu.accel]`.
    sheet: &'static str,
}

/// A consumer MEMS IMU.
const MEMS: Imu = Imu {
    bias: [[-0.0009, -0.0017, 0.002], [0.007, 0.0, 0.36]],
    noise: [1.2e-3, 0.01],
    g_sensitivity: 0.0,
    sheet: "[imu.gyro]\nnoise = \"0.01 deg/s/sqrt(Hz)\"\nbias_sigma = \"0.3 deg/s\"\nscale_sigma = \"1 %\"\n\
            misalignment_sigma = \"1 deg\"\n\
            [imu.accel]\nnoise = \"150 ug/sqrt(Hz)\"\nbias_sigma = \"50 mg\"\nscale_sigma = \"3 %\"\n\
            misalignment_sigma = \"1 deg\"\n",
};

/// The same with an uncalibrated gyro.
const UNCALIBRATED: Imu = Imu {
    bias: [[2.0 * DEG, -1.2 * DEG, 0.4 * DEG], [0.007, 0.0, 0.36]],
    sheet: "[imu.gyro]\nnoise = \"0.01 deg/s/sqrt(Hz)\"\nbias_sigma = \"5 deg/s\"\nscale_sigma = \"3 %\"\n\
            misalignment_sigma = \"1 deg\"\n\
            [imu.accel]\nnoise = \"150 ug/sqrt(Hz)\"\nbias_sigma = \"50 mg\"\nscale_sigma = \"3 %\"\n\
            misalignment_sigma = \"1 deg\"\n",
    ..MEMS
};

const TACTICAL: Imu = Imu {
    bias: [[2e-5, -3e-5, 4e-5], [0.02, -0.01, 0.015]],
    noise: [4.1e-5, 1.4e-3],
    g_sensitivity: 0.0,
    sheet: "[imu.gyro]\nnoise = \"0.02 deg/sqrt(h)\"\nbias_sigma = \"10 deg/h\"\nscale_sigma = \"1000 ppm\"\n\
            misalignment_sigma = \"600 arcsec\"\n\
            [imu.accel]\nnoise = \"20 ug/sqrt(Hz)\"\nbias_sigma = \"3 mg\"\nscale_sigma = \"1000 ppm\"\n\
            misalignment_sigma = \"600 arcsec\"\n",
};

/// A rate of the body \[rad/s\] with its duration \[s\].
type Motion = (Vector3<f64>, f64);

fn still(seconds: f64) -> Motion {
    (Vector3::zeros(), seconds)
}

/// A rotation about x by `angle` and back, in `half` seconds each.
fn rocked(angle: f64, half: f64) -> [Motion; 2] {
    let rate = Vector3::x() * (angle / half);
    [(rate, half), (-rate, half)]
}

/// Static intervals of `seconds`, with a rotation of 1.5 s by hand between each two of them.
fn tumble(stops: usize, seconds: f64) -> Vec<Motion> {
    let mut motions = vec![still(seconds)];
    for stop in 1..stops {
        // Axes in general directions, so that all attitudes differ.
        let (one, other) = (1.9 * stop as f64, 0.8 * stop as f64);
        let axis = Vector3::new(one.cos(), one.sin(), other.sin()).normalize();
        motions.push((axis * (90.0 * DEG / 1.5), 1.5));
        motions.push(still(seconds));
    }
    motions
}

/// The static intervals among these motions \[s\].
fn stationary(motions: &[Motion]) -> Vec<[f64; 2]> {
    let mut time = 0.0;
    let mut spans = Vec::new();
    for (rate, seconds) in motions {
        if *rate == Vector3::zeros() {
            spans.push([time, time + seconds]);
        }
        time += seconds;
    }
    spans
}

/// A folder with a log of these motions at this sampling rate, from which `lost` samples are omitted, and its rig file.
fn log_of(
    imu: &Imu,
    hz: f64,
    motions: &[Motion],
    keys: &str,
    lost: impl Fn(u32) -> bool,
) -> TempDir {
    let interval = 1.0 / hz;
    let folder = tempfile::tempdir().unwrap();
    let mut deviates = Seed::new(7).stream(Sensor::Encoder);
    let mut noise = |sigma: f64| Vector3::from_fn(|_, _| sigma * deviates.sample());
    let mut body_from_start = Rotation3::<f64>::identity();
    let mut log = String::from("t,gx,gy,gz,ax,ay,az\n");
    let (mut sample, mut before) = (0_u32, 0.0);
    for (rate, seconds) in motions {
        before += seconds;
        while f64::from(sample + 1) * interval < before + 0.5 * interval {
            let half = Rotation3::new(-rate * (0.5 * interval));
            let force = half * body_from_start * Vector3::z() * GRAVITY;
            body_from_start = half * half * body_from_start;
            let gyro =
                rate + Vector3::from(imu.bias[0]) + force * imu.g_sensitivity + noise(imu.noise[0]);
            let accel = force + Vector3::from(imu.bias[1]) + noise(imu.noise[1]);
            sample += 1;
            if lost(sample) {
                continue;
            }
            write!(log, "{:.6}", f64::from(sample) * interval).unwrap();
            for number in gyro.iter().chain(&accel) {
                write!(log, ",{number:.9}").unwrap();
            }
            log.push('\n');
        }
    }
    fs::write(folder.path().join("run.csv"), log).unwrap();
    let rig = format!(
        "[site]\nlatitude = \"45 deg\"\nlongitude = \"11 deg\"\nheight = \"0 m\"\ngravity = \"9.8 m/s^2\"\n\
         [log]\npath = \"run.csv\"\ntime = {{ column = \"t\", unit = \"s\" }}\n\
         gyro = {{ columns = [\"gx\", \"gy\", \"gz\"], unit = \"rad/s\" }}\n\
         accel = {{ columns = [\"ax\", \"ay\", \"az\"], unit = \"m/s^2\" }}\n{keys}\n{}",
        imu.sheet
    );
    fs::write(folder.path().join("rig.toml"), rig).unwrap();
    folder
}

fn whole(imu: &Imu, hz: f64, motions: &[Motion]) -> TempDir {
    log_of(imu, hz, motions, "", |_| false)
}

/// The static intervals of a result that are used \[s\].
fn used(result: &Value) -> Vec<[f64; 2]> {
    list(result, "/static_intervals")
        .iter()
        .filter(|interval| interval["used"] == true)
        .map(|interval| [number(interval, "/start_s"), number(interval, "/end_s")])
        .collect()
}

fn assert_spans(found: &[[f64; 2]], truth: &[[f64; 2]]) {
    let near = |(found, truth): (&[f64; 2], &[f64; 2])| {
        found.iter().zip(truth).all(|(found, truth)| (found - truth).abs() <= WITHIN)
    };
    let agree = found.len() == truth.len() && found.iter().zip(truth).all(near);
    assert!(agree, "{found:?} where {truth:?} are static");
}

/// Whether a span is within one of these.
fn within(span: &[f64], truth: &[[f64; 2]]) -> bool {
    truth.iter().any(|[start, end]| span[0] >= start - WITHIN && span[1] <= end + WITHIN)
}

fn check(folder: &Path) -> Value {
    result_in(folder, "check rig.toml")
}

/// A rotation and its reversal have a total angle of zero, but are not static.
#[test]
fn what_is_rocked_there_and_back_is_motion_to_every_command() {
    for half in [1.0, 2.0, 4.0, 8.0] {
        let [there, back] = rocked(86.0 * DEG, half);
        let motions = [still(10.0), there, back, still(10.5)];
        let truth = stationary(&motions);
        let folder = whole(&MEMS, 50.0, &motions);
        let checked = check(folder.path());
        assert_spans(&used(&checked), &truth);
        let aligned = result_in(folder.path(), "align rig.toml");
        assert!(
            within(&numbers(&aligned, "/static_interval_s"), &truth[1..]),
            "{half} s: {aligned:#}"
        );
        let allan = result_in(folder.path(), "allan rig.toml");
        assert!(within(&numbers(&allan, "/static_interval_s"), &truth), "{half} s: {allan:#}");
        let calibrated = rins_in(folder.path(), "calibrate rig.toml --json");
        let calibrated: Value = serde_json::from_str(&calibrated.out).unwrap();
        assert!(used(&calibrated).iter().all(|span| within(span, &truth)), "{half} s");
        let diagnosed = rins_in(folder.path(), "diagnose rig.toml --json");
        assert!(!diagnosed.err.contains("panicked"), "{}", diagnosed.err);
    }
}

/// A bias within the data sheet is not motion; the mean rate is removed.
#[test]
fn a_bias_within_the_data_sheet_is_no_motion() {
    for (hz, stops, seconds) in [(50.0, 7, 6.0), (100.0, 22, 3.0)] {
        let motions = tumble(stops, seconds);
        let folder = whole(&UNCALIBRATED, hz, &motions);
        assert_spans(&used(&check(folder.path())), &stationary(&motions));
        let result = result_in(folder.path(), "calibrate rig.toml");
        assert_spans(&used(&result), &stationary(&motions));
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let bias = parameter(&result, &format!("gyro.bias.{name}"));
            let truth = UNCALIBRATED.bias[0][axis] / DEG * 3600.0;
            let (value, sigma) = (number(bias, "/value"), number(bias, "/sigma"));
            // The Earth rate is known except for the azimuth.
            assert!((value - truth).abs() < 4.0 * sigma + 15.05, "{bias}, not {truth}");
        }
    }
}

/// A rate about the vertical that exceeds any bias is a rotation, and the result states it.
#[test]
fn a_constant_turn_about_the_vertical_is_no_bias() {
    let turn = Vector3::z() * (3.0 * DEG);
    let folder = whole(&MEMS, 50.0, &[still(20.0), (turn, 30.0), still(15.0)]);
    let checked = check(folder.path());
    assert_spans(&used(&checked), &[[0.0, 20.0], [50.0, 65.0]]);
    let unused: Vec<&Value> = list(&checked, "/static_intervals")
        .iter()
        .filter(|interval| interval["used"] == false)
        .collect();
    let [why] = unused.as_slice() else { panic!("{checked:#}") };
    assert!(why["why"].as_str().unwrap().contains("about the vertical"), "{why}");
}

#[test]
fn gyros_that_depend_on_specific_force_do_not_hide_static_intervals() {
    let imu = Imu { g_sensitivity: 0.1 * DEG / GRAVITY, ..MEMS };
    let motions = tumble(9, 4.0);
    let folder = whole(&imu, 50.0, &motions);
    assert_spans(&used(&check(folder.path())), &stationary(&motions));
}

#[test]
fn a_tumble_at_20_hz_with_3_s_in_each_attitude_is_calibrated() {
    calibrates(&Imu { noise: [8e-4, 7e-3], ..MEMS }, 20.0, 12, 3.0);
}

#[test]
fn a_tactical_tumble_with_8_s_in_each_attitude_is_calibrated() {
    calibrates(&TACTICAL, 50.0, 9, 8.0);
}

#[test]
fn tumbles_with_2_s_in_each_attitude_are_calibrated_at_any_rate() {
    calibrates(&MEMS, 10.0, 12, 2.5);
    calibrates(&MEMS, 500.0, 9, 2.0);
}

fn calibrates(imu: &Imu, hz: f64, stops: usize, seconds: f64) {
    let motions = tumble(stops, seconds);
    let folder = whole(imu, hz, &motions);
    let result = result_in(folder.path(), "calibrate rig.toml");
    assert_spans(&used(&result), &stationary(&motions));
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let bias = parameter(&result, &format!("accel.bias.{name}"));
        let truth = imu.bias[1][axis] / 9.80665e-6;
        let (value, sigma) = (number(bias, "/value"), number(bias, "/sigma"));
        assert!((value - truth).abs() < 4.0 * sigma, "{hz} Hz: {bias}, not {truth}");
    }
}

/// One lost sample per minute has almost no effect: the whole log is used, and the filled-in samples do not change the noise.
#[test]
fn the_noise_of_a_log_that_loses_single_samples_is_that_of_all_of_it() {
    let motions = [still(1200.0)];
    let folder = log_of(&MEMS, 10.0, &motions, "", |sample| sample % 600 == 300);
    let result = result_in(folder.path(), "allan rig.toml");
    assert_spans(
        &[[number(&result, "/static_interval_s/0"), number(&result, "/static_interval_s/1")]],
        &[[0.0, 1200.0]],
    );
    assert_eq!(result["lost_samples"], 20);
    let complete = whole(&MEMS, 10.0, &motions);
    let complete = result_in(complete.path(), "allan rig.toml");
    for (with, without) in list(&result, "/channels").iter().zip(list(&complete, "/channels")) {
        let (with, without) = (numbers(with, "/deviation"), numbers(without, "/deviation"));
        assert!((with[0] / without[0] - 1.0).abs() < 0.01, "{} for {}", with[0], without[0]);
    }
    let text = rins_in(folder.path(), "allan rig.toml").out;
    assert!(text.contains("20 lost samples"), "{text}");
}

/// If too many samples are lost, only a part is used, and the result states which.
#[test]
fn the_noise_of_a_log_that_loses_much_says_what_was_left_out() {
    let lost = |sample: u32| sample < 3000 && sample % 10 == 5;
    let folder = log_of(&MEMS, 10.0, &[still(600.0)], "", lost);
    let text = rins_in(folder.path(), "allan rig.toml").out;
    assert!(text.contains("of 600 s only 300 s are used"), "{text}");
}

#[test]
fn stated_static_intervals_take_the_place_of_a_search() {
    let turn = Vector3::z() * (30.0 * DEG);
    let motions = [still(30.0), (turn, 6.0), still(40.0)];
    let keys = "static = [[\"5 s\", \"25 s\"], [40, 70]]";
    let folder = log_of(&MEMS, 50.0, &motions, keys, |_| false);
    for command in ["check", "align", "allan"] {
        let result = result_in(folder.path(), &format!("{command} rig.toml"));
        let stated: Vec<[f64; 2]> = list(&result, "/static_intervals")
            .iter()
            .map(|interval| [number(interval, "/start_s"), number(interval, "/end_s")])
            .collect();
        assert_spans(&stated, &[[5.0, 25.0], [40.0, 70.0]]);
    }
    // A statement that the data contradict is used, and the contradiction is reported.
    let folder = log_of(&MEMS, 50.0, &motions, "static = [[\"20 s\", \"40 s\"]]", |_| false);
    let checked = check(folder.path());
    let [stated] = list(&checked, "/static_intervals") else { panic!("{checked:#}") };
    assert_eq!(stated["used"], true);
    assert!(stated["why"].as_str().unwrap().contains("stated as static, but it moves"), "{stated}");
}

#[test]
fn a_window_limits_what_is_read_of_a_log() {
    let turn = Vector3::x() * (30.0 * DEG);
    let motions = [still(30.0), (turn, 3.0), still(40.0)];
    let folder = log_of(&MEMS, 50.0, &motions, "window = [\"31 s\", \"60 s\"]", |_| false);
    let checked = check(folder.path());
    assert_spans(&used(&checked), &[[33.0, 60.0]]);
    assert_eq!(checked["samples"], 29 * 50);
}

#[test]
fn times_that_cannot_be_meant_are_refused_with_what_is_expected() {
    let bad = [
        ("static = [[\"40 s\", \"10 s\"]]", "static"),
        ("static = []", "static"),
        ("static = [[\"10 s\"]]", "static"),
        ("static = \"all\"", "static"),
        ("static = [[\"1 s\", \"9 s\"], [\"8 s\", \"12 s\"]]", "static"),
        ("static = [[\"100 s\", \"120 s\"]]", "static"),
        ("window = [\"10 m\", \"40 s\"]", "window"),
        ("window = [\"10 s\"]", "window"),
        ("window = [nan, 7]", "window"),
        ("window = [\"900 s\", \"1000 s\"]", "window"),
    ];
    for (line, key) in bad {
        let folder = log_of(&MEMS, 50.0, &[still(20.0)], line, |_| false);
        let finished = rins_in(folder.path(), "check rig.toml");
        assert_eq!(finished.code, Some(1), "{line}: {}", finished.err);
        assert!(finished.err.contains(key), "{line}: {}", finished.err);
        assert!(!finished.err.contains("panicked"), "{line}: {}", finished.err);
    }
}
