//! Rig files: their meaning, and the error messages of invalid ones.

use std::path::Path;

use proptest::prelude::*;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G, PPM};
use rins_io::{LogFormat, Rig};
use rins_testing::assert_close;

use crate::support::{RIG, assert_refused, replaced};

fn parse(text: &str) -> Result<Rig, rins_io::IoError> {
    Rig::parse(text, Path::new("rig.toml"))
}

#[test]
fn quantities_arrive_in_si_units() {
    let rig = parse(RIG).unwrap();
    let station = rig.require_station().unwrap();
    assert_close!(station.site.latitude, 34.25 * DEG, 1e-16);
    assert_close!(station.gravity, 9.7955, 1e-3);
    let attitude = rig.require_attitude().unwrap();
    assert_close!(attitude.angles.roll, 30.0 * DEG, 1e-16);
    assert_close!(attitude.sigma, 0.1 * DEG, 1e-18);
    let imu = rig.require_imu().unwrap();
    assert_close!(imu.gyro.noise_density, 0.02 * DEG_PER_HOUR, 1e-22);
    assert_close!(imu.gyro.misalignment_sigma, 120.0 * ARCSEC, 1e-18);
    assert_close!(imu.accel.bias_sigma, 200.0 * MICRO_G, 1e-18);
    assert_close!(imu.accel.scale_sigma, 300.0 * PPM, 1e-18);
    assert_eq!((imu.gyro.range, imu.gyro.bias_instability), (None, None));
    assert_close!(rig.log.table_angle().unwrap().noise.unwrap(), 0.3 * ARCSEC, 1e-20);
    assert_eq!(rig.log.rate, Some(50.0));
}

#[test]
fn a_psins_rig_needs_no_more_than_a_path() {
    let rig = parse("[log]\npath = \"laser.imu\"\nformat = \"psins\"\n").unwrap();
    assert_eq!((rig.log.format.clone(), rig.station), (LogFormat::Psins, None));
    assert_eq!(
        rig.require_station().unwrap_err().to_string(),
        "rig.toml: [site]: missing, expected latitude, and height or gravity"
    );
    assert_eq!(
        rig.require_attitude().unwrap_err().to_string(),
        "rig.toml: [attitude]: missing, expected roll, pitch, yaw, sigma"
    );
}

#[test]
fn own_gravity_comes_before_normal_gravity() {
    let text =
        replaced(RIG, "height = \"400 m\"", "height = \"400 m\"\ngravity = \"9.7966 m/s^2\"");
    assert_eq!(parse(&text).unwrap().station.unwrap().gravity, 9.7966);
}

#[test]
fn a_table_profile_is_read() {
    let table = "[table]\nacceleration = \"5 deg/s^2\"\nwobble = \"1 arcsec\"\n\
                 profile = [{ rate = \"10 deg/s\", duration = \"1 min\" }]\n";
    let table = parse(&format!("{RIG}{table}")).unwrap().table.unwrap();
    assert_close!(table.profile.unwrap().angle(60.0), (600.0 - 10.0) * DEG, 1e-12);
    assert_close!(table.wobble.unwrap(), ARCSEC, 1e-20);
}

#[test]
fn a_table_profile_is_counted_in_the_sense_that_is_stated() {
    let profile = "profile = [{ rate = \"0 deg/s\", duration = \"5 s\" }, \
                   { rate = \"10 deg/s\", duration = \"1 min\" }]\n";
    let table = |keys: &str| parse(&format!("{RIG}[table]\n{keys}")).map(|rig| rig.table.unwrap());
    for (word, turn) in [("forward", 600.0), ("reversed", -600.0)] {
        let table = table(&format!("sense = \"{word}\"\n{profile}")).unwrap();
        assert_close!(table.profile.unwrap().angle(65.0), turn * DEG, 1e-12);
        assert_close!(table.sense, turn / 600.0, 1e-15);
        assert!(table.segments[0].rate.is_sign_positive());
    }
    let error = table("sense = \"reversed\"\n").unwrap_err().to_string();
    assert!(error.contains("[table] sense") && error.contains("it needs a profile"), "{error}");
    let error = table(&format!("sense = \"backwards\"\n{profile}")).unwrap_err().to_string();
    assert!(error.contains("[table] sense") && error.contains("reversed"), "{error}");
}

