//! Scenario files: their meaning, their output, and the error messages of invalid ones.

use std::path::Path;

use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G, PPM};
use rins_imu::Quantisation;
use rins_io::{IoError, ScenarioFile, read};
use rins_simulation::{TableRecord, Temperature, simulate};
use rins_testing::{assert_close, assert_rows, data_sheets, is, site};

use crate::support::{assert_refused, replaced};

const SCENARIO: &str = concat!(
    "\n",
    site!(),
    r#"
[log]
rate = "50 Hz"
table_angle = { noise = "0.3 arcsec", resolution = "0.1 arcsec" }

[attitude]
roll = "30 deg"
pitch = "20 deg"
yaw = "40 deg"
sigma = "0.1 deg"

[table]
acceleration = "5.0 deg/s^2" # as written
profile = [
    { rate = "0 deg/s", duration = "2 s" },
    { rate = "10 deg/s", duration = "8 s" },
]

"#,
    data_sheets!(),
    r#"
[truth]
seed = 7
temperature = "20 degC"

[truth.attitude]
roll = "30.01 deg"
pitch = "19.98 deg"
yaw = "40.03 deg"

[truth.gyro]
bias = ["0.05 deg/h", "0 deg/h", "-0.05 deg/h"]
scale = ["0 ppm", "0 ppm", "300 ppm"]
misalignment = { xz = "60 arcsec", zy = "-5 arcsec" }
resolution = "0.01 arcsec"

[truth.accel]
bias = ["100 ug", "0 ug", "0 ug"]
"#
);

fn parse(text: &str) -> Result<ScenarioFile, IoError> {
    ScenarioFile::parse(text, Path::new("scenario.toml"))
}

#[test]
fn the_truth_arrives_in_si_units() {
    let scenario = parse(SCENARIO).unwrap().scenario;
    let gyro = &scenario.imu_error.gyro;
    assert_close!(gyro.bias.z, -0.05 * DEG_PER_HOUR, 1e-22);
    assert_close!(gyro.matrix[(2, 2)], 300.0 * PPM, 1e-19);
    assert_close!(gyro.matrix[(0, 2)], 60.0 * ARCSEC, 1e-19);
    assert_close!(gyro.matrix[(2, 1)], -5.0 * ARCSEC, 1e-20);
    assert_eq!(gyro.matrix[(1, 2)], 0.0);
    assert_close!(scenario.imu_error.accel.bias.x, 100.0 * MICRO_G, 1e-18);
    assert_close!(scenario.nav_from_table.euler_angles().roll, 30.01 * DEG, 1e-15);
    assert_eq!(
        (scenario.interval, scenario.seed.seed, scenario.temperature),
        (0.02, 7, Some(Temperature::Constant(20.0)))
    );
    let noise = scenario.noise.unwrap();
    assert_close!(noise.gyro.white_density, 0.02 * DEG_PER_HOUR, 1e-22);
    let Some(Quantisation::Increment(bit)) = noise.gyro.quantisation else { panic!("a bit") };
    assert_close!(bit, 0.01 * ARCSEC, 1e-22);
    let TableRecord::Angle(encoder) = scenario.table else { panic!("an angle") };
    assert_close!(encoder.noise, 0.3 * ARCSEC, 1e-20);
    assert_close!(encoder.resolution.unwrap(), 0.1 * ARCSEC, 1e-20);
    assert_close!(scenario.profile.duration(), 10.0, 1e-12);
}

