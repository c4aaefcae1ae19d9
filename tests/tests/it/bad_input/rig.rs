//! Invalid rig files.

use super::files::Spoil::{All, Content, Cut, Folder, Nothing, Replace};
use super::{DATA, Row, refused};

const RIG: &str = "rig.toml";
const CHECK: &str = "check rig.toml";
const CALIBRATE: &str = "calibrate rig.toml";

/// The rig file itself.
const FILE: &[Row] = &[
    ("no file", "check no.toml", Nothing, &["cannot read no.toml", "No such file"]),
    ("a folder", CHECK, Folder(RIG), &["cannot read rig.toml", "directory"]),
    ("empty", CHECK, Content(RIG, b""), &["rig.toml: [log]: missing", "gyro and accel"]),
    ("not UTF-8", CHECK, Content(RIG, b"[site]\nname = \"\xe9\"\n"), &["rig.toml: not UTF-8"]),
    ("binary", CHECK, Content(RIG, b"\x7fELF\0\0\0\x01"), &["rig.toml"]),
    ("prose", CHECK, Content(RIG, b"Dear rins,\n"), &["rig.toml:1:"]),
    ("cut within a text", CHECK, Cut(RIG, 6), &["rig.toml:{line}:"]),
    (
        "cut within a table",
        CHECK,
        Replace(RIG, "unit = \"rad\" }\naccel", "\naccel"),
        &["rig.toml:"],
    ),
    ("a log in its place", "check run.csv", Nothing, &["run.csv:1:"]),
];

/// Keys that are missing, duplicate, or unknown.
const KEYS: &[Row] = &[
    (
        "unknown key",
        CHECK,
        Replace(RIG, "latitude", "lattitude"),
        &["rig.toml:{line}: [site] lattitude: unknown key; did you mean \"latitude\"?"],
    ),
    (
        "unknown section",
        CHECK,
        Replace(RIG, "[attitude]", "[atitude]"),
        &["rig.toml:{line}: atitude: unknown key; did you mean \"attitude\"?"],
    ),
    (
        "unknown key of a column",
        CHECK,
        Replace(RIG, "unit = \"rad\" }", "units = \"rad\" }"),
        &["rig.toml:{line}: [log] gyro.units: unknown key; did you mean \"unit\"?"],
    ),
    ("key given twice", CHECK, Replace(RIG, "yaw", "roll"), &["rig.toml:{line}:", "duplicate key"]),
    (
        "no latitude",
        CHECK,
        Replace(RIG, "latitude = \"34.25 deg\"\n", ""),
        &["rig.toml:1: [site] latitude: missing", "\"34.25 deg\""],
    ),
    (
        "no site",
        CHECK,
        Replace(
            RIG,
            "[site]\nlatitude = \"34.25 deg\"\nlongitude = \"108.9 deg\"\nheight = \"400 m\"\n",
            "",
        ),
        &["rig.toml: [site]: missing", "latitude, and height or gravity"],
    ),
    ("no log path", CHECK, Replace(RIG, "path = \"run.csv\"\n", ""), &["[log] path: missing"]),
    ("no gyro", CHECK, Replace(RIG, "gyro = ", "#"), &["[log] gyro: missing", "columns"]),
    (
        "no unit",
        CHECK,
        Replace(RIG, ", unit = \"m/s\"", ""),
        &["rig.toml:{line}: [log] accel.unit: missing"],
    ),
    (
        "neither time nor rate",
        CHECK,
        All(&[Replace(RIG, "rate = \"32 Hz\"\n", ""), Replace(RIG, "time = {", "#")]),
        &["[log] time: missing", "a rate where there is no time column"],
    ),
    (
        "no gyro noise",
        CALIBRATE,
        Replace(RIG, "noise = \"0.02 deg/h/sqrt(Hz)\"\n", ""),
        &["rig.toml:", "[imu.gyro] noise: missing", "deg/h/sqrt(Hz)"],
    ),
    (
        "a text for a section",
        CHECK,
        Replace(RIG, "[site]", "axis = \"z\"\n[site]"),
        &["rig.toml:1: axis: \"z\" is a text, expected a table with the keys spin"],
    ),
];

