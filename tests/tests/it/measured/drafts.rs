//! Drafts of measured logs.

use rins_frames::EARTH_RATE;
use rins_frames::units::{DEG, STANDARD_GRAVITY};
use rins_io::{Loaded, read};
use rins_testing::{assert_close, filled};
use rins_tests::outside_data;

/// A site for the keys that a draft leaves open.
const SITE: [(&str, &str); 2] = [("site.latitude", "\"34.25 deg\""), ("site.height", "\"400 m\"")];

/// Reads a measured log with its draft and these values filled in.
fn load(name: &str, log: &str, values: &[(&str, &str)]) -> Loaded {
    let log = outside_data(name).join(log).canonicalize().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let draft = rins_io::draft_rig(&log, folder.path()).unwrap();
    let rig = folder.path().join("rig.toml");
    std::fs::write(&rig, filled(&draft.text, values)).unwrap();
    read(&rig).unwrap()
}

/// The mean specific force over the first hundred samples \[m/s²\].
fn first_force(loaded: &Loaded) -> f64 {
    let samples = &loaded.recording.increments[..100];
    samples.iter().map(|sample| sample.rates().specific_force.norm()).sum::<f64>() / 100.0
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn a_wheel() {
    let loaded = load("real/worklab_wheel_right", "sensors.csv", &SITE);
    assert_eq!(loaded.recording.len(), 14008);
    assert_close!(first_force(&loaded), STANDARD_GRAVITY, 0.3);
    // The axis of the wheel has become z.
    let rates = loaded.recording.increments.iter().map(|sample| sample.rates().angular_rate);
    assert!(rates.map(|rate| rate.components().z.abs() / DEG).fold(0.0, f64::max) > 400.0);
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn a_laser_gyro() {
    let loaded = load("real/psins_lasergyro", "lasergyro.imu", &[]);
    assert_close!(first_force(&loaded), 9.797, 0.02);
    let sum = loaded.recording.increments.iter().map(|sample| sample.angle.components());
    let mean = sum.sum::<nalgebra::Vector3<f64>>().norm() / 1847.18;
    assert_close!(mean, EARTH_RATE, 0.05 * EARTH_RATE);
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn a_sample_counter() {
    let mut values = SITE.to_vec();
    values.extend([("log.rate", "\"102.4 Hz\""), ("log.gyro.unit", "\"deg/s\"")]);
    let loaded = load("real/imucal_nilspod", "example_ferraris_session.csv", &values);
    assert_close!(first_force(&loaded), STANDARD_GRAVITY, 0.6);
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn raw_counts() {
    let mut values = SITE.to_vec();
    values.extend([
        ("log.gyro.unit", "\"rad/s\""),
        ("log.gyro.scale", "1.6e-4"),
        ("log.gyro.offset", "32768"),
        ("log.accel.unit", "\"m/s^2\""),
    ]);
    // A draft of the gyros' log does not ask for the scale of the accelerometers' file.
    let folder = outside_data("real/imu_tk_xsens");
    let log = folder.join("xsens_gyro.mat").canonicalize().unwrap();
    let place = tempfile::tempdir().unwrap();
    let draft = rins_io::draft_rig(&log, place.path()).unwrap();
    let text = filled(&draft.text, &values)
        .replace("accel.unit = ", "accel.scale = 2.4e-3\naccel.offset = 32768\naccel.unit = ");
    let rig = place.path().join("rig.toml");
    std::fs::write(&rig, text).unwrap();
    let loaded = read(&rig).unwrap();
    assert_eq!(loaded.recording.len(), 51175);
    assert_close!(first_force(&loaded), STANDARD_GRAVITY, 1.0);
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn synthetic_runs() {
    let loaded = load("synthetic/clean_multirate", "run.csv", &SITE);
    let own = read(&outside_data("synthetic/clean_multirate").join("rig.toml")).unwrap();
    assert_eq!(loaded.recording, own.recording);
}