#[test]
fn a_run_says_what_it_is_of() {
    let rig = parse(&format!(
        "{RIG}[run]\nid = \"7\"\nserial = \"A7\"\nseries = \"morning\"\nstarted = \"2026-11-26T10:00:00+01:00\"\n\
         since_power_on = \"20 min\"\nnote = \"warm\"\n[lab]\nname = \"L\"\noperator = \"O\"\nprocedure = \"P\"\n"
    ))
    .unwrap();
    let [id, serial, series, note] =
        [&rig.run.id, &rig.run.serial, &rig.run.series, &rig.run.note].map(Option::as_deref);
    assert_eq!([id, serial, series, note], [Some("7"), Some("A7"), Some("morning"), Some("warm")]);
    assert_close!(rig.run.since_power_on.unwrap(), 1200.0, 1e-9);
    let later = parse(&format!("{RIG}[run]\nstarted = \"2026-11-26T09:00:01Z\"\n")).unwrap();
    let seconds = |rig: &Rig| rig.run.started.as_ref().unwrap().seconds;
    assert_close!(seconds(&later) - seconds(&rig), 1.0, 1e-6);
    assert_eq!(rig.laboratory.operator.as_deref(), Some("O"));
    let silent = parse(RIG).unwrap();
    assert_eq!((silent.run, silent.laboratory), Default::default());
}