/// Invalid quantities, wrong dimensions, and implausible values.
const QUANTITIES: &[Row] = &[
    (
        "bias for a noise",
        CALIBRATE,
        Replace(RIG, "0.02 deg/h/sqrt(Hz)", "0.05 deg/h"),
        &["rig.toml:{line}: [imu.gyro] noise", "\"0.05 deg/h\"", "deg/h/sqrt(Hz)"],
    ),
    (
        "noise for a bias",
        CALIBRATE,
        Replace(RIG, "\"200 ug\"", "\"200 ug/sqrt(Hz)\""),
        &["rig.toml:{line}: [imu.accel] bias_sigma", "\"200 ug/sqrt(Hz)\""],
    ),
    (
        "bare number",
        CHECK,
        Replace(RIG, "\"34.25 deg\"", "34.25"),
        &["rig.toml:{line}: [site] latitude: 34.25 is a bare number", "\"34.25 deg\""],
    ),
    (
        "number without a unit",
        CHECK,
        Replace(RIG, "\"34.25 deg\"", "\"34.25\""),
        &["rig.toml:{line}: [site] latitude", "34.25"],
    ),
    (
        "unit without a number",
        CHECK,
        Replace(RIG, "\"34.25 deg\"", "\"deg\""),
        &["[site] latitude", "\"deg\""],
    ),
    (
        "unknown unit",
        CALIBRATE,
        Replace(RIG, "0.1 deg/h", "0.1 deg/hr"),
        &["rig.toml:{line}: [imu.gyro] bias_sigma", "unknown unit \"hr\"; did you mean \"h\"?"],
    ),
    ("flag", CHECK, Replace(RIG, "\"400 m\"", "true"), &["{line}: [site] height: true is a flag"]),
    ("date", CHECK, Replace(RIG, "\"400 m\"", "2024-02-30"), &["rig.toml:{line}:"]),
    ("NaN", CHECK, Replace(RIG, "400 m", "nan m"), &["{line}: [site] height", "nan"]),
    ("infinity", CHECK, Replace(RIG, "400 m", "inf m"), &["{line}: [site] height", "inf"]),
    ("1e400", CHECK, Replace(RIG, "400 m", "1e400 m"), &["{line}: [site] height", "1e400"]),
    (
        "latitude of 100 deg",
        CHECK,
        Replace(RIG, "34.25 deg", "100 deg"),
        &["rig.toml:{line}: [site] latitude: \"100 deg\"", "-90", "90 deg"],
    ),
    (
        "longitude of 400 deg",
        CHECK,
        Replace(RIG, "108.9", "400"),
        &["{line}: [site] longitude: \"400 deg\""],
    ),
    (
        "a height in space",
        CHECK,
        Replace(RIG, "400 m", "400000 km"),
        &["{line}: [site] height: \"400000 km\""],
    ),
    (
        "gravity of the Moon",
        CHECK,
        Replace(RIG, "height = \"400 m\"", "height = \"400 m\"\ngravity = \"1.62 m/s^2\""),
        &["[site] gravity: \"1.62 m/s^2\""],
    ),
    (
        "pitch of 91 deg",
        CHECK,
        Replace(RIG, "20 deg", "91 deg"),
        &["{line}: [attitude] pitch: \"91 deg\""],
    ),
    (
        "negative noise",
        CHECK,
        Replace(RIG, "0.02", "-0.02"),
        &["{line}: [imu.gyro] noise: \"-0.02 deg/h/sqrt(Hz)\""],
    ),
    ("rate of zero", CHECK, Replace(RIG, "32 Hz", "0 Hz"), &["{line}: [log] rate: \"0 Hz\""]),
    ("rate in seconds", CHECK, Replace(RIG, "32 Hz", "0.1 s"), &["{line}: [log] rate: \"0.1 s\""]),
];

