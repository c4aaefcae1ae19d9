//! An unobservable quantity is neither reported as a value nor compensated.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::support::{number, parameter, result_in, rins_in, texts};

/// Calibrations of a consumer IMU: table rate \[deg/s\], sampling rate \[Hz\], tilt of the axis \[deg\] and seed.
const RUNS: [(f64, f64, f64, u32); 4] =
    [(60.0, 100.0, 25.0, 41), (25.0, 50.0, 0.0, 7), (120.0, 200.0, 60.0, 3), (40.0, 20.0, 8.0, 19)];

/// The gyro parameters that are unobservable in any rotation about z.
const UNOBSERVABLE: [&str; 6] = [
    "gyro.scale.x",
    "gyro.scale.y",
    "gyro.misalignment.xy",
    "gyro.misalignment.yx",
    "gyro.misalignment.zx",
    "gyro.misalignment.zy",
];

/// Biases of the gyros \[deg/s\].
const BIAS: [f64; 3] = [0.02, -0.03, 0.04];

fn simulated(folder: &Path, (rate, hz, tilt, seed): (f64, f64, f64, u32)) {
    let bias = BIAS.map(|bias| format!("\"{bias} deg/s\"")).join(", ");
    let scenario = format!(
        r#"[site]
latitude = "52 deg"
longitude = "0 deg"
height = "0 m"
[log]
rate = "{hz} Hz"
table_angle = {{ noise = "5 arcsec" }}
[table]
acceleration = "30 deg/s^2"
profile = [
    {{ rate = "0 deg/s", duration = "20 s" }},
    {{ rate = "{rate} deg/s", duration = "60 s" }},
    {{ rate = "-{rate} deg/s", duration = "60 s" }},
]
[attitude]
roll = "0 deg"
pitch = "{tilt} deg"
yaw = "0 deg"
sigma = "0.2 deg"
[imu.gyro]
noise = "0.01 deg/s/sqrt(Hz)"
bias_sigma = "1 deg/s"
scale_sigma = "3 %"
misalignment_sigma = "1 deg"
[imu.accel]
noise = "150 ug/sqrt(Hz)"
bias_sigma = "50 mg"
scale_sigma = "1 %"
misalignment_sigma = "1 deg"
[truth]
seed = {seed}
gyro = {{ bias = [{bias}], scale = ["0 ppm", "0 ppm", "5000 ppm"], misalignment = {{ xz = "620 arcsec", yz = "-412 arcsec" }} }}
accel = {{ bias = ["1 mg", "-0.5 mg", "2 mg"], scale = ["0 ppm", "0 ppm", "0 ppm"] }}
"#
    );
    fs::write(folder.join("scenario.toml"), scenario).unwrap();
    result_in(folder, "simulate scenario.toml -o run");
}

/// A log of the same IMU that is rotated by hand about y at this rate \[deg/s\]; its only errors about y are biases.
fn turned_about_y(folder: &Path, rate: f64) {
    let mut log = "time,gyro_x,gyro_y,gyro_z,accel_x,accel_y,accel_z\n".to_owned();
    for sample in 1_u32..=500 {
        let time = 0.01 * f64::from(sample);
        let [x, y, z] = [BIAS[0], rate + BIAS[1], BIAS[2]];
        // Repeated readings would be those of a stuck channel.
        let last = f64::from(sample % 7) * 1e-5;
        let [x, y, z, up] = [x + last, y + last, z - last, 9.8 - last];
        writeln!(log, "{time:.2},{x},{y},{z},{last},{last},{up}").unwrap();
    }
    fs::write(folder.join("about_y.csv"), log).unwrap();
    let rig = r#"[site]
latitude = "52 deg"
longitude = "0 deg"
height = "0 m"
[log]
path = "about_y.csv"
time = { column = "time", unit = "s" }
gyro = { columns = ["gyro_x", "gyro_y", "gyro_z"], unit = "deg/s" }
accel = { columns = ["accel_x", "accel_y", "accel_z"], unit = "m/s^2" }
"#;
    fs::write(folder.join("about_y.toml"), rig).unwrap();
}

/// The mean of a column of a log with a header.
fn mean(log: &str, column: &str) -> f64 {
    let mut lines = log.lines();
    let place = lines.next().unwrap().split(',').position(|name| name == column).unwrap();
    let values: Vec<f64> =
        lines.map(|line| line.split(',').nth(place).unwrap().parse().unwrap()).collect();
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn what_a_turn_about_z_does_not_show_is_not_compensated() {
    for given in RUNS {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        simulated(folder, given);
        let result = result_in(folder, "calibrate run/rig.toml --model full -o cal");
        let hidden = texts(&result, "/identifiability/unobservable");
        let file = fs::read_to_string(folder.join("cal/calibration.toml")).unwrap();
        let (_, gyro) = file.split_once("[gyro]").unwrap();
        let (gyro, _) = gyro.split_once("[accel]").unwrap();
        assert!(gyro.contains("scale = [\"0 ppm\", \"0 ppm\", \""), "{given:?}: {gyro}");
        for id in UNOBSERVABLE {
            assert!(hidden.contains(&id), "{given:?}: {id} not in {hidden:?}");
            let parameter = parameter(&result, id);
            assert_eq!(parameter["observability"], "prior_dominated", "{given:?}");
            assert_eq!(parameter["value"], 0.0, "{given:?}: {parameter}");
            let (sigma, prior) = (number(parameter, "/sigma"), number(parameter, "/prior_sigma"));
            assert!((sigma / prior - 1.0).abs() < 1e-9, "{given:?}: {parameter}");
            if let Some(axes) = id.strip_prefix("gyro.misalignment.") {
                assert!(gyro.contains(&format!("{axes} = \"0 arcsec\"")), "{given:?}: {gyro}");
            }
        }
        let scale = parameter(&result, "gyro.scale.z");
        assert_eq!(scale["observability"], "observable", "{given:?}");
        turned_about_y(folder, 100.0);
        rins_in(folder, "apply about_y.toml --calibration cal/calibration.toml -o clean.csv");
        let clean = fs::read_to_string(folder.join("clean.csv")).unwrap();
        // It contains increments, in rad per sample.
        let rate = mean(&clean, "gyro_y").to_degrees() / 0.01;
        let bias = number(parameter(&result, "gyro.bias.y"), "/sigma") / 3600.0;
        assert!((rate - 100.0).abs() < 5.0 * bias, "{given:?}: {rate} deg/s, bias known to {bias}");
    }
}

#[test]
fn value_of_a_combination_stands_with_the_combination() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulated(folder, RUNS[0]);
    let text = rins_in(folder, "calibrate run/rig.toml --model full");
    let row = text.out.lines().find(|line| line.trim_start().starts_with("accel.scale.z")).unwrap();
    let words: Vec<&str> = row.split_whitespace().collect();
    let own: f64 = words[1].parse().unwrap();
    // Its own value, which the prior keeps at a few percent, whatever the combination is.
    assert!(own.abs() < 3e4, "{row}");
    assert!(row.contains("observable only in the combination accel.scale.z"), "{row}");
    assert!(row.contains(" ± ") && row.contains(" ppm (1σ)"), "{row}");
    let calibration = rins_in(folder, "calibrate run/rig.toml --model full -o cal");
    assert_eq!(calibration.code, Some(0), "{}", calibration.err);
    let file = fs::read_to_string(folder.join("cal/calibration.toml")).unwrap();
    let motion = "under the motion that was calibrated and under no other: table rates of 60";
    assert!(file.contains(motion), "{file}");
}
