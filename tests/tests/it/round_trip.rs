//! A simulated run that is written, read and calibrated gives bit-identical results.

use std::fs;
use std::path::Path;

use rins_calibration::{AxisAttitude, Calibration, Setup, TableSpec, calibrate, likely_wobble};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G, PPM};
use rins_frames::{EulerAngles, Site};
use rins_imu::{ImuSpec, TriadSpec};
use rins_io::ScenarioFile;
use rins_motion::{Recording, Station};
use rins_simulation::simulate;
use rins_testing::{assert_close, data_sheets, site};
use serde_json::Value;

use crate::support::{list, number, numbers, result_in};

/// Two rates and a reversal after a static interval; `table` is the recorded table signal.
fn scenario(table: &str) -> String {
    format!(
        r#"{site}
[log]
rate = "20 Hz"
{table}

[table]
acceleration = "5 deg/s^2"
profile = [
    {{ rate = "0 deg/s", duration = "20 s" }},
    {{ rate = "10 deg/s", duration = "60 s" }},
    {{ rate = "-15 deg/s", duration = "40 s" }},
]

[attitude]
roll = "30 deg"
pitch = "20 deg"
yaw = "40 deg"
sigma = "0.05 deg"

{data_sheets}
[truth]
seed = 7

[truth.attitude]
roll = "30.02 deg"
pitch = "19.99 deg"
yaw = "40.03 deg"

[truth.gyro]
scale = ["100 ppm", "100 ppm", "300 ppm"]
misalignment = {{ xz = "60 arcsec", yz = "-40 arcsec" }}
"#,
        site = site!(),
        data_sheets = data_sheets!()
    )
}

const ENCODER: &str = r#"table_angle = { noise = "0.3 arcsec", resolution = "0.01 arcsec" }"#;
const COMMANDED: &str = "table_rate = {}";

/// The setup that the scenario's figures mean for the calibration, written independently of the reader.
fn setup(angle_noise: f64) -> Setup {
    let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
    let hour = DEG_PER_HOUR;
    Setup {
        station: Station::with_normal_gravity(site),
        axis: Some(AxisAttitude {
            angles: EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG },
            sigma: 0.05 * DEG,
        }),
        table: TableSpec { angle_noise, wobble: angle_noise, rate_noise: 0.0, latency: 0.0 },
        imu: ImuSpec {
            gyro: TriadSpec::white(0.02 * hour, 0.1 * hour, 500.0 * PPM, 120.0 * ARCSEC),
            accel: TriadSpec::white(30.0 * MICRO_G, 200.0 * MICRO_G, 300.0 * PPM, 60.0 * ARCSEC),
        },
        velocity_noise: Setup::FIXED_TABLE_VELOCITY_NOISE,
    }
}

/// The encoder's noise combined with its rounding error.
fn encoder_noise() -> f64 {
    (0.3 * ARCSEC).hypot(0.01 * ARCSEC / 12.0_f64.sqrt())
}

fn in_memory(scenario: &str, setup: &Setup) -> (Recording, Calibration) {
    let file = ScenarioFile::parse(scenario, Path::new("scenario.toml")).unwrap();
    let run = simulate(&file.scenario).unwrap().recording;
    // A rig without a stated wobble gets the most likely one.
    let mut setup = *setup;
    setup.table.wobble = likely_wobble(&run, &setup).unwrap();
    let calibration = calibrate(&run, &setup, |_| ()).unwrap();
    (run, calibration)
}

/// Simulates with the command, to `folder`/run.
fn simulated(folder: &Path, scenario: &str) {
    fs::write(folder.join("scenario.toml"), scenario).unwrap();
    let result = result_in(folder, "simulate scenario.toml -o run");
    assert_eq!((&result["samples"], &result["seed"]), (&2400.into(), &7.into()));
}

