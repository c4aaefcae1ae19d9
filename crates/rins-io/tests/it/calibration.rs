//! Calibration files: written, read, and refused.

use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use rins_imu::{ImuError, TriadError};
use rins_io::{Calibration, Overwrite, Parameter, parameters};

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
        known in prop::collection::vec(any::<bool>(), 24),
        notes in prop::collection::vec(any::<String>(), 0..3),
    ) {
        let error = ImuError { gyro, accel };
        let mut sigmas = parameters(&error);
        let mut known = known.into_iter();
        sigmas.retain_mut(|sigma| {
            sigma.value = sigma.value.abs() + 1e-6;
            known.next().unwrap()
        });
        let written = Calibration { sigmas, notes, ..Calibration::of(error) };
        let again = Calibration::parse(&written.to_toml(), Path::new("calibration.toml")).unwrap();
        prop_assert!(near(&again.error, &error));
        prop_assert_eq!(again.notes, written.notes);
        prop_assert_eq!(again.sigmas.len(), written.sigmas.len());
        for (got, want) in again.sigmas.iter().zip(&written.sigmas) {
            prop_assert_eq!((&got.id, got.unit), (&want.id, want.unit));
            prop_assert!((got.value - want.value).abs() <= ROUNDING * want.value);
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
    ("schema = 1", "schema = 1\nnotes = \"none\"", "c.toml:3: notes: \"none\" is a text, expected a list of texts"),
    ("schema = 1", "schema = 1\nnotes = [\n\"one\",\n2]", "c.toml:5: notes: 2 is a bare number, expected a list of texts"),
    ("[accel]", "[sigma]\ngyro.scale.z = \"1 ppm\"\ngyro.misalignment.xx = \"1 arcsec\"\n[accel]", "c.toml:11: [sigma] gyro.misalignment.xx: unknown key; did you mean \"xy\"?"),
    ("[accel]", "[sigma]\ngyro.scale.z = \"1 arcsec\"\n[accel]", "c.toml:10: [sigma] gyro.scale.z: \"1 arcsec\" is an angle, expected a ratio such as \"300 ppm\""),
    ("[accel]", "[sigma]\naccel.bias.x = \"0 ug\"\n[accel]", "c.toml:10: [sigma] accel.bias.x: \"0 ug\" is out of range, expected more than zero"),
    ("[accel]", "[sigma]\naccel.bias.x = \"-1 mg\"\n[accel]", "c.toml:10: [sigma] accel.bias.x: \"-1 mg\" is out of range, expected more than zero"),
    ("[accel]", "[sigma.gyro]\nbias = [\"1 deg/h\"]\n[accel]", "c.toml:10: [sigma] gyro.bias: a list, expected a table with the keys x, y, z"),
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
fn only_what_was_estimated_has_a_sigma() {
    let text = format!(
        "{TEXT}\n[sigma]\naccel.bias.z = \"10 ug\"\ngyro.misalignment.xz = \"0.0065 arcsec\"\n"
    );
    let sigmas = Calibration::parse(&text, Path::new("c.toml")).unwrap().sigmas;
    let ids: Vec<(&str, &str)> =
        sigmas.iter().map(|Parameter { id, unit, .. }| (id.as_str(), *unit)).collect();
    assert_eq!(ids, [("gyro.misalignment.xz", "arcsec"), ("accel.bias.z", "ug")]);
    assert!((sigmas[0].value - 0.0065).abs() < 1e-15);
    let without = Calibration::parse(TEXT, Path::new("c.toml")).unwrap();
    assert!(without.sigmas.is_empty());
    assert!(!without.to_toml().contains("sigma"));
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
