//! An IMU on a wheel with unknown heading: static interval, rotation in both directions, static interval.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use nalgebra::{Rotation3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rins_frames::{EulerAngles, Nav, Table};
use rins_imu::{Seed, Sensor};
use serde_json::Value;

use crate::support::{number, parameter, result_in};

/// Gravity at the site \[m/s²\], as in the rig file.
const GRAVITY: f64 = 9.8;

/// The Earth rate \[rad/s\].
const EARTH_RATE: f64 = 7.292115e-5;

/// The sampling rate; the next constants are the numbers of samples of a static interval, of a change of rate, and of a constant
/// rate.
const RATE: f64 = 100.0;
const STEPS: [u32; 3] = [800, 100, 3000];

/// A reading is the mean of so many instants.
const PARTS: u32 = 4;

/// White noise of a gyro \[rad/s/√Hz\] and of an accelerometer \[m/s²/√Hz\].
const NOISE: [f64; 2] = [8e-5, 9e-3];

/// The truth of a log.
struct Truth {
    /// The gyro biases \[rad/s\].
    gyro_bias: Vector3<f64>,
    scale: f64,
    /// The horizontal Earth rate \[rad/s\].
    horizontal: f64,
    /// The angle from east to the direction in which the axis is tilted \[rad\].
    leans_to: f64,
}

/// A log and a rig file without `[attitude]`, of a wheel of this radius that rolls \[m\], or of one off the ground, whose axis is tilted by
/// 20 to 90 deg in any direction.
fn wheel(folder: &Path, seed: u64, radius: f64) -> Truth {
    let mut rng = Pcg64::seed_from_u64(seed);
    let latitude = rng.random_range(-60.0_f64..60.0);
    let (azimuth, tilt) = (rng.random_range(0.0..TAU), rng.random_range(0.35..TAU / 4.0));
    let nav_from_table = Rotation3::from_axis_angle(&Vector3::z_axis(), azimuth)
        * Rotation3::from_axis_angle(&Vector3::x_axis(), tilt);
    let horizontal = EARTH_RATE * latitude.to_radians().cos();
    let earth = Vector3::new(0.0, horizontal, EARTH_RATE * latitude.to_radians().sin());
    let (earth, up) = (nav_from_table.inverse() * earth, nav_from_table.inverse() * Vector3::z());

    let gyro_bias = Vector3::from_fn(|_, _| rng.random_range(-3e-3..3e-3));
    let accel_bias = Vector3::from_fn(|_, _| rng.random_range(-0.1..0.1));
    let (scale, speed) = (rng.random_range(-5e-3..5e-3), rng.random_range(2.0..12.0));
    let mut deviates = Seed::new(seed).stream(Sensor::Encoder);
    let mut noise =
        |density: f64| Vector3::from_fn(|_, _| density * RATE.sqrt() * deviates.sample());
    let (mut turned, mut samples) = (rng.random_range(0.0..TAU), 0_u32);
    let mut log = String::from("t,gx,gy,gz,ax,ay,az\n");
    let [rest, change, lasting] = STEPS;
    let rates = [
        (0.0, 0.0, rest),
        (0.0, speed, change),
        (speed, speed, lasting),
        (speed, -speed, 2 * change),
    ];
    let back = [(-speed, -speed, lasting), (-speed, 0.0, change), (0.0, 0.0, rest)];
    for (from, to, steps) in rates.into_iter().chain(back) {
        let acceleration = RATE * (to - from) / f64::from(steps);
        let force = up * GRAVITY + Vector3::z().cross(&up) * (radius * acceleration);
        for step in 0..steps {
            let (mut gyro, mut accel) = (Vector3::zeros(), Vector3::zeros());
            // A reading is the mean over its interval.
            for part in 0..PARTS {
                let within = f64::from(step) + (f64::from(part) + 0.5) / f64::from(PARTS);
                let rate = from + (to - from) * within / f64::from(steps);
                let turn = rate / RATE / f64::from(PARTS);
                let table_from_body =
                    Rotation3::from_axis_angle(&Vector3::z_axis(), turned + 0.5 * turn);
                turned += turn;
                let body =
                    |vector: &Vector3<f64>| table_from_body.inverse() * vector / f64::from(PARTS);
                gyro += body(&earth) + Vector3::z() * rate / f64::from(PARTS);
                accel += body(&force);
            }
            gyro.z *= 1.0 + scale;
            gyro += gyro_bias + noise(NOISE[0]);
            accel += accel_bias + noise(NOISE[1]);
            samples += 1;
            write!(log, "{:.2}", f64::from(samples) / RATE).unwrap();
            for reading in gyro.iter().chain(accel.iter()) {
                write!(log, ",{reading:.9}").unwrap();
            }
            log.push('\n');
        }
    }
    fs::write(folder.join("rig.csv"), log).unwrap();
    let rig = format!(
        "[site]\nlatitude = \"{latitude} deg\"\nlongitude = \"11 deg\"\nheight = \"0 m\"\ngravity = \"9.8 m/s^2\"\n\n\
         [log]\npath = \"rig.csv\"\ntime = {{ column = \"t\", unit = \"s\" }}\n\
         gyro = {{ columns = [\"gx\", \"gy\", \"gz\"], unit = \"rad/s\" }}\n\
         accel = {{ columns = [\"ax\", \"ay\", \"az\"], unit = \"m/s^2\" }}\n\n\
         [axis]\nspin = \"z\"\n\n\
         [imu.gyro]\nnoise = \"0.0046 deg/s/sqrt(Hz)\"\nbias_sigma = \"0.2 deg/s\"\nscale_sigma = \"1 %\"\n\
         misalignment_sigma = \"1 deg\"\n\n\
         [imu.accel]\nnoise = \"0.92 mg/sqrt(Hz)\"\nbias_sigma = \"20 mg\"\nscale_sigma = \"1 %\"\n\
         misalignment_sigma = \"1 deg\"\n"
    );
    fs::write(folder.join("rig.toml"), rig).unwrap();
    Truth { gyro_bias, scale, horizontal, leans_to: azimuth - TAU / 4.0 }
}