/// Asserts that command and library give the same result. The quantities in files are parsed to the last
/// bit or its neighbor, and the filter does not amplify that.
fn assert_same(found: &Value, calibration: &Calibration) {
    const ROUNDING: f64 = 1e-12;
    let parameters = list(found, "/parameters");
    assert_eq!(parameters.len(), 3);
    for (parameter, expected) in parameters.iter().zip(&calibration.parameters) {
        assert_eq!(parameter["id"], expected.id);
        assert_eq!(parameter["identifiable"], expected.identifiable());
        let factor = if expected.id == "gyro.scale.z" { PPM } else { ARCSEC };
        for (got, want) in [("/value", expected.value), ("/sigma", expected.sigma)] {
            let want = want / factor;
            assert_close!(number(parameter, got), want, ROUNDING * want.abs());
        }
    }
    let velocity = numbers(found, "/navigation/before/velocity_m_s");
    for (got, want) in velocity.iter().zip(&calibration.before.velocity) {
        assert_close!(*got, *want, ROUNDING);
    }
    let nis = calibration.consistency.nis_mean;
    assert_close!(number(found, "/consistency/nis_mean"), nis, ROUNDING * nis);
}

#[test]
fn run_with_an_encoder_comes_back_as_it_was_made() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = scenario(ENCODER);
    simulated(folder.path(), &scenario);
    let (run, calibration) = in_memory(&scenario, &setup(encoder_noise()));
    let read = rins_io::read(&folder.path().join("run/rig.toml")).unwrap();
    assert_eq!(read.recording, run);
    assert_same(&result_in(folder.path(), "calibrate run/rig.toml"), &calibration);
}

#[test]
fn commanded_rate_comes_back_as_a_column() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = scenario(COMMANDED);
    simulated(folder.path(), &scenario);
    let (run, calibration) = in_memory(&scenario, &setup(TableSpec::DEFAULT_ANGLE_NOISE));
    let read = rins_io::read(&folder.path().join("run/rig.toml")).unwrap();
    assert_eq!(read.recording, run);
    assert_same(&result_in(folder.path(), "calibrate run/rig.toml"), &calibration);
}

/// A log without a table signal, with a profile in its rig, is equivalent to a log
/// with the commanded rate.
#[test]
fn commanded_profile_stands_in_for_a_column() {
    let folder = tempfile::tempdir().unwrap();
    simulated(folder.path(), &scenario(""));
    let header = fs::read_to_string(folder.path().join("run/run.csv")).unwrap();
    assert!(!header.lines().next().unwrap().contains("table"));
    let (run, calibration) =
        in_memory(&scenario(COMMANDED), &setup(TableSpec::DEFAULT_ANGLE_NOISE));
    let read = rins_io::read(&folder.path().join("run/rig.toml")).unwrap();
    assert_eq!(read.recording.increments, run.increments);
    assert_same(&result_in(folder.path(), "calibrate run/rig.toml"), &calibration);
}

#[test]
fn same_seed_makes_the_same_bytes_and_another_seed_others() {
    let folder = tempfile::tempdir().unwrap();
    simulated(folder.path(), &scenario(ENCODER));
    let bytes = |run: &str, name: &str| fs::read(folder.path().join(run).join(name)).unwrap();
    for (run, options) in [("again", ""), ("told", " --seed 7"), ("other", " --seed 8")] {
        result_in(folder.path(), &format!("simulate scenario.toml -o {run}{options}"));
    }
    for name in ["run.csv", "rig.toml", "truth.json"] {
        assert_eq!(bytes("again", name), bytes("run", name), "{name}");
        assert_eq!(bytes("told", name), bytes("run", name), "{name}");
    }
    assert_ne!(bytes("other", "run.csv"), bytes("run", "run.csv"));
    // Only the noise differs: the rig is the same, and the truth except for the seed.
    assert_eq!(bytes("other", "rig.toml"), bytes("run", "rig.toml"));
    let truth: Value = serde_json::from_slice(&bytes("other", "truth.json")).unwrap();
    assert_eq!(truth["seed"], 8);
}