/// A text in a rig file, its replacement, and the message.
#[rustfmt::skip]
const CASES: &[(&str, &str, &str)] = &[
    // Syntax.
    ("height = \"400 m\"", "height = ", "rig.toml:5: string values must be quoted, expected literal string"),
    ("[attitude]", "[site]", "rig.toml:15: duplicate key"),
    // Sections and keys.
    ("[attitude]", "[atitude]", "rig.toml:15: atitude: unknown key; did you mean \"attitude\"?"),
    ("[attitude]", "[colour]", "rig.toml:15: colour: unknown key, expected one of site, log, attitude, imu, table, axis, run, lab, tolerance"),
    ("[attitude]", "[axis]", "rig.toml:16: [axis] roll: unknown key, expected one of spin"),
    ("[attitude]", "[run]\nserial = \"\"\n[attitude]", "rig.toml:16: [run] serial: \"\" is not allowed, expected a serial number, such as \"FOG-0012\""),
    ("[attitude]", "[run]\nstarted = \"2026-11-26\"\n[attitude]", "rig.toml:16: [run] started: \"2026-11-26\" is not allowed, expected a date and time with its offset from UTC, such as \"2026-11-26T10:00:00Z\""),
    ("[attitude]", "[run]\nstarted = 2026\n[attitude]", "rig.toml:16: [run] started: 2026 is a bare number, expected a date and time with its offset from UTC, such as \"2026-11-26T10:00:00Z\""),
    ("[attitude]", "[run]\nsince_power_on = \"-1 s\"\n[attitude]", "rig.toml:16: [run] since_power_on: \"-1 s\" is out of range, expected zero or more"),
    ("[attitude]", "[run]\nserials = \"7\"\n[attitude]", "rig.toml:16: [run] serials: unknown key; did you mean \"serial\"?"),
    ("[attitude]", "[lab]\noperater = \"N. N.\"\n[attitude]", "rig.toml:16: [lab] operater: unknown key; did you mean \"operator\"?"),
    ("latitude = ", "latitud = ", "rig.toml:3: [site] latitud: unknown key; did you mean \"latitude\"?"),
    ("latitude = \"34.25 deg\"\n", "", "rig.toml:2: [site] latitude: missing, expected a latitude such as \"34.25 deg\""),
    ("sigma = \"0.1 deg\"", "", "rig.toml:15: [attitude] sigma: missing, expected an angle such as \"0.1 deg\""),
    ("noise = \"30 ug/sqrt(Hz)\"", "", "rig.toml:27: [imu.accel] noise: missing, expected an acceleration noise density such as \"30 ug/sqrt(Hz)\""),
    ("path = \"run.csv\"\n", "", "rig.toml:7: [log] path: missing, expected the log's file, such as \"run.csv\""),
    ("path = \"run.csv\"", "path = \"run.bin\"", "rig.toml:7: [log] format: missing, expected \"csv\", \"parquet\", \"mat\", \"psins\", \"psins-bin\", \"kf-gins\", \"euroc\" or \"novatel\" for a file of this name"),
    ("rate = \"50 Hz\"\ntime = { column = \"t\", unit = \"s\" }\n", "", "rig.toml:7: [log] time: missing, expected { column = \"t\", unit = \"s\" }, or a rate where there is no time column"),
    ("time = { column = \"t\", unit = \"s\" }", "time = { column = \"t\" }", "rig.toml:10: [log] time.unit: missing, expected \"s\", \"ms\", \"us\", \"ns\" or \"sample\""),
    ("time = { column = \"t\", unit = \"s\" }", "time = { unit = \"s\" }", "rig.toml:10: [log] time.column: missing, expected a column's name, or its number as in \"1\""),
    ("unit = \"deg\", noise", "noise", "rig.toml:13: [log] table_angle.unit: missing, expected an angle such as \"deg\""),
    // Types.
    ("height = \"400 m\"", "height = 400", "rig.toml:5: [site] height: 400 is a bare number, expected a height such as \"400 m\""),
    ("height = \"400 m\"", "height = true", "rig.toml:5: [site] height: true is a flag, expected a height such as \"400 m\""),
    ("height = \"400 m\"", "height = 1979-05-27", "rig.toml:5: [site] height: 1979-05-27 is a date, expected a height such as \"400 m\""),
    ("height = \"400 m\"", "height = [\"400 m\"]", "rig.toml:5: [site] height: a list, expected a height such as \"400 m\""),
    ("time = { column = \"t\", unit = \"s\" }", "time = \"t\"", "rig.toml:10: [log] time: \"t\" is a text, expected a table with the keys column, columns, unit, stamp"),
    ("[\"gx\", \"gy\", \"gz\"]", "[\"gx\", \"gy\"]", "rig.toml:11: [log] gyro.columns: a list of 2, expected three columns such as [\"x\", \"y\", \"z\"]"),
    ("[\"gx\", \"gy\", \"gz\"]", "[1, 2, 3]", "rig.toml:11: [log] gyro.columns: 1 is a bare number, expected three columns such as [\"x\", \"y\", \"z\"]"),
    ("[\"gx\", \"gy\", \"gz\"]", "\"gx\"", "rig.toml:11: [log] gyro.columns: \"gx\" is a text, expected three columns such as [\"x\", \"y\", \"z\"]"),
    ("[\"gx\", \"gy\", \"gz\"]", "[\"gx\", \"gy\", \"gx\"]", "rig.toml:11: [log] gyro.columns: names a column twice"),
    // Quantities.
    ("noise = \"0.02 deg/h/sqrt(Hz)\"", "noise = \"0.05 deg\"", "rig.toml:22: [imu.gyro] noise: \"0.05 deg\" is an angle, expected a rate noise density such as \"0.02 deg/h/sqrt(Hz)\""),
    ("noise = \"0.02 deg/h/sqrt(Hz)\"", "noise = \"0.05 deg/h\"", "rig.toml:22: [imu.gyro] noise: \"0.05 deg/h\" is an angular rate, expected a rate noise density such as \"0.02 deg/h/sqrt(Hz)\""),
    ("noise = \"0.02 deg/h/sqrt(Hz)\"", "noise = \"0.05\"", "rig.toml:22: [imu.gyro] noise: \"0.05\" has no unit"),
    ("noise = \"0.02 deg/h/sqrt(Hz)\"", "noise = \"0.05 deg/hr/sqrt(Hz)\"", "rig.toml:22: [imu.gyro] noise: \"0.05 deg/hr/sqrt(Hz)\": unknown unit \"hr\"; did you mean \"h\"?"),
    ("noise = \"0.02 deg/h/sqrt(Hz)\"", "noise = \"low\"", "rig.toml:22: [imu.gyro] noise: \"low\" does not begin with a number"),
    ("noise = \"0.02 deg/h/sqrt(Hz)\"", "noise = \"nan deg/h/sqrt(Hz)\"", "rig.toml:22: [imu.gyro] noise: \"nan deg/h/sqrt(Hz)\" is not finite"),
    ("noise = \"30 ug/sqrt(Hz)\"", "noise = \"-30 ug/sqrt(Hz)\"", "rig.toml:28: [imu.accel] noise: \"-30 ug/sqrt(Hz)\" is out of range, expected more than zero"),
    ("bias_sigma = \"200 ug\"", "bias_sigma = \"5 rad/s\"", "rig.toml:29: [imu.accel] bias_sigma: \"5 rad/s\" is an angular rate, expected an acceleration such as \"100 ug\""),
    ("scale_sigma = \"300 ppm\"", "scale_sigma = \"3 mm\"", "rig.toml:30: [imu.accel] scale_sigma: \"3 mm\" is a length, expected a ratio such as \"300 ppm\""),
    ("misalignment_sigma = \"60 arcsec\"", "misalignment_sigma = \"60 ppm\"", "rig.toml:31: [imu.accel] misalignment_sigma: \"60 ppm\" is a ratio, expected an angle such as \"60 arcsec\""),
    ("latitude = \"34.25 deg\"", "latitude = \"95 deg\"", "rig.toml:3: [site] latitude: \"95 deg\" is \
      out of range, expected a latitude from -89.9 to 89.9 deg; the poles at -90 and 90 deg are \
      excluded: east is not defined there"),
    ("longitude = \"108.9 deg\"", "longitude = \"1089 deg\"", "rig.toml:4: [site] longitude: \"1089 deg\" is out of range, expected a longitude from -360 to 360 deg"),
    ("height = \"400 m\"", "height = \"400 km\"", "rig.toml:5: [site] height: \"400 km\" is out of range, expected a height from -1 to 20 km"),
    ("height = \"400 m\"", "height = \"400 m\"\ngravity = \"1 g\"\ngravit = 3", "rig.toml:7: [site] gravit: unknown key; did you mean \"gravity\"?"),
    ("height = \"400 m\"", "height = \"400 m\"\ngravity = \"9.5 m/s^2\"", "rig.toml:6: [site] gravity: \"9.5 m/s^2\" is out of range, expected a gravity from 9.7 to 9.9 m/s^2"),
    ("pitch = \"20 deg\"", "pitch = \"91 deg\"", "rig.toml:17: [attitude] pitch: \"91 deg\" is out of range, expected a pitch from -90 to 90 deg"),
    ("sigma = \"0.1 deg\"", "sigma = \"-0.1 deg\"", "rig.toml:19: [attitude] sigma: \"-0.1 deg\" is out \
      of range, expected more than zero and at most 20 deg; leave [attitude] out if it is less accurate; \
      it is then found by alignment"),
    ("sigma = \"0.1 deg\"", "sigma = \"21 deg\"", "rig.toml:19: [attitude] sigma: \"21 deg\" is out of \
      range, expected more than zero and at most 20 deg; leave [attitude] out if it is less accurate; it \
      is then found by alignment"),
    ("rate = \"50 Hz\"", "rate = \"0 Hz\"", "rig.toml:9: [log] rate: \"0 Hz\" is out of range, expected a sampling rate from 0.001 Hz to 1 MHz"),
    ("rate = \"50 Hz\"", "rate = \"50 rad/s\"", "rig.toml:9: [log] rate: \"50 rad/s\" is an angular rate, expected a sampling rate such as \"50 Hz\""),
    // Units and choices of the log.
    ("unit = \"rad/s\"", "unit = \"m/s\"", "rig.toml:11: [log] gyro.unit: \"m/s\" is a velocity, expected an angular rate or an angle increment such as \"deg/s\""),
    ("unit = \"m/s^2\"", "unit = \"deg\"", "rig.toml:12: [log] accel.unit: \"deg\" is an angle, expected a specific force or a velocity increment such as \"m/s^2\""),
    ("unit = \"m/s^2\"", "unit = \"m/s/s/\"", "rig.toml:12: [log] accel.unit: \"m/s/s/\" is not a product of units such as \"deg/h/sqrt(Hz)\""),
    ("unit = \"deg\", noise", "unit = \"deg/s\", noise", "rig.toml:13: [log] table_angle.unit: \"deg/s\" is an angular rate, expected an angle such as \"deg\""),
    ("unit = \"s\"", "unit = \"sec\"", "rig.toml:10: [log] time.unit: \"sec\" is not known, expected one of \"s\", \"ms\", \"us\", \"ns\", \"sample\""),
    ("unit = \"s\"", "unit = \"samples\"", "rig.toml:10: [log] time.unit: \"samples\" is not known; did you mean \"sample\"?"),
    ("unit = \"s\"", "unit = \"s\", stamp = \"begin\"", "rig.toml:10: [log] time.stamp: \"begin\" is not known, expected one of \"start\", \"middle\", \"end\""),
    ("rate = \"50 Hz\"\ntime = { column = \"t\", unit = \"s\" }", "time = { column = \"t\", unit = \"sample\" }", "rig.toml:7: [log] rate: missing, expected a sampling rate such as \"50 Hz\", as time counts samples"),
    ("unit = \"rad/s\"", "unit = \"rad/s\", axes = [\"x\", \"y\", \"y\"]", "rig.toml:11: [log] gyro.axes: [\"x\", \"y\", \"y\"] is not allowed, expected three axes such as [\"-y\", \"x\", \"z\"], each once"),
    ("unit = \"rad/s\"", "unit = \"rad/s\", scale = 0", "rig.toml:11: [log] gyro.scale: 0 is not allowed, expected factors other than zero"),
    ("unit = \"rad/s\"", "unit = \"rad/s\", scale = inf", "rig.toml:11: [log] gyro.scale: inf is not allowed, expected a number, or one for each column"),
    ("unit = \"rad/s\"", "unit = \"rad/s\", scale = \"2\"", "rig.toml:11: [log] gyro.scale: \"2\" is a text, expected a number, or one for each column"),
    ("path = \"run.csv\"", "path = \"run.csv\"\nformat = \"parket\"", "rig.toml:9: [log] format: \"parket\" is not known; did you mean \"parquet\"?"),
    ("path = \"run.csv\"", "path = \"run.csv\"\nimu = \"LN200\"", "rig.toml:9: [log] imu: only a novatel log's counts depend on the IMU"),
    ("unit = \"m/s^2\"", "unit = \"m/s^2\", time = { column = \"t\", unit = \"s\" }", "rig.toml:12: [log] accel.time: accelerometers in the gyros' file have the gyros' time; give theirs a path"),
    ("path = \"run.csv\"", "path = \"run.csv\"\nformat = \"psin\"", "rig.toml:9: [log] format: \"psin\" is not known; did you mean \"psins\"?"),
    ("path = \"run.csv\"", "path = \"run.imu\"\nformat = \"psins\"", "rig.toml:11: [log] time: a psins log has no such column"),
    ("path = \"run.csv\"", "path = \"run.imu\"\nformat = \"kf-gins\"", "rig.toml:11: [log] time: the time column of a kf-gins log is fixed"),
    // Tables and axes.
    ("[attitude]", "[table]\nprofile = []\n[attitude]", "rig.toml:16: [table] profile: a table profile needs at least one segment"),
    ("[attitude]", "[table]\nprofile = \"fast\"\n[attitude]", "rig.toml:16: [table] profile: \"fast\" is a text, expected a list of tables with the keys rate, angle, duration"),
    ("[attitude]", "[table]\nprofile = [5]\n[attitude]", "rig.toml:16: [table] profile[1]: 5 is a bare number, expected a list of tables with the keys rate, angle, duration"),
    ("[attitude]", "[table]\nprofile = [{ rate = \"1 deg/s\", time = \"1 s\" }]\n[attitude]", "rig.toml:16: [table] profile[1].time: unknown key, expected one of rate, angle, duration"),
    ("[attitude]", "[table]\nprofile = [{ rate = \"1 deg/s\" }]\n[attitude]", "rig.toml:16: [table] profile[1].duration: missing, expected a time such as \"60 s\""),
    ("[attitude]", "[table]\nprofile = [{ rate = \"1 deg/s\", duration = \"0 s\" }]\n[attitude]", "rig.toml:16: [table] profile[1].duration: \"0 s\" is out of range, expected more than zero"),
    ("[attitude]", "[table]\nprofile = [{ rate = \"1 Hz\", duration = \"1 s\" }]\n[attitude]", "rig.toml:16: [table] profile[1].rate: \"1 Hz\" is a frequency, expected an angular rate such as \"10 deg/s\""),
    ("[attitude]", "[table]\nacceleration = \"1 rad/s^2\"\nprofile = [{ rate = \"8 rad/s\", duration = \"4 s\" }]\n[attitude]", "rig.toml:17: [table] profile: segment 1 lasts 4 s, less than the 8 s that its ramp takes"),
    ("[attitude]", "[table]\nacceleration = \"5 deg/s\"\n[attitude]", "rig.toml:16: [table] acceleration: \"5 deg/s\" is an angular rate, expected an angular acceleration such as \"5 deg/s^2\""),
    ("[attitude]", "[axis]\nspin = \"w\"\n[attitude]", "rig.toml:16: [axis] spin: \"w\" is not allowed, expected a body axis such as \"z\" or \"-x\""),
    ("unit = \"deg\", noise", "unit = \"deg\", latency = \"1 m\", noise", "rig.toml:13: [log] table_angle.latency: \"1 m\" is a length, expected a time such as \"1 ms\""),
    ("unit = \"deg\", noise", "unit = \"deg\", sense = \"reverse\", noise", "rig.toml:13: [log] table_angle.sense: \"reverse\" is not known; did you mean \"reversed\"?"),
    ("[attitude]", "temperature = { column = \"T\", unit = \"degF\" }\n[attitude]", "rig.toml:15: [log] temperature.unit: \"degF\" is not known; did you mean \"degC\"?"),
    ("[attitude]", "temperature = { column = \"T\", time = \"t\", unit = \"degC\" }\n[attitude]", "rig.toml:15: [log] temperature.time: a temperature in the log itself has the time of the log"),
];

