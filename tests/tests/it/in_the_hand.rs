//! Logs of people without a table: some sensors only, one file for each position, turns by a mark, no data sheet.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use nalgebra::{Rotation3, Vector3};
use rins_imu::{Seed, Sensor};

use crate::support::{assert_found, list, number, parameter, result_in, rins_in, texts};

const DEG: f64 = std::f64::consts::PI / 180.0;
const GRAVITY: f64 = 9.8;

/// Errors of the sensors in SI units.
#[derive(Clone, Copy)]
struct Errors {
    gyro_bias: [f64; 3],
    gyro_scale: [f64; 3],
    accel_bias: [f64; 3],
    accel_scale: [f64; 3],
}

const ERRORS: Errors = Errors {
    gyro_bias: [0.004, -0.006, 0.003],
    gyro_scale: [0.008, -0.012, -0.0194],
    accel_bias: [0.05, -0.08, 0.12],
    accel_scale: [0.002, -0.003, 0.001],
};

/// A rate of the body \[rad/s\] for a time \[s\].
type Motion = ([f64; 3], f64);

/// The rows of a log at 50 Hz: time, rates \[rad/s\], specific forces \[m/s²\], and the table angle if the rate is about z only.
struct Rows {
    rows: Vec<(f64, [f64; 6], f64, bool)>,
}

impl Rows {
    /// Of motions from an attitude, in which `up` points up, and with times from `start` on.
    fn of(errors: &Errors, (start, up): (f64, [f64; 3]), motions: &[Motion], seed: u64) -> Self {
        const INTERVAL: f64 = 0.02;
        let mut deviates = Seed::new(seed).stream(Sensor::Encoder);
        let mut up = Vector3::from(up).normalize();
        let (mut rows, mut count, mut angle) = (Vec::new(), 0_u32, 0.0);
        for (rate, lasting) in motions {
            let rate = Vector3::from(*rate);
            let mut left = (lasting / INTERVAL).round();
            while left > 0.5 {
                left -= 1.0;
                count += 1;
                let half = Rotation3::new(-rate * (0.5 * INTERVAL));
                let force = half * up * GRAVITY;
                up = half * half * up;
                angle += rate.z * INTERVAL;
                let read = |truth: Vector3<f64>, bias: [f64; 3], scale: [f64; 3]| {
                    [0, 1, 2].map(|axis| truth[axis] * (1.0 + scale[axis]) + bias[axis])
                };
                let gyro = read(rate, errors.gyro_bias, errors.gyro_scale);
                let accel = read(force, errors.accel_bias, errors.accel_scale);
                let noise = [1e-3, 1e-3, 1e-3, 5e-3, 5e-3, 5e-3];
                let mut row = [0.0; 6];
                for (place, value) in gyro.iter().chain(&accel).enumerate() {
                    row[place] = value + noise[place] * deviates.sample();
                }
                rows.push((start + INTERVAL * f64::from(count), row, angle, rate.norm() == 0.0));
            }
        }
        Self { rows }
    }

    /// Writes the log, with the angle \[deg\] where the table is at rest.
    fn write(&self, path: &Path) {
        let mut text = String::from("t,gx,gy,gz,ax,ay,az,angle\n");
        for (time, row, angle, at_rest) in &self.rows {
            write!(text, "{time:.2}").unwrap();
            for value in row {
                write!(text, ",{value:.7}").unwrap();
            }
            let angle = if *at_rest { format!("{:.3}", angle / DEG) } else { String::new() };
            writeln!(text, ",{angle}").unwrap();
        }
        fs::write(path, text).unwrap();
    }
}

const SHEET: &str = "[imu.gyro]\nnoise = \"0.01 deg/s/sqrt(Hz)\"\nbias_sigma = \"0.5 deg/s\"\nscale_sigma = \"3 %\"\n\
                     misalignment_sigma = \"0.2 deg\"\n\
                     [imu.accel]\nnoise = \"100 ug/sqrt(Hz)\"\nbias_sigma = \"20 mg\"\nscale_sigma = \"1 %\"\n\
                     misalignment_sigma = \"0.2 deg\"\n";

fn rig(log: &str, columns: &str, rest: &str) -> String {
    format!(
        "[site]\nlatitude = \"45 deg\"\ngravity = \"9.8 m/s^2\"\n[log]\npath = \"{log}\"\n\
         time = {{ column = \"t\", unit = \"s\" }}\n{columns}\n{rest}"
    )
}

const BOTH: &str = "gyro = { columns = [\"gx\", \"gy\", \"gz\"], unit = \"rad/s\" }\n\
                    accel = { columns = [\"ax\", \"ay\", \"az\"], unit = \"m/s^2\" }";

