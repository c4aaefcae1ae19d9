//! Invalid calibration files.

use super::files::Spoil::{Content, Folder, Nothing, Replace};
use super::{DATA, Row, refused};

const FILE: &str = "calibration.toml";
const NAVIGATE: &str = "navigate rig.toml --calibration calibration.toml";
const NO_GYRO: &[u8] = b"schema = 1\n\n[accel]\n";

const CALIBRATIONS: &[Row] = &[
    (
        "no file",
        "navigate rig.toml --calibration no.toml",
        Nothing,
        &["cannot read no.toml", "No such file"],
    ),
    ("a folder", NAVIGATE, Folder(FILE), &["cannot read calibration.toml", "directory"]),
    ("empty", NAVIGATE, Content(FILE, b""), &["calibration.toml: schema: missing, expected 1"]),
    (
        "a rig",
        "navigate rig.toml --calibration rig.toml",
        Nothing,
        &["rig.toml:1: site: unknown key"],
    ),
    ("a log", "navigate rig.toml --calibration run.csv", Nothing, &["run.csv:1:"]),
    (
        "of another format",
        NAVIGATE,
        Replace(FILE, "schema = 2", "schema = 3"),
        &["calibration.toml:{line}: schema: 3 is not allowed, expected 1 or 2"],
    ),
    (
        "without gyros",
        NAVIGATE,
        Content(FILE, NO_GYRO),
        &["calibration.toml: gyro: missing, expected the keys bias, scale and misalignment"],
    ),
    (
        "without a misalignment",
        NAVIGATE,
        Replace(FILE, "xy = \"0 arcsec\", ", ""),
        &["calibration.toml:{line}: [gyro] misalignment.xy: missing"],
    ),
    (
        "a bias in ppm",
        NAVIGATE,
        Replace(FILE, "0 deg/h", "0 ppm"),
        &["calibration.toml:{line}: [gyro] bias[1]", "\"0 ppm\""],
    ),
    (
        "a gyro that reads nothing",
        NAVIGATE,
        Replace(FILE, "scale = [\"0 ppm\"", "scale = [\"-1000000 ppm\""),
        &["calibration.toml", "gyro"],
    ),
    (
        "an absurd bias",
        NAVIGATE,
        Replace(FILE, "bias = [\"0 ug\"", "bias = [\"1e17 ug\""),
        &["rig.toml: navigation (compensated) leaves the range of numbers"],
    ),
    (
        "a negative sigma",
        NAVIGATE,
        Replace(FILE, "gyro.scale.z = \"", "gyro.scale.z = \"-"),
        &["calibration.toml:{line}: [sigma] gyro.scale.z", "expected more than zero"],
    ),
    (
        "NaN",
        NAVIGATE,
        Replace(FILE, "0 deg/h", "nan deg/h"),
        &["calibration.toml:{line}: [gyro] bias[1]", "nan"],
    ),
];

#[test]
fn calibration_that_cannot_be_undone() {
    refused(DATA, CALIBRATIONS);
}