#[test]
fn wrong_rigs_are_refused_with_file_line_key_and_expectation() {
    assert_refused(RIG, CASES, parse);
    assert!(CASES.len() >= 60);
}

/// Values that no filter can use are refused; quantities that may be absent may be zero.
#[test]
fn zero_is_refused_where_a_filter_divides_by_it_and_nowhere_else() {
    let figures = [
        ("gyro", "noise", "deg/h/sqrt(Hz)"),
        ("gyro", "bias_sigma", "deg/h"),
        ("gyro", "scale_sigma", "ppm"),
        ("gyro", "misalignment_sigma", "arcsec"),
        ("accel", "noise", "ug/sqrt(Hz)"),
        ("accel", "bias_sigma", "ug"),
        ("accel", "scale_sigma", "ppm"),
        ("accel", "misalignment_sigma", "arcsec"),
    ];
    for (triad, key, unit) in figures {
        let imu = RIG.find(&format!("[imu.{triad}]")).unwrap();
        let from = imu + RIG[imu..].find(&format!("\n{key} =")).unwrap() + 1;
        let to = from + RIG[from..].find('\n').unwrap();
        let with = |value: &str| {
            let (before, after) = (&RIG[..from], &RIG[to..]);
            parse(&format!("{before}{key} = \"{value} {unit}\"{after}"))
        };
        assert!(with("1e-9").is_ok(), "{triad} {key}");
        let said = with("0").unwrap_err().to_string();
        let expected =
            format!("[imu.{triad}] {key}: \"0 {unit}\" is out of range, expected more than zero");
        assert!(said.ends_with(&expected), "{said}");
    }
    let noise = parse(&replaced(RIG, "0.3 arcsec", "0 arcsec")).unwrap_err().to_string();
    assert_eq!(
        noise,
        "rig.toml:13: [log] table_angle.noise: \"0 arcsec\" is out of range, expected more than zero"
    );
    let wobble = parse(&format!("{RIG}[table]\nwobble = \"0 arcsec\"\n")).unwrap_err().to_string();
    assert!(
        wobble.ends_with("[table] wobble: \"0 arcsec\" is out of range, expected more than zero")
    );
    assert!(parse(&replaced(RIG, "sigma = \"0.1 deg\"", "sigma = \"0 deg\"")).is_err());
    assert!(parse(&replaced(RIG, "sigma = \"0.1 deg\"", "sigma = \"20 deg\"")).is_ok());
    let absent = "noise = \"0.3 arcsec\", resolution = \"0 arcsec\"";
    assert!(parse(&replaced(RIG, "noise = \"0.3 arcsec\"", absent)).is_ok());
    let flicker = "[imu.gyro]\nbias_instability = \"0 deg/h\"\nrandom_walk = \"0 deg/h/sqrt(h)\"";
    assert!(parse(&replaced(RIG, "[imu.gyro]", flicker)).is_ok());
}