/// The error of a parameter, in its 1σ.
fn off(result: &Value, id: &str, truth: f64) -> f64 {
    let found = parameter(result, id);
    (number(found, "/value") - truth) / number(found, "/sigma")
}

#[test]
fn its_azimuth_is_a_parameter_and_its_rests_are_used() {
    let per_hour = 1.0_f64.to_radians() / 3600.0;
    let (mut square, mut count) = (0.0, 0.0);
    for seed in 0..12 {
        let folder = tempfile::tempdir().unwrap();
        let truth = wheel(folder.path(), seed, 0.0);
        let result = result_in(folder.path(), "calibrate rig.toml");
        assert_eq!(result["runs"][0]["static_intervals_used"], 2, "{seed}");
        // The horizontal rate relative to the assumed direction of the tilt.
        let angle = |name: &str| number(&result["runs"][0]["axis_attitude_deg"], name).to_radians();
        let [roll, pitch, yaw] = ["/roll", "/pitch", "/yaw"].map(angle);
        let assumed = EulerAngles { roll, pitch, yaw }.dcm::<Nav, Table>();
        let turned = assumed.matrix()[(1, 2)].atan2(assumed.matrix()[(0, 2)]) - truth.leans_to;
        let (north, east) =
            (truth.horizontal * (turned.cos() - 1.0), -truth.horizontal * turned.sin());
        for (id, true_value) in [
            ("gyro.scale.z", truth.scale * 1e6),
            ("gyro.bias.x", truth.gyro_bias.x / per_hour),
            ("gyro.bias.y", truth.gyro_bias.y / per_hour),
            ("gyro.bias.z", truth.gyro_bias.z / per_hour),
            ("gyro.misalignment.xz", 0.0),
            ("gyro.misalignment.yz", 0.0),
            ("axis.azimuth.north", north / per_hour),
            ("axis.azimuth.east", east / per_hour),
        ] {
            let off = off(&result, id, true_value);
            assert!(off.abs() < 4.0, "{seed}: {id} is off by {off} sigma");
            square += off * off;
            count += 1.0;
        }
    }
    // The mean of 96 squares, with correlation in groups of eight.
    let mean: f64 = square / count;
    assert!((0.5..1.7).contains(&mean), "{mean}");
}

/// An azimuth that was assumed to be zero was reported as a g-sensitivity of more than 10σ.
#[test]
fn its_azimuth_is_no_effect() {
    for seed in 20..24 {
        let folder = tempfile::tempdir().unwrap();
        wheel(folder.path(), seed, 0.0);
        let diagnosis = result_in(folder.path(), "diagnose rig.toml");
        assert_eq!(diagnosis["verdict"], "adequate", "{seed}: {}", diagnosis["causes"]);
    }
}

#[test]
fn rolling_on_the_ground_is_named_and_its_radius_found() {
    for (seed, radius) in [(30, 0.3), (31, -0.2), (32, 0.06)] {
        let folder = tempfile::tempdir().unwrap();
        wheel(folder.path(), seed, radius);
        let diagnosis = result_in(folder.path(), "diagnose rig.toml");
        let cause = &diagnosis["causes"][0];
        assert_eq!(cause["effect"], "base_rolling", "{seed}: {}", diagnosis["causes"]);
        let found = &cause["parameters"][0];
        let off = number(found, "/value") - 1000.0 * radius;
        // Gravity, by which the angle is known, is not its direction while the wheel accelerates.
        let allowed = 4.0 * number(found, "/sigma") + 20.0 * radius.abs();
        assert!(off.abs() < allowed && number(found, "/sigma") < 20.0, "{seed}: {found}");
    }
}
