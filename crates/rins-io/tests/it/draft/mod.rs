//! Rig files drafted from logs: their content, and the correct reading of the logs with them.

mod formats;
mod guesses;
mod layout_table;
mod layouts;
mod messages;
mod refusals;
mod support;

use nalgebra::Vector3;
use rins_frames::units::{ARCSEC, DEG};
use rins_frames::{InFrame, Increments};
use rins_io::{read, write_recording};
use rins_motion::Recording;
use rins_testing::{assert_close, filled};

use crate::support::folder;
use support::{Motion, SITE, draft};

/// A log written by rins is drafted without a loss: read again, it is bit-identical.
#[test]
fn a_log_that_was_written_here_is_drafted_and_read_back() {
    let motion = Motion { rate: 64, ..Motion::default() };
    let mut recording = Recording::default();
    let (mut angles, mut temperatures) = (Vec::new(), Vec::new());
    for row in motion.rows() {
        recording.times.push(row.time);
        recording.increments.push(Increments {
            angle: InFrame::from_components(row.rate / 64.0),
            velocity: InFrame::from_components(row.force / 64.0),
            interval: 1.0 / 64.0,
        });
        angles.push(row.table);
        temperatures.push(21.5 + 0.01 * row.time);
    }
    recording.table_angle = Some(angles);
    recording.temperature = Some(temperatures);
    let mut log = Vec::new();
    write_recording(&recording, &mut log).unwrap();

    let folder = folder(&[("run.csv", &log)]);
    let draft = draft(folder.path(), "run.csv");
    assert!(draft.to_fill_in.iter().all(|key| !key.key.starts_with("log.")), "{}", draft.text);
    let rig = folder.path().join("rig.toml");
    std::fs::write(&rig, filled(&draft.text, &SITE)).unwrap();
    let loaded = read(&rig).unwrap();
    assert_eq!(loaded.recording, recording);
}

#[test]
fn units_of_a_header_are_taken_over() {
    let mut log = String::from(
        "Time (ms);GyroX [°/s];GyroY [°/s];GyroZ [°/s];AccX (mg);AccY (mg);AccZ (mg);T_imu (K)\r\n",
    );
    for row in 1..=300 {
        let small = f64::from(row) * 1e-3;
        log.push_str(&format!("{};{small};0.2;-{small};{small};-10;1000;295.5\r\n", 10 * row));
    }
    let log = log.replacen(";0.2;", ";0.3;", 1);
    let folder = folder(&[("log.dat", log.as_bytes())]);
    let draft = draft(folder.path(), "log.dat");
    let stated = [
        "time.unit = \"ms\"\n",
        "gyro.columns = [\"GyroX [°/s]\", \"GyroY [°/s]\", \"GyroZ [°/s]\"]\n",
        "gyro.unit = \"deg/s\"\n",
        "accel.unit = \"mg\"\n",
        "temperature.unit = \"K\"\n",
    ];
    for line in stated {
        assert!(draft.text.contains(line), "{line}{}", draft.text);
    }
    let guessed: Vec<&str> = draft.guesses.iter().map(|guess| guess.key.as_str()).collect();
    assert_eq!(guessed, ["log.rate"]);
    let rig = folder.path().join("rig.toml");
    std::fs::write(&rig, filled(&draft.text, &SITE)).unwrap();
    let loaded = read(&rig).unwrap();
    let last = loaded.recording.increments[299];
    assert_close!(last.angle.components().z, -0.3 * DEG * 0.01, 1e-17);
    assert_close!(last.velocity.components().z, 9.80665 * 0.01, 1e-15);
    assert_close!(loaded.recording.temperature.unwrap()[0], 22.35, 1e-12);
}

#[test]
fn a_psins_log_is_known_by_its_content() {
    let mut log =
        String::from("0.5 -1.0 90.0 0 0 0\n34.5 109.0 400 0 10 9.79\n.1 .1 .1 125 125 125\n");
    for row in 0..200 {
        log.push_str(&format!("{} 2 -{} 0 1 80\n", row % 7, row % 3));
    }
    let log = log.replacen(" 2 -", " 3 -", 1);
    // Neither the extension nor a comment states the format.
    let folder = folder(&[("rest.txt", log.as_bytes())]);
    let draft = draft(folder.path(), "rest.txt");
    assert!(draft.text.contains("format = \"psins\"\n"), "{}", draft.text);
    assert!(draft.text.contains("latitude 34.5 deg, longitude 109 deg, height 400 m"));
    assert!(draft.text.contains("pitch 0.5, roll -1, yaw 90 deg"));
    // It is complete except for the data sheets.
    assert!(draft.to_fill_in.iter().all(|key| key.key.starts_with("imu.")));
    let rig = folder.path().join("rig.toml");
    std::fs::write(&rig, &draft.text).unwrap();
    let loaded = read(&rig).unwrap();
    assert_close!(loaded.station.site.latitude, 34.5 * DEG, 1e-15);
    assert_close!(loaded.recording.increments[1].angle.components().x, 0.1 * ARCSEC, 1e-22);
    let gravity = loaded.recording.increments[0].velocity.components().z / 0.01;
    assert_close!(gravity, 80.0 * 125e-6 * 9.79 / 0.01, 1e-12);
}

#[test]
fn increments_without_names_pointing_down_are_kf_gins() {
    let motion = Motion { tilt: 0.2, ..Motion::default() };
    let mut log = String::new();
    for row in motion.rows() {
        let (angle, velocity) = (row.rate / 50.0, row.force / 50.0);
        // From front, right, down to right, front, up.
        let ahead = |v: Vector3<f64>| format!("{} {} {}", v.y, v.x, -v.z);
        log.push_str(&format!("{:.6} {} {}\n", row.time, ahead(angle), ahead(velocity)));
    }
    let folder = folder(&[("imu.txt", log.as_bytes())]);
    let draft = draft(folder.path(), "imu.txt");
    assert!(draft.text.contains("format = \"kf-gins\"  # GUESS"), "{}", draft.text);
    let rig = folder.path().join("rig.toml");
    std::fs::write(&rig, filled(&draft.text, &SITE)).unwrap();
    let loaded = read(&rig).unwrap();
    let first = motion.rows().next().unwrap();
    let read = loaded.recording.increments[0].velocity.components() * 50.0;
    assert_close!((read - first.force).norm(), 0.0, 1e-9);
}