#[test]
fn noise_of_some_sensors_is_that_of_all_six() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    Rows::of(&ERRORS, (0.0, [0.1, 0.2, 1.0]), &[([0.0; 3], 120.0)], 1)
        .write(&folder.join("run.csv"));
    let cases = [
        ("all", BOTH, vec!["gyro.x", "gyro.y", "gyro.z", "accel.x", "accel.y", "accel.z"]),
        (
            "one",
            "gyro = { columns = [\"gy\"], unit = \"rad/s\", axes = [\"y\", \"x\", \"z\"] }",
            vec!["gyro.y"],
        ),
        (
            "two",
            "accel = { columns = [\"ax\", \"ay\"], unit = \"m/s^2\" }",
            vec!["accel.x", "accel.y"],
        ),
        (
            "three",
            "gyro = { columns = [\"gx\", \"gy\", \"gz\"], unit = \"rad/s\" }",
            vec!["gyro.x", "gyro.y", "gyro.z"],
        ),
    ];
    let white = |name: &str, channel: &str| {
        let result = result_in(folder, &format!("allan {name}.toml"));
        let of =
            list(&result, "/channels").iter().find(|of| of["channel"] == channel).unwrap().clone();
        number(list(&of, "/terms").iter().find(|term| term["symbol"] == "N").unwrap(), "/value")
    };
    for (name, columns, channels) in &cases {
        fs::write(folder.join(format!("{name}.toml")), rig("run.csv", columns, "")).unwrap();
        let result = result_in(folder, &format!("allan {name}.toml"));
        let found: Vec<&str> =
            list(&result, "/channels").iter().map(|of| of["channel"].as_str().unwrap()).collect();
        assert_eq!(found, *channels);
        for channel in channels {
            assert!(
                (white(name, channel) / white("all", channel) - 1.0).abs() < 1e-9,
                "{name} {channel}"
            );
        }
    }
    for command in ["check one.toml", "calibrate one.toml", "align one.toml", "navigate one.toml"] {
        let refused = rins_in(folder, command);
        assert_eq!(refused.code, Some(1), "{command}");
        assert!(refused.err.contains("[log] accel: missing"), "{command}: {}", refused.err);
    }
}

/// Up in each of the six positions.
const SIX: [[f64; 3]; 6] = [
    [1.0, 0.02, -0.01],
    [-1.0, 0.01, 0.03],
    [0.03, 1.0, 0.02],
    [-0.02, -1.0, 0.01],
    [0.01, -0.03, 1.0],
    [0.02, 0.01, -1.0],
];

#[test]
fn files_of_one_power_on_are_one_six_position_test() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut names = String::new();
    for (place, up) in SIX.into_iter().enumerate() {
        let start = 600.0 * place as f64;
        let seed = 10 + place as u64;
        Rows::of(&ERRORS, (start, up), &[([0.0; 3], 30.0)], seed)
            .write(&folder.join(format!("{place}.csv")));
        for (kind, series) in [("apart", ""), ("together", "[run]\nseries = \"a\"\n")] {
            let text = rig(&format!("{place}.csv"), BOTH, &format!("{series}{SHEET}"));
            fs::write(folder.join(format!("{kind}{place}.toml")), text).unwrap();
        }
        write!(names, " KIND{place}.toml").unwrap();
    }
    let calibrated =
        |kind: &str| result_in(folder, &format!("calibrate{}", names.replace("KIND", kind)));
    let together = calibrated("together");
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        for (id, truth) in [
            (format!("accel.bias.{name}"), ERRORS.accel_bias[axis] / 9.80665e-6),
            (format!("accel.scale.{name}"), ERRORS.accel_scale[axis] * 1e6),
        ] {
            let found = parameter(&together, &id);
            let of = if found["marginal"].is_object() { &found["marginal"] } else { found };
            let (value, sigma) = (number(of, "/value"), number(of, "/sigma"));
            assert!((value - truth).abs() < 4.0 * sigma && sigma < 150.0, "{id}: {truth}, {found}");
        }
    }
    let apart = calibrated("apart");
    assert!(list(&apart, "/parameters").len() > list(&together, "/parameters").len() + 15);
    let notes = texts(&apart, "/notes").join(" ");
    assert!(notes.contains("[run] series"), "{notes}");
}