#[test]
fn the_temperature_may_go_its_way() {
    let read = |table: &str| {
        let text = replaced(
            SCENARIO,
            "temperature = \"20 degC\"",
            &format!("temperature = {{ {table} }}"),
        );
        parse(&text)
            .map(|file| file.scenario.temperature.unwrap())
            .map_err(|error| error.to_string())
    };
    let Ok(Temperature::Ramp { start, rate }) = read(r#"start = "20 degC", ramp = "36 K/h""#)
    else {
        panic!("a ramp")
    };
    assert_eq!(start, 20.0);
    assert_close!(rate, 0.01, 1e-17);
    assert_eq!(
        read(r#"start = "20 degC", rise = "8 K", time_constant = "10 min""#),
        Ok(Temperature::WarmUp { start: 20.0, rise: 8.0, time_constant: 600.0 })
    );
    assert_eq!(
        read(r#"start = "-5 degC", amplitude = "2 K", period = "1 h""#),
        Ok(Temperature::Sinus { start: -5.0, amplitude: 2.0, period: 3600.0 })
    );
    let refused = [
        (r#"ramp = "2 K/h""#, "start: missing, expected a temperature such as \"20 degC\""),
        (
            r#"start = "20 degC""#,
            "ramp: missing, expected one of ramp, rise with time_constant, amplitude with period",
        ),
        (r#"start = "20 degC", ramp = "2 K/h", period = "1 h""#, "period: does not go with ramp"),
        (
            r#"start = "20 degC", ramp = "2 K""#,
            "ramp: \"2 K\" is a temperature, expected a rate of temperature such as \"2 K/h\"",
        ),
        (
            r#"start = "20 degC", rise = "2 K""#,
            "time_constant: missing, expected a time such as \"60 s\"",
        ),
        (
            r#"start = "20 degC", amplitude = "2 K", period = "0 s""#,
            "period: \"0 s\" is out of range, expected more than zero",
        ),
        (
            r#"start = "293 K", ramp = "2 K/h""#,
            "start: \"293 K\" is not allowed, expected a temperature such as \"20 degC\"",
        ),
        (
            r#"start = "20 degC", slope = "2 K/h""#,
            "slope: unknown key, expected one of start, ramp, rise, time_constant, amplitude, period",
        ),
    ];
    assert_rows(refused.map(|(table, message)| {
        let message = format!("scenario.toml:38: [truth] temperature.{message}");
        (table, is(&read(table).unwrap_err(), &message))
    }));
}

const EFFECTS: &str = r#"effects = [
    { id = "encoder.zero", angle = "2 arcmin" },
    { id = "axis.attitude", x = "5 arcsec", z = "-1 mrad" },
]
"#;

/// About another axis of the IMU the truth is along its own axes, and that of the run along those of the table.
#[test]
fn truth_is_along_the_axes_of_the_imu() {
    let effect = "effects = [{ id = \"gyro_g_sensitivity\", zx = \"1 deg/h/g\" }]\n";
    let text = replaced(SCENARIO, "seed = 7\n", &format!("seed = 7\n{effect}"));
    let about_z = parse(&text).unwrap();
    let about_x = parse(&format!("{text}\n[axis]\nspin = \"-x\"\n")).unwrap();
    assert_eq!(about_x.spin.spin_name(), "-x");
    // x, y and z of the run are y, -z and -x of the IMU.
    let (own, run) = (about_z.scenario.imu_error.gyro, about_x.scenario.imu_error.gyro);
    assert_close!(run.bias[2], -own.bias[0], 1e-22);
    assert_close!(run.matrix[(1, 1)], own.matrix[(2, 2)], 1e-18);
    assert_close!(run.matrix[(2, 1)], own.matrix[(0, 2)], 1e-18);
    assert_eq!(
        about_x.scenario.effects.value("gyro_g_sensitivity.yz"),
        about_z.scenario.effects.value("gyro_g_sensitivity.zx")
    );
    let truth = |file: &ScenarioFile| -> Vec<(String, f64)> {
        let truth: serde_json::Value = serde_json::from_str(&file.truth_json()).unwrap();
        let effects = truth["effects"][0]["parameters"].as_array().unwrap();
        let all = truth["parameters"].as_array().unwrap().iter().chain(effects);
        all.map(|one| (one["id"].as_str().unwrap().into(), one["value"].as_f64().unwrap()))
            .collect()
    };
    for ((id, value), (other, same)) in truth(&about_z).into_iter().zip(truth(&about_x)) {
        assert_eq!(id, other);
        assert_close!(value, same, 1e-12 * (1.0 + value.abs()));
    }
}

#[test]
fn effects_arrive_in_si_units() {
    let effects =
        parse(&replaced(SCENARIO, "seed = 7\n", &format!("seed = 7\n{EFFECTS}"))).unwrap();
    let effects = effects.scenario.effects;
    let ids: Vec<&str> = effects.terms.iter().map(|chosen| chosen.term.id).collect();
    assert_eq!(ids, ["encoder.zero", "axis.attitude"]);
    assert_close!(effects.value("encoder.zero.angle").unwrap(), 120.0 * ARCSEC, 1e-18);
    assert_close!(effects.value("axis.attitude.x").unwrap(), 5.0 * ARCSEC, 1e-19);
    assert_eq!(effects.value("axis.attitude.y"), Some(0.0));
    assert_close!(effects.value("axis.attitude.z").unwrap(), -1e-3, 1e-18);
}

#[test]
fn the_truth_of_a_run_tells_its_effects() {
    let file = parse(&replaced(SCENARIO, "seed = 7\n", &format!("seed = 7\n{EFFECTS}"))).unwrap();
    let truth: serde_json::Value = serde_json::from_str(&file.truth_json()).unwrap();
    let effects = truth["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 2);
    assert_eq!(effects[0]["id"], "encoder.zero");
    let parameters = effects[1]["parameters"].as_array().unwrap();
    let ids: Vec<&str> = parameters.iter().map(|p| p["id"].as_str().unwrap()).collect();
    assert_eq!(ids, ["axis.attitude.x", "axis.attitude.y", "axis.attitude.z"]);
    assert_eq!(parameters[0]["unit"], "arcsec");
    assert_close!(parameters[0]["value"].as_f64().unwrap(), 5.0, 1e-12);
    let rig = file.rig_toml(&simulate(&file.scenario).unwrap().recording);
    assert!(!rig.contains("effects") && !rig.contains("encoder.zero"), "{rig}");
}

#[test]
fn noise_can_be_switched_off() {
    let off = "[truth.noise]\ngyro = \"off\"\naccel = \"off\"\ntable_angle = \"off\"\n";
    let text = replaced(SCENARIO, "resolution = \"0.01 arcsec\"", "");
    let scenario = parse(&format!("{text}{off}")).unwrap().scenario;
    assert_eq!(scenario.noise, None);
    let TableRecord::Angle(encoder) = scenario.table else { panic!("an angle") };
    assert_eq!((encoder.noise, encoder.resolution), (0.0, None));
    // Without a data sheet all noise must be switched off.
    let imu = &text[text.find("[imu.gyro]").unwrap()..text.find("[truth]").unwrap()];
    let bare = replaced(&text, imu, "");
    assert!(parse(&format!("{bare}{off}")).is_ok());
    assert_eq!(
        parse(&bare).unwrap_err().to_string(),
        "scenario.toml: [imu.gyro]: missing, expected the gyros' data sheet figures noise, \
         bias_sigma, scale_sigma and misalignment_sigma, or [imu] grade"
    );
}

#[test]
fn what_the_table_records_is_what_the_log_asks_for() {
    let angle = "table_angle = { noise = \"0.3 arcsec\", resolution = \"0.1 arcsec\" }\n";
    let none = replaced(SCENARIO, angle, "");
    assert_eq!(parse(&none).unwrap().scenario.table, TableRecord::Nothing);
    let rate = replaced(SCENARIO, angle, "table_rate = {}\n");
    assert_eq!(parse(&rate).unwrap().scenario.table, TableRecord::CommandedRate);
}

#[test]
fn a_simulated_run_is_read_back_to_the_last_bit() {
    for log in ["table_angle = { noise = \"1 arcsec\" }", "table_rate = {}", ""] {
        let angle = "table_angle = { noise = \"0.3 arcsec\", resolution = \"0.1 arcsec\" }";
        let file = parse(&replaced(SCENARIO, angle, log)).unwrap();
        let recording = simulate(&file.scenario).unwrap().recording;
        let folder = tempfile::tempdir().unwrap();
        file.write_run(&recording, folder.path()).unwrap();
        let mut again = read(&folder.path().join("rig.toml")).unwrap();
        if log.is_empty() {
            // The rig's profile then replaces the recorded table rate.
            assert!(again.recording.table_rate.take().is_some());
        }
        assert_eq!(again.recording, recording);
        assert_eq!(again.station, file.scenario.station);
    }
}

#[test]
fn the_rig_of_a_run_keeps_what_was_written() {
    let file = parse(SCENARIO).unwrap();
    let recording = simulate(&file.scenario).unwrap().recording;
    let expected = concat!(
        r#"# A simulated run: site, log and IMU.

"#,
        site!(),
        r#"
[log]
path = "run.csv"
rate = "50 Hz"
time = { column = "time", unit = "s" }
gyro = { columns = ["gyro_x", "gyro_y", "gyro_z"], unit = "rad" }
accel = { columns = ["accel_x", "accel_y", "accel_z"], unit = "m/s" }
table_angle = { column = "table_angle", unit = "rad", noise = "0.3 arcsec", resolution = "0.1 arcsec" }
temperature = { column = "temperature", unit = "degC" }

[attitude]
roll = "30 deg"
pitch = "20 deg"
yaw = "40 deg"
sigma = "0.1 deg"

[table]
acceleration = "5.0 deg/s^2"
profile = [
    { rate = "0 deg/s", duration = "2 s" },
    { rate = "10 deg/s", duration = "8 s" },
]

"#,
        data_sheets!()
    );
    assert_eq!(file.rig_toml(&recording), expected);
}

#[test]
fn the_truth_of_a_run_names_every_parameter() {
    let file = parse(SCENARIO).unwrap();
    let truth: serde_json::Value = serde_json::from_str(&file.truth_json()).unwrap();
    assert_eq!((&truth["schema"], &truth["seed"]), (&1.into(), &7.into()));
    assert_close!(truth["attitude_deg"]["yaw"].as_f64().unwrap(), 40.03, 1e-12);
    let parameters = truth["parameters"].as_array().unwrap();
    assert_eq!(parameters.len(), 24);
    let find = |id: &str| parameters.iter().find(|parameter| parameter["id"] == id).unwrap();
    assert_close!(find("gyro.misalignment.xz")["value"].as_f64().unwrap(), 60.0, 1e-12);
    assert_eq!(find("gyro.misalignment.xz")["unit"], "arcsec");
    assert_close!(find("accel.bias.x")["value"].as_f64().unwrap(), 100.0, 1e-12);
    assert_eq!(find("accel.bias.x")["unit"], "ug");
    assert_close!(find("gyro.bias.z")["value"].as_f64().unwrap(), -0.05, 1e-15);
    assert_eq!(find("gyro.bias.z")["unit"], "deg/h");
}

#[rustfmt::skip]
const CASES: &[(&str, &str, &str)] = &[
    ("seed = 7\n", "", "scenario.toml:36: [truth] seed: missing, expected a whole number from 0"),
    ("seed = 7", "seed = -7", "scenario.toml:37: [truth] seed: -7 is not allowed, expected a whole number from 0"),
    ("seed = 7", "seed = 7.5", "scenario.toml:37: [truth] seed: 7.5 is not allowed, expected a whole number from 0"),
    ("seed = 7", "seed = \"7\"", "scenario.toml:37: [truth] seed: \"7\" is a text, expected a whole number from 0"),
    ("seed = 7", "seeds = 7", "scenario.toml:37: [truth] seeds: unknown key; did you mean \"seed\"?"),
    ("temperature = \"20 degC\"", "temperature = \"293 K\"", "scenario.toml:38: [truth] temperature: \"293 K\" is not allowed, expected a temperature such as \"20 degC\""),
    ("temperature = \"20 degC\"", "temperature = \"warm\"", "scenario.toml:38: [truth] temperature: \"warm\" does not begin with a number"),
    ("[\"100 ug\", \"0 ug\", \"0 ug\"]", "[\"100 ug\", \"0 deg/h\", \"0 ug\"]", "scenario.toml:52: [truth.accel] bias[2]: \"0 deg/h\" is an angular rate, expected an acceleration such as \"100 ug\""),
    ("[\"100 ug\", \"0 ug\", \"0 ug\"]", "[\"100 ug\"]", "scenario.toml:52: [truth.accel] bias: a list of 1, expected three quantities such as [\"100 ug\", \"100 ug\", \"100 ug\"]"),
    ("[\"100 ug\", \"0 ug\", \"0 ug\"]", "[\"100 ug\", 0, 0]", "scenario.toml:52: [truth.accel] bias[2]: 0 is a bare number, expected an acceleration such as \"100 ug\""),
    ("xz = \"60 arcsec\"", "xx = \"60 arcsec\"", "scenario.toml:48: [truth.gyro] misalignment.xx: unknown key; did you mean \"xy\"?"),
    ("xz = \"60 arcsec\"", "xz = \"60 ppm\"", "scenario.toml:48: [truth.gyro] misalignment.xz: \"60 ppm\" is a ratio, expected an angle such as \"60 arcsec\""),
    ("resolution = \"0.01 arcsec\"", "resolution = \"0.01 m\"", "scenario.toml:49: [truth.gyro] resolution: \"0.01 m\" is a length, expected an angle increment such as \"0.1 arcsec\""),
    ("resolution = \"0.01 arcsec\"", "resolution = \"0 deg/s\"", "scenario.toml:49: [truth.gyro] resolution: \"0 deg/s\" is out of range, expected more than zero"),
    ("[truth.accel]", "[truth.noise]\ngyro = \"no\"\n[truth.accel]", "scenario.toml:52: [truth.noise] gyro: \"no\" is not known; did you mean \"on\"?"),
    ("[truth.accel]", "[[truth.effects]]\nid = \"encoder.zeros\"\n[truth.accel]", "scenario.toml:52: [truth] effects[1].id: \"encoder.zeros\" is not known; did you mean \"encoder.zero\"?"),
    ("[truth.accel]", "[[truth.effects]]\nid = \"flux_capacitor\"\n[truth.accel]", "scenario.toml:52: [truth] effects[1].id: \"flux_capacitor\" is not known, expected one of the ids of the catalogue, such as \"encoder.zero\""),
    ("[truth.accel]", "[[truth.effects]]\nangle = \"1 deg\"\n[truth.accel]", "scenario.toml:51: [truth] effects[1].id: missing, expected the id of a term such as \"encoder.zero\""),
    ("[truth.accel]", "[[truth.effects]]\nid = \"mounting\"\n[truth.accel]", "scenario.toml:51: [truth] effects[1].x: missing, expected at least one of x, y"),
    ("[truth.accel]", "[[truth.effects]]\nid = \"mounting\"\nz = \"1 deg\"\n[truth.accel]", "scenario.toml:53: [truth] effects[1].z: unknown key, expected one of x, y, id"),
    ("[truth.accel]", "[[truth.effects]]\nid = \"mounting\"\nx = \"1 deg\"\nestimate = true\n[truth.accel]", "scenario.toml:54: [truth] effects[1].estimate: unknown key, expected one of x, y, id"),
    ("[truth.accel]", "[[truth.effects]]\nid = \"mounting\"\nx = \"1 mm\"\n[truth.accel]", "scenario.toml:53: [truth] effects[1].x: \"1 mm\" is a length, expected an angle such as \"1 arcsec\""),
    ("[truth.accel]", "[[truth.effects]]\nid = \"mounting\"\nx = 1\n[truth.accel]", "scenario.toml:53: [truth] effects[1].x: 1 is a bare number, expected an angle such as \"1 arcsec\""),
    ("[truth.accel]", "[[truth.effects]]\nid = \"gyro.scale\"\nx = \"1 ppm\"\n[truth.accel]", "scenario.toml:52: [truth] effects[1].id: gyro.scale stands in [truth.gyro]"),
    ("seed = 7", "seed = 7\neffects = \"none\"", "scenario.toml:38: [truth] effects: \"none\" is a text, expected a list of tables such as { id = \"encoder.zero\", angle = \"5 arcsec\" }"),
    ("rate = \"50 Hz\"\n", "", "scenario.toml:7: [log] rate: missing, expected a sampling rate such as \"50 Hz\""),
    ("rate = \"50 Hz\"", "rate = \"50 Hz\"\npath = \"../run.csv\"", "scenario.toml:9: [log] path: \"../run.csv\" is not allowed, expected the name of a csv file, such as \"run.csv\""),
    ("rate = \"50 Hz\"", "rate = \"50 Hz\"\nformat = \"psins\"", "scenario.toml:9: [log] format: \"psins\" is not allowed, expected \"csv\""),
    ("noise = \"0.3 arcsec\",", "latency = \"1 ms\",", "scenario.toml:9: [log] table_angle.latency: is not simulated; list the effect encoder_latency instead"),
    ("[table]", "[axis]\nspin = \"w\"\n[table]", "scenario.toml:18: [axis] spin: \"w\" is not allowed, expected a body axis such as \"z\" or \"-x\""),
    ("[truth.attitude]", "[truth.atitude]", "scenario.toml:40: [truth] atitude: unknown key; did you mean \"attitude\"?"),
    ("yaw = \"40.03 deg\"\n", "", "scenario.toml:40: [truth.attitude] yaw: missing, expected an angle such as \"30 deg\""),
];

#[test]
fn true_errors_may_be_zero() {
    let zero = "[truth]\nseed = 7\n\n[truth.gyro]\nbias = [\"0 deg/h\", \"0 deg/h\", \"0 deg/h\"]\n\
                scale = [\"0 ppm\", \"0 ppm\", \"0 ppm\"]\nmisalignment = { xz = \"0 arcsec\" }\n\n\
                [truth.accel]\nbias = [\"0 ug\", \"0 ug\", \"0 ug\"]\n\n\
                [truth.noise]\ngyro = \"off\"\naccel = \"off\"\ntable_angle = \"off\"\n";
    let text = format!("{}{zero}", &SCENARIO[..SCENARIO.find("[truth]").unwrap()]);
    let scenario = parse(&text).unwrap().scenario;
    assert_eq!(scenario.imu_error, rins_imu::ImuError::default());
    assert_eq!(scenario.noise, None);
}

#[test]
fn wrong_scenarios_are_refused_with_file_line_key_and_expectation() {
    assert_refused(SCENARIO, CASES, parse);
}

#[test]
fn scenarios_without_their_sections_are_refused() {
    let without = |from: &str, to: &str| {
        let (start, end) = (SCENARIO.find(from).unwrap(), SCENARIO.find(to).unwrap());
        parse(&format!("{}{}", &SCENARIO[..start], &SCENARIO[end..])).unwrap_err().to_string()
    };
    assert_eq!(
        without("[site]", "[log]"),
        "scenario.toml: [site]: missing, expected latitude, longitude and height"
    );
    assert_eq!(
        without("[log]", "[attitude]"),
        "scenario.toml: [log]: missing, expected a sampling rate such as \"50 Hz\""
    );
    assert_eq!(
        without("[table]", "[imu.gyro]"),
        "scenario.toml: [table] profile: missing, expected a list such as \
         [{ rate = \"10 deg/s\", duration = \"60 s\" }]"
    );
    let head = &SCENARIO[..SCENARIO.find("[truth]").unwrap()];
    assert_eq!(
        parse(head).unwrap_err().to_string(),
        "scenario.toml: [truth]: missing, expected at least a seed"
    );
}
