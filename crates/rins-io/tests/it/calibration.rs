//! Calibration files: written, read, and refused.

use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use rins_imu::{ImuError, TriadError};
use rins_io::{Axes, Calibration, Overwrite, Parameter, parameters};
use rins_terms::Role;
use rins_testing::{assert_rows, says};

use crate::support::{assert_refused, replaced};

/// The relative change by writing in deg/h, ug, ppm and arcsec and reading again: one rounding error each way.
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

/// A file as a user might write it.
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
    // For a rate of 1 rad/s about z, the output of gyro y is too large by 1 mrad/s.
    let measured = calibration.error.gyro.measured_rate(&rins_frames::InFrame::new(0.0, 0.0, 1.0));
    assert_eq!(measured.components().y, 1e-3);
}

#[rustfmt::skip]
const CASES: &[(&str, &str, &str)] = &[
    ("schema = 1", "", "c.toml: schema: missing, expected 1 or 2"),
    ("schema = 1", "schema = 3", "c.toml:2: schema: 3 is not allowed, expected 1 or 2"),
    ("[accel]", "[[term]]\nid = \"encoder.zero\"\n[accel]", "c.toml:9: term: needs schema = 2"),
    ("[accel]", "[covariance]\n[accel]", "c.toml:9: covariance: needs schema = 2"),
    ("schema = 1", "scheme = 1", "c.toml:2: scheme: unknown key; did you mean \"schema\"?"),
    ("[gyro]", "[gyros]", "c.toml:4: gyros: unknown key; did you mean \"gyro\"?"),
    ("scale = [\"100 ppm\", \"0 %\", \"0 1\"]\n", "", "c.toml:4: [gyro] scale: missing, expected three quantities such as [\"300 ppm\", \"300 ppm\", \"300 ppm\"]"),
    ("\"0 rad/s\"", "\"0 rad\"", "c.toml:5: [gyro] bias[2]: \"0 rad\" is an angle, expected an angular rate such as \"0.05 deg/h\""),
    ("yz = \"1 mrad\", ", "", "c.toml:7: [gyro] misalignment.yz: missing, expected an angle such as \"60 arcsec\""),
    ("\"1 mrad\"", "1e-3", "c.toml:7: [gyro] misalignment.yz: 1e-3 is a bare number, expected an angle such as \"60 arcsec\""),
    ("\"100 ppm\"", "\"-1 1\"", "c.toml: [gyro]: the three axes read nearly the same: I + S + M has determinant 0"),
    ("\"0 g\"", "\"0 gee\"", "c.toml:10: [accel] bias[2]: \"0 gee\": unknown unit \"gee\""),
    ("schema = 1", "schema = 1\nsigma = 3", "c.toml:3: sigma: 3 is a bare number, expected a table with the keys gyro, accel"),
    ("schema = 1", "schema = 1\nnotes = \"none\"", "c.toml:3: notes: \"none\" is a text, expected a list of texts"),
    ("schema = 1", "schema = 1\nnotes = [\n\"one\",\n2]", "c.toml:5: notes: 2 is a bare number, expected a list of texts"),
    ("[accel]", "[sigma]\ngyro.scale.z = \"1 ppm\"\ngyro.misalignment.xx = \"1 arcsec\"\n[accel]", "c.toml:11: [sigma] gyro.misalignment.xx: unknown key; did you mean \"xy\"?"),
    ("[accel]", "[sigma]\ngyro.scale.z = \"1 arcsec\"\n[accel]", "c.toml:10: [sigma] gyro.scale.z: \"1 arcsec\" is an angle, expected a ratio such as \"300 ppm\""),
    ("[accel]", "[sigma]\naccel.bias.x = \"0 ug\"\n[accel]", "c.toml:10: [sigma] accel.bias.x: \"0 ug\" is out of range, expected more than zero"),
    ("[accel]", "[sigma]\naccel.bias.x = \"-1 mg\"\n[accel]", "c.toml:10: [sigma] accel.bias.x: \"-1 mg\" is out of range, expected more than zero"),
    ("schema = 1", "schema = 1\nmeasured = { serial = \"A7\" }", "c.toml:3: measured: needs schema = 2"),
    ("schema = 1", "schema = 2\nmeasured = { temperature_is = \"warm\" }", "c.toml:3: [measured] temperature_is: \"warm\" is not known, expected one of \"rising\", \"falling\""),
    ("[accel]", "[sigma.gyro]\nbias = [\"1 deg/h\"]\n[accel]", "c.toml:10: [sigma] gyro.bias: a list, expected a table with the keys x, y, z"),
];