#[test]
fn turns_by_a_mark_show_the_scale_of_the_gyro() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let still = ([0.0; 3], 8.0);
    let turn = |rate: f64| ([0.0, 0.0, rate * DEG], 6.0);
    let motions = [still, turn(120.0), still, turn(-120.0), still];
    Rows::of(&ERRORS, (0.0, [0.0, 0.0, 1.0]), &motions, 3).write(&folder.join("run.csv"));
    let profile = "[table]\nangle_sigma = \"0.2 deg\"\nprofile = [{ rate = \"0 deg/s\", duration = \"8.5 s\" }, \
                   { angle = \"720 deg\", duration = \"5 s\" }, { angle = \"0 deg\", duration = \"8 s\" }, \
                   { angle = \"-720 deg\", duration = \"6 s\" }, { rate = \"0 deg/s\", duration = \"9 s\" }]\n";
    let readings = format!(
        "{BOTH}\ntable_angle = {{ column = \"angle\", unit = \"deg\", noise = \"0.2 deg\" }}"
    );
    let cases = [("profile", BOTH, profile), ("readings", &readings, "")];
    let accurate = SHEET.replace("20 mg", "1 mg");
    for (name, columns, table) in cases {
        fs::write(folder.join("rig.toml"), rig("run.csv", columns, &format!("{table}{accurate}")))
            .unwrap();
        let result = result_in(folder, "calibrate rig.toml");
        let scale = parameter(&result, "gyro.scale.z");
        assert_found(&result, "gyro.scale.z", ERRORS.gyro_scale[2] * 1e6);
        assert!(number(scale, "/sigma") < 600.0, "{name}: {scale}");
        assert_eq!(
            parameter(&result, "gyro.scale.x")["observability"],
            "prior_dominated",
            "{name}"
        );
    }
    for (broken, told) in [
        (
            profile.replace("{ angle = \"0 deg\"", "{ rate = \"5 deg/s\", angle = \"0 deg\""),
            "a rate is stated too",
        ),
        (profile.replace("{ angle = \"0 deg\"", "{ rate = \"5 deg/s\""), "whose rate is zero"),
        (profile.replace("{ angle = \"0 deg\", ", "{ "), "an angle such as"),
    ] {
        fs::write(folder.join("rig.toml"), rig("run.csv", BOTH, &broken)).unwrap();
        let refused = rins_in(folder, "calibrate rig.toml");
        assert!(refused.code == Some(1) && refused.err.contains(told), "{}", refused.err);
    }
}

#[test]
fn a_log_without_a_data_sheet_is_calibrated_with_that_of_a_grade() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let still = ([0.0; 3], 6.0);
    let mut motions = vec![still];
    for stop in 0..14_u32 {
        let (one, other) = (1.9 * f64::from(stop), 0.8 * f64::from(stop));
        let axis =
            Vector3::new(one.cos(), one.sin(), other.sin()).normalize() * (100.0 * DEG / 1.5);
        motions.push(([axis.x, axis.y, axis.z], 1.5));
        motions.push(still);
    }
    Rows::of(&ERRORS, (0.0, [0.1, 0.2, 1.0]), &motions, 5).write(&folder.join("run.csv"));
    let cases = [
        ("", "the grade mems-consumer is assumed"),
        ("[imu]\ngrade = \"MEMS-consumer\"\n", "are those of mems-consumer"),
        (
            "[imu]\nsensor = \"mpu-9250\"\n[imu.gyro]\nnoise = \"0.007 deg/s/sqrt(Hz)\"\n",
            "are those of MPU-9250",
        ),
    ];
    for (imu, told) in cases {
        fs::write(folder.join("rig.toml"), rig("run.csv", BOTH, imu)).unwrap();
        let result = result_in(folder, "calibrate rig.toml");
        let notes = texts(&result, "/notes").join(" ");
        assert!(notes.contains(told), "{notes}");
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            assert_found(&result, &format!("gyro.scale.{name}"), ERRORS.gyro_scale[axis] * 1e6);
            assert_found(&result, &format!("accel.scale.{name}"), ERRORS.accel_scale[axis] * 1e6);
            assert_found(
                &result,
                &format!("accel.bias.{name}"),
                ERRORS.accel_bias[axis] / 9.80665e-6,
            );
            let scale = parameter(&result, &format!("gyro.scale.{name}"));
            assert!(scale["identifiable"] == true && number(scale, "/sigma") < 1500.0, "{scale}");
        }
    }
    for (imu, told) in [
        ("[imu]\ngrade = \"best\"\n", "\"mems-tactical\""),
        ("[imu]\ngrade = \"fog\"\nsensor = \"STIM300\"\n", "a sensor is stated too"),
        ("[imu]\nsensor = \"fog\"\n", "\"STIM300\""),
    ] {
        fs::write(folder.join("rig.toml"), rig("run.csv", BOTH, imu)).unwrap();
        let refused = rins_in(folder, "calibrate rig.toml");
        assert!(refused.code == Some(1) && refused.err.contains(told), "{}", refused.err);
    }
}