#[test]
fn latitudes_end_before_the_poles() {
    for (latitude, is_read) in
        [("89.9", true), ("-89.9", true), ("0", true), ("90", false), ("-89.91", false)]
    {
        let text = replaced(RIG, "34.25 deg", &format!("{latitude} deg"));
        assert_eq!(parse(&text).is_ok(), is_read, "{latitude}");
    }
}

#[test]
fn rigs_without_their_sections_are_refused() {
    assert_eq!(
        parse("").unwrap_err().to_string(),
        "rig.toml: [log]: missing, expected path, time, gyro and accel"
    );
    let site = &RIG[RIG.find("[site]").unwrap()..RIG.find("[log]").unwrap()];
    assert_eq!(
        parse(&replaced(RIG, site, "")).unwrap_err().to_string(),
        "rig.toml: [site]: missing, expected latitude, and height or gravity"
    );
    let accel = &RIG[RIG.find("[imu.accel]").unwrap()..];
    assert_eq!(
        parse(&replaced(RIG, accel, "")).unwrap_err().to_string(),
        "rig.toml:21: [imu] accel: missing, expected a section [imu.accel], or a grade of the IMU"
    );
}

#[test]
fn files_that_are_no_rigs_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rig.toml");
    let refusal = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        crate::support::without(&Rig::read(&path).unwrap_err(), folder.path())
    };
    assert_eq!(refusal(b"\xff\xfe[\0s\0"), "rig.toml: not UTF-8 text");
    assert_eq!(
        refusal(&vec![b'#'; (1 << 20) + 1]),
        "rig.toml: more than 1048576 bytes, too large for a file of keys"
    );
    let absent = Rig::read(&folder.path().join("absent.toml")).unwrap_err();
    assert_eq!(crate::support::without(&absent, folder.path()), "cannot read absent.toml");
    assert!(std::error::Error::source(&absent).is_some());
}

#[test]
fn nesting_without_end_is_refused() {
    for text in [
        "a = ".to_string() + &"[".repeat(200_000),
        "a = ".to_string() + &"{ a = ".repeat(100_000),
        "a.".repeat(200_000) + "a = 1",
        "[".to_string() + &"a.".repeat(200_000) + "a]",
        format!("x = {}1{}", "[".repeat(50), "]".repeat(50)),
    ] {
        assert!(parse(&text).is_err());
    }
}

proptest! {
    #[test]
    fn any_spoilt_rig_is_read_or_refused(
        places in prop::collection::vec((0..RIG.len(), "[-a-z0-9 \"'=.{}\\[\\]\n#µ]?"), 1..6),
    ) {
        let mut text = RIG.to_string();
        for (place, letter) in places {
            let place = (0..=place.min(text.len())).rev().find(|&at| text.is_char_boundary(at));
            let place = place.unwrap_or(0);
            let end = (place..text.len()).skip(1).find(|&at| text.is_char_boundary(at));
            text.replace_range(place..end.unwrap_or(text.len()), &letter);
        }
        if let Err(error) = parse(&text) {
            prop_assert!(error.to_string().starts_with("rig.toml:"));
        }
    }
}