/// When and how it was measured, and what was known before, is written and read again.
#[test]
fn conditions_are_read_again() {
    let prior = Parameter { id: "gyro.scale.z".into(), value: 300.0, unit: "ppm" };
    let text = "[measured]\nserial = \"A \\\"7\\\"\"\nseries = \"morning\"\nstarted = \"2026-11-26T10:00:00Z\"\nsince_power_on = \"600.5 s\"\n\
                temperature = \"23.25 degC\"\ntemperature_is = \"falling\"\nlaboratory = \"L\"\noperator = \"O\"\nprocedure = \"P\"\n[gyro]\n";
    let text = TEXT.replacen("schema = 1", "schema = 2", 1).replacen("[gyro]\n", text, 1);
    let read = Calibration::parse(&text, Path::new("c.toml")).unwrap();
    assert_eq!((read.measured.temperature, read.measured.warming), (Some(23.25), Some(-1.0)));
    assert_eq!(read.measured.serial.as_deref(), Some("A \"7\""));
    let written = Calibration { priors: vec![prior.clone()], ..read };
    let again = Calibration::parse(&written.to_toml(), Path::new("c.toml")).unwrap();
    assert_eq!(again.measured, written.measured);
    assert_eq!(again.priors, [prior]);
}

#[test]
fn wrong_calibrations_are_refused_with_file_line_key_and_expectation() {
    assert_refused(TEXT, CASES, |text| Calibration::parse(text, Path::new("c.toml")));
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
    assert!(text.contains("measured    = true + bias + (S + M) true"));
    assert!(text.contains("compensated = (I + S + M)^-1 (measured - bias)"));
    assert_eq!(Calibration::read(&path).unwrap().error, ImuError::default());
}

/// Two terms, one of them only partly estimated, and a covariance.
const BEYOND: &str = r#"
[covariance]
ids = ["gyro.scale.z", "accel_lever_arm.r_x", "encoder_harmonic#2.sin"]
rows = [[0.04], [-1e-3, 0.25], [0, 0.0, 0.01]]
references = ["table.rate_accuracy", "site.gravity_accuracy"]
shifts = [[0.15, 0, 0.0], [0.0, -0.3, 1e-3]]

[[term]]
id = "accel_lever_arm"
r_x = "4 mm"
r_y = "-2.5 mm"
sigma = { r_x = "0.5 mm", r_y = "0.5 mm" }

[[term]]
id = "encoder_harmonic"
order = 2
cos = "0.5 arcsec"

[[term]]
id = "encoder_harmonic"
order = 3
sin = "1 arcsec"
sigma = { sin = "0.1 arcsec" }
"#;

fn beyond() -> String {
    format!("{}{BEYOND}", replaced(TEXT, "schema = 1", "schema = 2"))
}

#[test]
fn what_is_off_beyond_the_triads_is_written_and_read() {
    let calibration = Calibration::parse(&beyond(), Path::new("c.toml")).unwrap();
    let model = &calibration.terms;
    assert_eq!(model.value("accel_lever_arm.r_y"), Some(-2.5e-3));
    let sigmas: Vec<Role> = model.terms.iter().flat_map(|chosen| chosen.roles.clone()).collect();
    let known: Vec<bool> = sigmas.iter().map(|role| matches!(role, Role::Within(_))).collect();
    let arm = model.terms[0].roles.len();
    assert_eq!(known[..2], [true; 2]);
    assert_eq!(known[arm..], [false, false, false, true]);
    let covariance = calibration.covariance.as_ref().unwrap();
    assert_eq!(covariance.matrix[(0, 1)], -1e-3);
    assert_eq!(covariance.matrix[(1, 0)], -1e-3);
    assert_eq!(covariance.matrix[(2, 2)], 0.01);
    let (name, shifts) = &covariance.references[1];
    assert_eq!(
        (name.as_str(), shifts.as_slice()),
        ("site.gravity_accuracy", &[0.0, -0.3, 1e-3][..])
    );

    let text = calibration.to_toml();
    assert!(text.contains("schema = 2\n") && text.contains("terms(true)"), "{text}");
    let again = Calibration::parse(&text, Path::new("c.toml")).unwrap();
    assert_eq!(again.covariance, calibration.covariance);
    for (got, want) in again.terms.terms.iter().zip(&model.terms) {
        assert_eq!((got.term.id, &got.settings), (want.term.id, &want.settings));
        for (got, want) in got.values.iter().zip(&want.values) {
            assert!((got - want).abs() <= ROUNDING * want.abs(), "{got} {want}");
        }
        for (got, want) in got.roles.iter().zip(&want.roles) {
            let (Role::Within(got), Role::Within(want)) = (got, want) else {
                assert_eq!(got, want);
                continue;
            };
            assert!((got - want).abs() <= ROUNDING * want, "{got} {want}");
        }
    }
    let (error, terms) = calibration.in_run(&Axes::IDENTITY).unwrap();
    assert_eq!((error, terms), (calibration.error, calibration.terms));
}