/// The keys of the log's columns in `[log]`.
const LOG_KEYS: &[Row] = &[
    (
        "wrong rate",
        CHECK,
        Replace(RIG, "32 Hz", "50 Hz"),
        &["run.csv: the rate is 32.000 Hz in the time column and 50.000 Hz in [log] rate"],
    ),
    (
        "missing column",
        CHECK,
        Replace(RIG, "\"gyro_y\"", "\"gyro_u\""),
        &["run.csv:1: no column \"gyro_u\"", "\"accel_z\"", "did you mean \"gyro_"],
    ),
    (
        "missing time column",
        CHECK,
        Replace(RIG, "\"time\"", "\"tiem\""),
        &["run.csv:1: no column \"tiem\"", "did you mean \"time\"?"],
    ),
    (
        "missing table column",
        CALIBRATE,
        Replace(RIG, "\"table_angle\"", "\"table\""),
        &["run.csv:1: no column \"table\""],
    ),
    ("column 0", CHECK, Replace(RIG, "\"gyro_x\"", "\"0\""), &["run.csv:1: no column \"0\""]),
    ("column 9 of 8", CHECK, Replace(RIG, "\"gyro_x\"", "\"9\""), &["run.csv:1: no column \"9\""]),
    (
        "two columns",
        CHECK,
        Replace(RIG, ", \"gyro_z\"", ""),
        &["{line}: [log] gyro.columns: a list of 2, expected three columns"],
    ),
    (
        "a column twice",
        CHECK,
        Replace(RIG, "\"gyro_y\"", "\"gyro_x\""),
        &["{line}: [log] gyro.columns: names a column twice"],
    ),
    (
        "gyro in m",
        CHECK,
        Replace(RIG, "\"rad\"", "\"m\""),
        &["{line}: [log] gyro.unit", "\"m\"", "an angular rate or an angle increment"],
    ),
    (
        "gyro in furlongs",
        CHECK,
        Replace(RIG, "\"rad\"", "\"furlong\""),
        &["{line}: [log] gyro.unit", "unknown unit \"furlong\""],
    ),
    (
        "accelerometer in deg/s",
        CHECK,
        Replace(RIG, "\"m/s\"", "\"deg/s\""),
        &["{line}: [log] accel.unit", "a specific force or a velocity increment"],
    ),
    (
        "time in hours",
        CHECK,
        Replace(RIG, "unit = \"s\"", "unit = \"h\""),
        &["{line}: [log] time.unit: \"h\" is not known", "\"ms\""],
    ),
    (
        "seconds as samples",
        CHECK,
        Replace(RIG, "unit = \"s\"", "unit = \"sample\""),
        &["run.csv:2: column \"time\": 0.03125 is not a whole number of samples"],
    ),
    (
        "unknown stamp",
        CHECK,
        Replace(RIG, "unit = \"s\"", "unit = \"s\", stamp = \"ende\""),
        &["{line}: [log] time.stamp: \"ende\" is not known; did you mean \"end\"?"],
    ),
    (
        "unknown format",
        CHECK,
        Replace(RIG, "rate = ", "format = \"cvs\"\nrate = "),
        &["{line}: [log] format: \"cvs\" is not known; did you mean \"csv\"?"],
    ),
    (
        "a Parquet file that is none",
        CHECK,
        Replace(RIG, "rate = ", "format = \"parquet\"\nrate = "),
        &["run.csv: not a Parquet file, or a damaged one: "],
    ),
    (
        "a file name that tells no format",
        CHECK,
        Replace(RIG, "run.csv", "run.log"),
        &["[log] format: missing"],
    ),
    (
        "no such log",
        CHECK,
        Replace(RIG, "run.csv", "walk.csv"),
        &["cannot read walk.csv", "No such file"],
    ),
    (
        "scale of zero",
        CHECK,
        Replace(RIG, "unit = \"rad\" }", "unit = \"rad\", scale = 0 }"),
        &["{line}: [log] gyro.scale: 0 is not allowed"],
    ),
    (
        "scale as a quantity",
        CHECK,
        Replace(RIG, "unit = \"rad\" }", "unit = \"rad\", scale = \"2 rad\" }"),
        &["{line}: [log] gyro.scale: \"2 rad\" is a text, expected a number"],
    ),
    (
        "an axis twice",
        CHECK,
        Replace(RIG, "unit = \"rad\" }", "unit = \"rad\", axes = [\"x\", \"-x\", \"z\"] }"),
        &["{line}: [log] gyro.axes"],
    ),
    (
        "spin about w",
        CHECK,
        Replace(RIG, "[attitude]", "[axis]\nspin = \"w\"\n\n[attitude]"),
        &["[axis] spin: \"w\" is not allowed, expected a body axis"],
    ),
    (
        "a time column in a psins log",
        CHECK,
        Replace(RIG, "rate = ", "format = \"psins\"\nrate = "),
        &["[log] time: a psins log has no such column"],
    ),
    (
        "temperature in m",
        CHECK,
        Replace(RIG, "rate = ", "temperature = { column = \"time\", unit = \"m\" }\nrate = "),
        &["{line}: [log] temperature.unit", "\"m\""],
    ),
];

/// `[table]`.
const TABLE: &[Row] = &[
    (
        "no table for the paper's filter",
        "calibrate rig.toml --model paper12",
        Replace(RIG, "table_angle = ", "#"),
        &["the calibration needs the table angle or the commanded rate; the log has neither"],
    ),
    (
        "a segment without an end",
        CALIBRATE,
        Replace(RIG, "[attitude]", "[table]\nprofile = [{ rate = \"10 deg/s\" }]\n\n[attitude]"),
        &["[table] profile[1].duration: missing"],
    ),
    (
        "a segment that lasts no time",
        CALIBRATE,
        Replace(
            RIG,
            "[attitude]",
            "[table]\nprofile = [{ rate = \"10 deg/s\", duration = \"0 s\" }]\n\n[attitude]",
        ),
        &["[table] profile[1].duration: \"0 s\""],
    ),
    (
        "a profile that ends before the log",
        CALIBRATE,
        All(&[
            Replace(RIG, "table_angle = ", "#"),
            Replace(
                RIG,
                "[attitude]",
                "[table]\nprofile = [{ rate = \"10 deg/s\", duration = \"20 s\" }]\n\n[attitude]",
            ),
        ]),
        &["run.csv: the log lasts 50.000 s, the [table] profile only 20.000 s"],
    ),
];

#[test]
fn rig_file_that_cannot_be_read() {
    refused(DATA, FILE);
}

#[test]
fn key_that_is_missing_or_unknown() {
    refused(DATA, KEYS);
}

#[test]
fn quantity_that_is_none() {
    refused(DATA, QUANTITIES);
}

#[test]
fn log_keys_that_do_not_fit_the_log() {
    refused(DATA, LOG_KEYS);
}

#[test]
fn table_keys_that_make_no_sense() {
    refused(DATA, TABLE);
}
