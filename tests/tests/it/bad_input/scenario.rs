//! Invalid scenarios.

use super::files::Spoil::{Content, Nothing, Replace};
use super::{DATA, Row, refused};

const FILE: &str = "scenario.toml";
const SIMULATE: &str = "simulate scenario.toml";
const GYRO: &str = "gyro = { scale = [\"0 ppm\", \"0 ppm\", \"300 ppm\"] }";

const SCENARIOS: &[Row] = &[
    ("no file", "simulate no.toml", Nothing, &["cannot read no.toml", "No such file"]),
    ("empty", SIMULATE, Content(FILE, b""), &["scenario.toml: [site]: missing"]),
    (
        "a rig",
        "simulate rig.toml",
        Nothing,
        &["rig.toml: [truth]: missing, expected at least a seed"],
    ),
    (
        "no seed",
        SIMULATE,
        Replace(FILE, "seed = 1", ""),
        &["[truth] seed: missing, expected a whole number from 0"],
    ),
    (
        "a negative seed",
        SIMULATE,
        Replace(FILE, "seed = 1", "seed = -1"),
        &["scenario.toml:{line}: [truth] seed: -1 is not allowed"],
    ),
    (
        "a seed with a point",
        SIMULATE,
        Replace(FILE, "seed = 1", "seed = 1.5"),
        &["{line}: [truth] seed: 1.5 is not allowed"],
    ),
    (
        "an unknown effect",
        SIMULATE,
        Replace(FILE, "seed = 1", "seed = 1\neffects = [{ id = \"flux_capacitor\" }]"),
        &["[truth] effects[1].id: \"flux_capacitor\" is not known, expected one of the ids"],
    ),
    (
        "an effect misspelt",
        SIMULATE,
        Replace(FILE, "seed = 1", "seed = 1\neffects = [{ id = \"encoder.zer\" }]"),
        &["effects[1].id: \"encoder.zer\" is not known; did you mean \"encoder.zero\"?"],
    ),
    (
        "a parameter that an effect does not have",
        SIMULATE,
        Replace(FILE, "seed = 1", "seed = 1\neffects = [{ id = \"mounting\", z = \"1 deg\" }]"),
        &["effects[1].z: unknown key, expected one of x, y, id"],
    ),
    (
        "an effect in the wrong unit",
        SIMULATE,
        Replace(FILE, "seed = 1", "seed = 1\neffects = [{ id = \"mounting\", x = \"1 ppm\" }]"),
        &["effects[1].x: \"1 ppm\" is a ratio, expected an angle such as \"1 arcsec\""],
    ),
    (
        "a temperature that goes two ways",
        SIMULATE,
        Replace(
            FILE,
            "seed = 1",
            "seed = 1\ntemperature = { start = \"20 degC\", ramp = \"1 K/h\", rise = \"2 K\" }",
        ),
        &["[truth] temperature.rise: does not go with ramp"],
    ),
    (
        "an unknown key",
        SIMULATE,
        Replace(FILE, GYRO, "giro = {}"),
        &["{line}: [truth] giro: unknown key; did you mean \"gyro\"?"],
    ),
    (
        "an unknown misalignment",
        SIMULATE,
        Replace(FILE, GYRO, "gyro = { misalignment = { zz = \"1 arcsec\" } }"),
        &["{line}: [truth.gyro] misalignment.zz: unknown key"],
    ),
    (
        "two scales",
        SIMULATE,
        Replace(FILE, "\"0 ppm\", ", ""),
        &["{line}: [truth.gyro] scale: a list of 2"],
    ),
    (
        "a scale in arcsec",
        SIMULATE,
        Replace(FILE, "\"300 ppm\"]", "\"300 arcsec\"]"),
        &["{line}: [truth.gyro] scale[3]", "\"300 arcsec\""],
    ),
    (
        "noise that may be",
        SIMULATE,
        Replace(FILE, GYRO, "noise = { gyro = \"maybe\" }"),
        &["{line}: [truth.noise] gyro: \"maybe\" is not known, expected one of \"on\", \"off\""],
    ),
    ("no profile", SIMULATE, Replace(FILE, "profile = ", "#"), &["[table] profile: missing"]),
    (
        "an empty profile",
        SIMULATE,
        Replace(FILE, "profile = [", "profile = [] #"),
        &["scenario.toml"],
    ),
    (
        "a negative duration",
        SIMULATE,
        Replace(FILE, "30 s", "-30 s"),
        &["{line}: [table] profile[2].duration: \"-30 s\""],
    ),
    (
        "a run longer than memory",
        SIMULATE,
        Replace(FILE, "30 s", "1e11 s"),
        &["scenario.toml: the run would hold 32", " samples; shorten it or lengthen the interval"],
    ),
    (
        "a rate beyond reason",
        SIMULATE,
        Replace(FILE, "\"32 Hz\"", "\"1e30 Hz\""),
        &["{line}: [log] rate: \"1e30 Hz\""],
    ),
    (
        "a table faster than reason",
        SIMULATE,
        Replace(FILE, "10 deg/s", "1e9 deg/s"),
        &["scenario.toml:{line}: [table] profile: segment 2 has a rate of 17453292.5"],
    ),
    (
        "a table faster than its log",
        SIMULATE,
        Replace(FILE, "10 deg/s", "12000 deg/s"),
        &[
            "scenario.toml: at 20 s the table rotates at 209.4",
            "one revolution per sample of 0.03125 s",
        ],
    ),
    (
        "latency",
        SIMULATE,
        Replace(FILE, "resolution = \"0.01 arcsec\"", "latency = \"1 ms\""),
        &[
            "{line}: [log] table_angle.latency: is not simulated; list the effect encoder_latency instead",
        ],
    ),
    (
        "a log outside of the folder",
        SIMULATE,
        Replace(FILE, "rate = \"32 Hz\"", "rate = \"32 Hz\"\npath = \"../../run.csv\""),
        &["[log] path: \"../../run.csv\" is not allowed, expected the name of a csv file"],
    ),
    (
        "a spin axis of a campaign",
        "monte-carlo scenario.toml --runs 2 -o runs.parquet",
        Replace(FILE, "[attitude]", "[axis]\nspin = \"x\"\n\n[attitude]"),
        &["[axis] spin: a campaign simulates runs about z; leave this out"],
    ),
    (
        "no attitude",
        SIMULATE,
        Replace(
            FILE,
            "[attitude]\nroll = \"30 deg\"\npitch = \"20 deg\"\nyaw = \"40 deg\"\nsigma = \"0.05 deg\"\n",
            "",
        ),
        &["[truth] attitude: missing, expected roll, pitch and yaw"],
    ),
    (
        "no data sheet",
        SIMULATE,
        Replace(FILE, "[imu.gyro]", "[imu.giro]"),
        &["{line}: [imu] giro: unknown key; did you mean \"gyro\"?"],
    ),
    (
        "a temperature in kelvin",
        SIMULATE,
        Replace(FILE, "seed = 1", "seed = 1\ntemperature = \"300 K\""),
        &["[truth] temperature: \"300 K\" is not allowed", "degC"],
    ),
];

#[test]
fn scenario_that_makes_no_sense() {
    refused(DATA, SCENARIOS);
}
