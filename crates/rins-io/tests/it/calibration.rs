//! Calibration files: written, read, and refused.

use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use rins_imu::{ImuError, TriadError};
use rins_io::{Calibration, Overwrite};

use crate::support::replaced;

/// What writing in deg/h, ug, ppm and arcsec and reading again may change: a rounding each way.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

fn any_triad(size: f64) -> impl Strategy<Value = TriadError> {
    prop::array::uniform12(-size..size).prop_map(|numbers| TriadError {
        bias: Vector3::from_column_slice(&numbers[..3]),
        matrix: Matrix3::from_column_slice(&numbers[3..]),
    })
}

fn near(a: &ImuError, b: &ImuError) -> bool {
    let numbers = |error: &ImuError| -> Vec<f64> {
        [&error.gyro, &error.accel]
            .into_iter()
            .flat_map(|triad| triad.bias.iter().chain(triad.matrix.iter()).copied())
            .collect()
    };
    numbers(a).iter().zip(numbers(b)).all(|(a, b)| (a - b).abs() <= ROUNDING * b.abs())
}

proptest! {
    #[test]
    fn what_is_written_is_read_again(
        gyro in any_triad(1e-2),
        accel in any_triad(1e-2),
        known in any::<bool>(),
    ) {
        let error = ImuError { gyro, accel };
        let positive = |triad: &TriadError| TriadError {
            bias: triad.bias.abs(),
            matrix: triad.matrix.abs(),
        };
        let sigma = known.then(|| ImuError { gyro: positive(&gyro), accel: positive(&accel) });
        let text = Calibration { sigma, ..Calibration::of(error) }.to_toml();
        let again = Calibration::parse(&text, Path::new("calibration.toml")).unwrap();
        prop_assert!(near(&again.error, &error));
        prop_assert_eq!(again.sigma.is_some(), known);
        if let (Some(got), Some(want)) = (again.sigma, sigma) {
            prop_assert!(near(&got, &want));
        }
    }
}

/// As a person might write it.
const TEXT: &str = r#"
schema = 1

[gyro]
bias = ["0.05 deg/h", "0 rad/s", "0 deg/s"]
scale = ["100 ppm", "0 %", "0 1"]
misalignment = { xy = "0 deg", xz = "60 arcsec", yx = "0 deg", yz = "1 mrad", zx = "0 deg", zy = "0 deg" }

[accel]
bias = ["1 mg", "0 g", "0 m/s^2"]
scale = ["0 ppm", "0 ppm", "0 ppm"]
misalignment = { xy = "0 deg", xz = "0 deg", yx = "0 deg", yz = "0 deg", zx = "0 deg", zy = "0 deg" }
"#;

#[test]
fn rows_and_columns_are_those_of_the_equation() {
    let calibration = Calibration::parse(TEXT, Path::new("c.toml")).unwrap();
    assert_eq!(calibration.error.gyro.matrix[(1, 2)], 1e-3);
    assert_eq!(calibration.error.gyro.matrix[(2, 1)], 0.0);
    // A rate of 1 rad/s about z, seen by gyro y as 1 mrad/s too much.
    let measured = calibration.error.gyro.measured_rate(&rins_frames::InFrame::new(0.0, 0.0, 1.0));
    assert_eq!(measured.components().y, 1e-3);
}

#[rustfmt::skip]
const CASES: &[(&str, &str, &str)] = &[
    ("schema = 1", "", "c.toml: schema: missing, expected 1"),
    ("schema = 1", "schema = 2", "c.toml:2: schema: 2 is not allowed, expected 1"),
    ("schema = 1", "scheme = 1", "c.toml:2: scheme: unknown key; did you mean \"schema\"?"),
    ("[gyro]", "[gyros]", "c.toml:4: gyros: unknown key; did you mean \"gyro\"?"),
    ("scale = [\"100 ppm\", \"0 %\", \"0 1\"]\n", "", "c.toml:4: [gyro] scale: missing, expected three quantities such as [\"300 ppm\", \"300 ppm\", \"300 ppm\"]"),
    ("\"0 rad/s\"", "\"0 rad\"", "c.toml:5: [gyro] bias[2]: \"0 rad\" is an angle, expected an angular rate such as \"0.05 deg/h\""),
    ("yz = \"1 mrad\", ", "", "c.toml:7: [gyro] misalignment.yz: missing, expected an angle such as \"60 arcsec\""),
    ("\"1 mrad\"", "1e-3", "c.toml:7: [gyro] misalignment.yz: 1e-3 is a bare number, expected an angle such as \"60 arcsec\""),
    ("\"100 ppm\"", "\"-1 1\"", "c.toml: [gyro]: the three axes read nearly the same: I + [S, M] has determinant 0"),
    ("\"0 g\"", "\"0 gee\"", "c.toml:10: [accel] bias[2]: \"0 gee\": unknown unit \"gee\""),
    ("schema = 1", "schema = 1\nsigma = 3", "c.toml:3: sigma: 3 is a bare number, expected a table with the keys gyro, accel"),
    ("schema = 1", "schema = 1\nsigma = {}", "c.toml:3: [sigma] gyro: missing, expected the keys bias, scale and misalignment"),
];

#[test]
fn wrong_calibrations_are_refused_with_file_line_key_and_expectation() {
    let mut wrong = String::new();
    for (from, to, message) in CASES {
        let text = replaced(TEXT, from, to);
        let error = Calibration::parse(&text, Path::new("c.toml")).unwrap_err().to_string();
        if error != *message {
            wrong.push_str(&format!(
                "{from:?} -> {to:?}\n  said     {error}\n  expected {message}\n"
            ));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn a_negative_standard_deviation_is_refused() {
    let triads = &TEXT[TEXT.find("[gyro]").unwrap()..];
    let sigma = triads.replace("[gyro]", "[sigma.gyro]").replace("[accel]", "[sigma.accel]");
    assert!(Calibration::parse(&format!("{TEXT}{sigma}"), Path::new("c.toml")).is_ok());
    let negative = sigma.replace("1 mg", "-1 mg");
    let error = Calibration::parse(&format!("{TEXT}{negative}"), Path::new("c.toml")).unwrap_err();
    assert_eq!(error.to_string(), "c.toml:13: sigma: a standard deviation is negative");
}

#[test]
fn a_file_says_what_its_numbers_mean() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("calibration.toml");
    Calibration::of(ImuError::default()).write(&path, Overwrite::Refuse).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("measured    = true + bias + [S, M] true"));
    assert!(text.contains("compensated = (I + [S, M])^-1 (measured - bias)"));
    assert_eq!(Calibration::read(&path).unwrap().error, ImuError::default());
}
