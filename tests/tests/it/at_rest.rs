//! A static IMU: the observable quantities, and the assumptions.

use std::fs;

use rins_testing::{assert_close, site};
use tempfile::TempDir;

use crate::support::{list, number, numbers, result_in, rins_in};

/// Five minutes at rest; the bias of the gyro along up is a hundred times that of the data sheet, or zero.
fn rest(bias: &str) -> TempDir {
    let scenario = format!(
        concat!(
            site!(),
            r#"
[log]
rate = "50 Hz"

[table]
profile = [{{ rate = "0 deg/s", duration = "300 s" }}]

[attitude]
roll = "0 deg"
pitch = "0 deg"
yaw = "0 deg"
sigma = "0.05 deg"

[imu.gyro]
noise = "0.05 deg/h/sqrt(Hz)"
bias_sigma = "0.02 deg/h"
scale_sigma = "10 ppm"
misalignment_sigma = "20 arcsec"

[imu.accel]
noise = "20 ug/sqrt(Hz)"
bias_sigma = "100 ug"
scale_sigma = "100 ppm"
misalignment_sigma = "20 arcsec"

[truth]
seed = 7
gyro = {{ bias = ["0 deg/h", "0 deg/h", "{bias}"] }}
"#
        ),
        bias = bias
    );
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scenario.toml"), scenario).unwrap();
    let made = rins_in(folder.path(), "simulate scenario.toml -o run");
    assert_eq!(made.code, Some(0), "{}", made.err);
    // A rig without an attitude.
    let rig = folder.path().join("run/rig.toml");
    let text = fs::read_to_string(&rig).unwrap();
    let (before, after) = text.split_once("[attitude]").unwrap();
    let (_, after) = after.split_once("\n[").unwrap();
    fs::write(&rig, format!("{before}[{after}")).unwrap();
    folder
}

#[test]
fn gyro_that_gravity_does_not_show_is_told_by_the_heading() {
    for (bias, expected) in [("0 deg/h", 0.0), ("1 deg/h", 1.0), ("-0.5 deg/h", -0.5)] {
        let folder = rest(bias);
        let result = result_in(folder.path(), "align run/rig.toml");
        let (found, sigma) =
            (numbers(&result, "/gyro_bias_deg_h"), numbers(&result, "/gyro_bias_sigma_deg_h"));
        assert!(
            (found[2] - expected).abs() < 4.0 * sigma[2] && sigma[2] < 0.02,
            "{found:?} {sigma:?}"
        );
        let earth_rate = number(&result, "/apparent/earth_rate_deg_h");
        // The Earth rate along north and up at the station's latitude.
        let [north, up] = {
            let rate = number(&result, "/site/earth_rate_deg_h");
            let latitude = number(&result, "/site/latitude_deg").to_radians();
            [rate * latitude.cos(), rate * latitude.sin()]
        };
        let sigma = number(&result, "/apparent/earth_rate_sigma_deg_h");
        assert!((earth_rate - north.hypot(up + expected)).abs() < 4.0 * sigma, "{earth_rate}");
        let shown: Vec<bool> = list(&result, "/gyro_bias_observable")
            .iter()
            .map(|shown| shown.as_bool().unwrap())
            .collect();
        assert_eq!(shown, [false, true, true]);
        let text = rins_in(folder.path(), "align run/rig.toml").out;
        let is_beyond = expected.abs() > 0.1;
        assert_eq!(text.contains("Along up the gyros are off by"), is_beyond, "{text}");
        assert!(text.contains("not estimated") && text.contains("assumed"), "{text}");
        let check = rins_in(folder.path(), "check run/rig.toml").out;
        assert_eq!(check.contains("odd: static intervals"), is_beyond, "{check}");
    }
}

#[test]
fn axes_of_an_imu_at_rest_need_an_attitude() {
    let folder = rest("0 deg/h");
    let check = rins_in(folder.path(), "check run/rig.toml").out;
    assert!(
        check.contains("not observable: needs an [attitude], or a table that turns"),
        "{check}"
    );
    assert!(!check.contains("neither static nor"), "{check}");
}

/// A spectral line of 0.565 Hz, as of a swaying base, in addition to white noise and quantization.
#[test]
fn line_is_no_quantisation() {
    let folder = rest("0 deg/h");
    let log = folder.path().join("run/run.csv");
    let text = fs::read_to_string(&log).unwrap();
    let (head, rows) = text.split_once('\n').unwrap();
    let names: Vec<&str> = head.split(',').collect();
    let column = |name: &str| names.iter().position(|column| column.starts_with(name)).unwrap();
    let (time, accel) = (column("time"), column("accel_x"));
    let mut phase = 0.0_f64;
    let mut before = 0.0;
    let mut disturbed = format!("{head}\n");
    for row in rows.lines() {
        let mut fields: Vec<String> = row.split(',').map(String::from).collect();
        let now: f64 = fields[time].parse().unwrap();
        phase += std::f64::consts::TAU * (0.565 + 0.01 * (0.1 * now).sin()) * (now - before);
        before = now;
        let reading: f64 = fields[accel].parse().unwrap();
        fields[accel] = (reading + 0.02 * 9.8e-3 * phase.sin()).to_string();
        disturbed += &(fields.join(",") + "\n");
    }
    fs::write(&log, disturbed).unwrap();
    let result = result_in(folder.path(), "allan run/rig.toml");
    let channel = &list(&result, "/channels")[3];
    let lines = list(channel, "/spectral_lines");
    assert!(!lines.is_empty(), "{channel}");
    assert_close!(number(&lines[0], "/frequency_hz"), 0.565, 0.02);
    let noise = number(channel, "/terms/1/value");
    assert_close!(noise, 20.0, 1.0);
    assert_eq!(channel["terms"][0]["significant"], false);
    let text = rins_in(folder.path(), "allan run/rig.toml").out;
    assert!(text.contains("accelerometer x has a spectral line at 0.56"), "{text}");
}
