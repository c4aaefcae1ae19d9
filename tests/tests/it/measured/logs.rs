//! Measured logs, and their recordings.
//!
//! Expected values were computed from the files with awk, not with the code under test.

use nalgebra::Vector3;
use rins_frames::EARTH_RATE;
use rins_frames::units::{DEG, STANDARD_GRAVITY};
use rins_io::{Loaded, LogPolicy, Rig, read, read_log};
use rins_testing::assert_close;
use rins_tests::outside_data;

fn load(folder: &std::path::Path, rig: &str) -> Loaded {
    let rig = Rig::parse(rig, &folder.join("rig.toml")).unwrap();
    read_log(rig, LogPolicy::default()).unwrap()
}

const SITE: &str = "[site]\nlatitude = \"50 deg\"\nlongitude = \"10 deg\"\nheight = \"100 m\"\n";

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn synthetic_runs_are_read() {
    let folder = outside_data("synthetic/clean_multirate");
    let loaded = read(&folder.join("rig.toml")).unwrap();
    assert_eq!(loaded.recording.len(), 40500);
    assert!(loaded.summary.gaps.is_empty() && loaded.rig.imu.is_some());
    let first = &loaded.recording.increments[0];
    assert_close!(first.angle.components().x, 2.23024735e-05 * 0.02, 1e-20);
    assert_close!(loaded.recording.times[40499], 810.0, 1e-9);
    assert_close!(loaded.recording.temperature.unwrap()[0], 20.294, 1e-12);
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn a_laser_gyro_at_rest_sees_the_earth_turn() {
    let folder = outside_data("real/psins_lasergyro");
    let loaded = load(&folder, "[log]\npath = \"lasergyro.imu\"\nformat = \"psins\"\n");
    assert_eq!(loaded.recording.len(), 184718);
    assert_close!(loaded.station.site.latitude, 34.246048 * DEG, 1e-15);
    let sum = loaded
        .recording
        .increments
        .iter()
        .fold(Vector3::zeros(), |sum, sample| sum + sample.angle.components());
    // Bias and vibration are some percent of that.
    assert_close!(sum.norm() / 1847.18, EARTH_RATE, 0.05 * EARTH_RATE);
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn a_wheelchairs_wheel_has_gaps_repeats_and_a_slow_thermometer() {
    let folder = outside_data("real/worklab_wheel_right");
    let rig = format!(
        "{SITE}[log]\npath = \"sensors.csv\"\ntime = {{ column = \"Time (s)\", unit = \"s\" }}\n\
         gyro = {{ columns = [\"Gyroscope X (deg/s)\", \"Gyroscope Y (deg/s)\", \
         \"Gyroscope Z (deg/s)\"], unit = \"deg/s\" }}\n\
         accel = {{ columns = [\"Accelerometer X (g)\", \"Accelerometer Y (g)\", \
         \"Accelerometer Z (g)\"], unit = \"g\" }}\n\
         temperature = {{ path = \"temperature.csv\", time = \"Time (s)\", \
         column = \"Gyroscope And Accelerometer (degC)\", unit = \"degC\" }}\n\
         [axis]\nspin = \"y\"\n"
    );
    let loaded = load(&folder, &rig);
    assert_eq!(loaded.summary.left_out.len(), 31);
    assert_eq!(loaded.recording.len() + 31, 14039);
    assert!(loaded.summary.gaps.iter().any(|gap| gap.length > 0.014));
    assert_close!(loaded.summary.nominal_interval, 0.002464, 5e-6);
    // The spin axis has become z.
    let fastest = loaded
        .recording
        .increments
        .iter()
        .map(|sample| sample.angle.components().z.abs() / sample.interval / DEG);
    assert!(fastest.fold(0.0, f64::max) > 400.0);
    assert_close!(loaded.recording.temperature.unwrap()[0], 25.284, 1e-9);
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn a_sample_counter_stands_in_for_time() {
    let folder = outside_data("real/imucal_nilspod");
    let rig = format!(
        "{SITE}[log]\npath = \"example_ferraris_session.csv\"\nrate = \"102.4 Hz\"\n\
         time = {{ column = \"n_samples\", unit = \"sample\" }}\n\
         gyro = {{ columns = [\"gyr_x\", \"gyr_y\", \"gyr_z\"], unit = \"deg/s\" }}\n\
         accel = {{ columns = [\"acc_x\", \"acc_y\", \"acc_z\"], unit = \"m/s^2\" }}\n"
    );
    let loaded = load(&folder, &rig);
    assert_eq!(loaded.recording.len(), 10376);
    let first = &loaded.recording.increments[0];
    assert_close!(first.velocity.norm() * 102.4, STANDARD_GRAVITY, 0.6);
}

#[test]
#[cfg_attr(not(rins_data), ignore = "RINS_DATA leads to no data")]
fn raw_counts_in_two_files_are_joined() {
    let folder = outside_data("real/imu_tk_xsens");
    let columns = "columns = [\"2\", \"3\", \"4\"], offset = 32768";
    let rig = format!(
        "{SITE}[log]\nformat = \"csv\"\nrate = \"100 Hz\"\ntime = {{ column = \"1\", unit = \"s\" }}\n\
         gyro = {{ path = \"xsens_gyro.mat\", {columns}, unit = \"rad/s\", scale = 1.6e-4 }}\n\
         accel = {{ path = \"xsens_acc.mat\", {columns}, unit = \"m/s^2\", scale = 2.4e-3 }}\n"
    );
    let loaded = load(&folder, &rig);
    assert_eq!(loaded.recording.len(), 51175);
    let first = &loaded.recording.increments[0];
    assert_close!(first.angle.components().x, 18.0 * 1.6e-4 * 0.01, 1e-16);
    assert_close!(first.velocity.components().z, 3661.0 * 2.4e-3 * 0.01, 1e-13);
}
