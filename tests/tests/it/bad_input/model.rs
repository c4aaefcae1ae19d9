//! Calibrations with invalid models, combinations of runs and calibration files.

use super::files::Spoil::{self, All, Content, Copy, Nothing, Replace};
use super::{DATA, Row, USAGE, refused};

const MODEL: &str = "calibrate rig.toml --model model.toml";
const APPLY: &str = "apply rig.toml --calibration calibration.toml -o new.csv";

const MODELS: &[Row] = &[
    ("no model file", MODEL, Nothing, &["cannot read model.toml", "No such file"]),
    ("empty", MODEL, Content("model.toml", b""), &["model.toml: schema: missing, expected 1"]),
    (
        "a rig for a model",
        "calibrate rig.toml --model rig.toml",
        Nothing,
        &["rig.toml:1: site: unknown key"],
    ),
    (
        "no such base",
        MODEL,
        Content("model.toml", b"schema = 1\nbase = \"ful\"\n"),
        &["model.toml:2: base: \"ful\" is not known; did you mean \"full\"?"],
    ),
    (
        "no such term",
        MODEL,
        Content("model.toml", b"schema = 1\nbase = \"full\"\n[[term]]\nid = \"accel_lever_am\"\n"),
        &["model.toml:4: term[1].id: \"accel_lever_am\" is not known; did you mean \"accel_lever_arm\"?"],
    ),
    (
        "a unit of another kind",
        MODEL,
        Content(
            "model.toml",
            b"schema = 1\nbase = \"full\"\n[[term]]\nid = \"accel_lever_arm\"\nr_x = \"4 deg\"\n",
        ),
        &["model.toml:5: term[1].r_x: \"4 deg\" is an angle, expected a length"],
    ),
    (
        "a model of nothing",
        MODEL,
        Content("model.toml", b"schema = 1\nbase = \"none\"\n"),
        &["rig.toml: the model has no parameter to estimate"],
    ),
    (
        "a diagnosis with no model file",
        "diagnose rig.toml --model model.toml",
        Nothing,
        &["cannot read model.toml", "No such file"],
    ),
    (
        "a diagnosis of a model of nothing",
        "diagnose rig.toml --model model.toml",
        Content("model.toml", b"schema = 1\nbase = \"none\"\n"),
        &["rig.toml: ", "the model has no parameter to estimate"],
    ),
    (
        "a diagnosis of two IMUs",
        "diagnose rig.toml other.toml",
        OTHER,
        &["rig.toml and other.toml have different data sheets"],
    ),
    (
        "a gain on another IMU",
        "diagnose rig.toml --held-out other.toml",
        OTHER,
        &["rig.toml and other.toml have different data sheets"],
    ),
    (
        "a gain on a run that is not there",
        "diagnose rig.toml --held-out no.toml",
        Nothing,
        &["cannot read no.toml"],
    ),
    (
        "a diagnosis of exchanged gyros",
        "diagnose rig.toml",
        Replace("rig.toml", "unit = \"rad\"", "unit = \"rad\", axes = [\"z\", \"x\", \"y\"]"),
        &["rig.toml: ", "the axes are exchanged"],
    ),
    (
        "two IMUs",
        "calibrate rig.toml other.toml --model full",
        OTHER,
        &["rig.toml and other.toml have different data sheets"],
    ),
    (
        "a second rig that is not there",
        "calibrate rig.toml no.toml --model full",
        Nothing,
        &["cannot read no.toml"],
    ),
    (
        "no data sheet",
        "calibrate rig.toml --model full",
        Replace("rig.toml", "[imu.gyro]", "[attitude.more]"),
        &["rig.toml"],
    ),
    (
        "swapped axes",
        "calibrate rig.toml --model full",
        Replace("rig.toml", "[\"accel_x\", \"accel_y\", \"accel_z\"]", "[\"accel_x\", \"accel_z\", \"accel_y\"]"),
        &["rig.toml"],
    ),
    (
        "nothing to compare",
        "compare calibration.toml other.toml",
        Content("other.toml", b"schema = 1\n[gyro]\nbias = [\"0 deg/h\", \"0 deg/h\", \"0 deg/h\"]\nscale = [\"0 ppm\", \"0 ppm\", \"0 ppm\"]\nmisalignment = { xy = \"0 arcsec\", xz = \"0 arcsec\", yx = \"0 arcsec\", yz = \"0 arcsec\", zx = \"0 arcsec\", zy = \"0 arcsec\" }\n[accel]\nbias = [\"0 ug\", \"0 ug\", \"0 ug\"]\nscale = [\"0 ppm\", \"0 ppm\", \"0 ppm\"]\nmisalignment = { xy = \"0 arcsec\", xz = \"0 arcsec\", yx = \"0 arcsec\", yz = \"0 arcsec\", zx = \"0 arcsec\", zy = \"0 arcsec\" }\n"),
        &["have no parameter in common that was estimated in both"],
    ),
    (
        "nothing to compare with",
        "compare calibration.toml no.toml",
        Nothing,
        &["cannot read no.toml"],
    ),
    ("a log for a calibration", "compare run.csv calibration.toml", Nothing, &["run.csv:1:"]),
    (
        "no calibration to apply",
        "apply rig.toml --calibration no.toml -o new.csv",
        Nothing,
        &["cannot read no.toml"],
    ),
    (
        "a name that tells no format",
        "apply rig.toml --calibration calibration.toml -o new.txt",
        Nothing,
        &["new.txt: the file name has no known extension"],
    ),
    (
        "over its own log",
        "apply rig.toml --calibration calibration.toml -o run.csv",
        Nothing,
        &["run.csv"],
    ),
    (
        "a gyro that reads nothing",
        APPLY,
        Replace("calibration.toml", "scale = [\"0 ppm\"", "scale = [\"-1000000 ppm\""),
        &["calibration.toml", "gyro"],
    ),
];

/// The rig of another IMU with the same log.
const OTHER: Spoil = All(&[
    Copy("rig.toml", "other.toml"),
    Replace("other.toml", "\"0.02 deg/h/sqrt(Hz)\"", "\"0.5 deg/h/sqrt(Hz)\""),
]);

#[test]
fn models_runs_and_calibrations_that_do_not_go_together() {
    refused(DATA, MODELS);
}

const USAGES: &[Row] = &[
    (
        "a rig given twice",
        "calibrate rig.toml rig.toml --model full",
        Nothing,
        &["rig.toml is given twice"],
    ),
    (
        "several rigs for the paper's filter",
        "calibrate rig.toml other.toml --model paper12",
        Nothing,
        &["--model paper12 takes one rig"],
    ),
    ("no rig to calibrate", "calibrate --model full", Nothing, &["<RIG>..."]),
    (
        "noise of what kind",
        "calibrate rig.toml --noise white",
        Nothing,
        &["invalid value 'white' for '--noise <NOISE>'", "likely, given"],
    ),
    ("nothing to apply", "apply rig.toml -o new.csv", Nothing, &["--calibration <FILE>"]),
    (
        "nowhere to apply to",
        "apply rig.toml --calibration calibration.toml",
        Nothing,
        &["--output <LOG>"],
    ),
    ("one calibration to compare", "compare calibration.toml", Nothing, &["<AFTER>"]),
];

#[test]
fn command_lines_about_models_that_are_not_understood() {
    refused(USAGE, USAGES);
}