#[test]
fn a_file_is_of_the_oldest_version_that_can_hold_it() {
    let text = Calibration::parse(TEXT, Path::new("c.toml")).unwrap().to_toml();
    assert!(text.contains("schema = 1\n") && !text.contains("term"), "{text}");
}

#[rustfmt::skip]
const BEYOND_CASES: &[(&str, &str, &str)] = &[
    ("\"accel_lever_arm\"\n", "\"gyro.scale\"\n", "term[1].r_x: unknown key, expected one of x, y, z, id, estimate, sigma"),
    ("\"accel_lever_arm\"\nr_x = \"4 mm\"\nr_y = \"-2.5 mm\"\nsigma = { r_x = \"0.5 mm\", r_y = \"0.5 mm\" }", "\"gyro.scale\"", "term[1].id: gyro.scale stands in [gyro]"),
    ("\"accel_lever_arm\"\nr_x = \"4 mm\"\nr_y = \"-2.5 mm\"\nsigma = { r_x = \"0.5 mm\", r_y = \"0.5 \
      mm\" }", "\"stuck_samples\"", "term[1].id: stuck_samples cannot be compensated"),
    ("\"4 mm\"", "\"4 deg\"", "term[1].r_x: \"4 deg\" is an angle, expected a length such as \"1 mm\""),
    ("order = 3", "order = 1", "term[3].order: 1 is not allowed, expected from 2 to 1000000"),
    ("\"gyro.scale.z\", ", "\"gyro.scale.w\", ", "[covariance] ids: \"gyro.scale.w\" is no parameter of this calibration"),
    ("\"gyro.scale.z\", ", "\"accel_lever_arm.r_x\", ", "[covariance] ids: an id is listed twice"),
    ("[[0.04], ", "[", "[covariance] rows: has 2 rows for 3 ids"),
    ("[-1e-3, 0.25]", "[0.25]", "[covariance] rows: has 1 numbers in row 2"),
    ("[-1e-3, 0.25]", "[\"a\", 0.25]", "[covariance] rows: \"a\" is a text, expected a list of rows of numbers"),
    ("0.25]", "0.36]", "[covariance] rows: holds a sigma of 0.6 for accel_lever_arm.r_x, which is 0.5 beside it"),
    ("-1e-3", "-1.0", "[covariance] rows: holds -1 for \"accel_lever_arm.r_x\", \"gyro.scale.z\", which cannot be"),
    ("0.25", "0.0", "which cannot be"),
    ("shifts = [[0.15, 0, 0.0], [0.0, -0.3, 1e-3]]", "", "[covariance] shifts: missing, expected a list of rows of numbers"),
    ("[0.15, 0, 0.0], ", "", "[covariance] shifts: has 1 rows for 2 references"),
    ("0.15, 0,", "0.15,", "[covariance] shifts: has 2 numbers for 3 ids"),
    ("0.15", "\"a\"", "[covariance] shifts: "),
    ("0.15", "0.21", "[covariance] shifts: holds 0.21 for gyro.scale.z, which is beyond its sigma"),
];

#[test]
fn wrong_terms_and_covariances_are_refused() {
    let right = beyond();
    assert_rows(BEYOND_CASES.iter().map(|(from, to, message)| {
        let error = Calibration::parse(&replaced(&right, from, to), Path::new("c.toml"));
        (format!("{from:?} -> {to:?}"), says(&error.unwrap_err().to_string(), message))
    }));
}
