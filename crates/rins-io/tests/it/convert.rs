//! Logs written in the formats of other software, and read again.

use std::fs;
use std::path::Path;

use rins_io::{Converted, IoError, LogFile, Overwrite, convert, read};
use rins_testing::assert_close;
use tempfile::TempDir;

use crate::support::{SITE, folder, without};

/// The rig of a log of increments at 64 Hz with all possible signals.
const RIG: &str = r#"
[log]
path = "run.csv"
rate = "64 Hz"
time = { column = "t", unit = "s" }
gyro = { columns = ["gx", "gy", "gz"], unit = "rad" }
accel = { columns = ["ax", "ay", "az"], unit = "m/s", axes = ["-y", "x", "z"] }
table_angle = { column = "table", unit = "rad", noise = "0.3 arcsec", latency = "1 ms" }
temperature = { column = "T", unit = "degC" }

[attitude]
roll = "30 deg"
pitch = "20 deg"
yaw = "40 deg"
sigma = "0.1 deg"

[axis]
spin = "x"
"#;

/// Increments in which all bits are used, from a simple generator.
fn log(rows: u32) -> String {
    let mut state = 88172645463325252_u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / 2.0_f64.powi(53) - 0.5
    };
    let mut text = String::from("t,gx,gy,gz,ax,ay,az,table,T\n");
    for row in 1..=rows {
        text.push_str(&format!("{}", f64::from(row) / 64.0));
        for scale in [1e-3, 1e-3, 0.02, 0.01, 0.01, 0.3] {
            text.push_str(&format!(",{:e}", scale * random()));
        }
        text.push_str(&format!(",{},{:e}\n", 0.02 * f64::from(row), 20.0 + random()));
    }
    text
}

fn run() -> TempDir {
    let rig = format!("{SITE}{RIG}");
    folder(&[("rig.toml", rig.as_bytes()), ("run.csv", log(40).as_bytes())])
}

fn ending(format: LogFile) -> &'static str {
    match format {
        LogFile::Psins => "imu",
        LogFile::KfGins => "txt",
        LogFile::PsinsBinary => "bin",
        LogFile::Mat => "mat",
        LogFile::Parquet => "parquet",
        _ => "csv",
    }
}

fn converted(
    folder: &TempDir,
    rig: &str,
    name: &str,
    format: LogFile,
) -> Result<Converted, String> {
    let (rig, log) = (folder.path().join(rig), folder.path().join(name));
    convert(&rig, &log, format, Overwrite::Refuse)
        .map_err(|error: IoError| without(&error, folder.path()))
}

#[test]
fn every_pair_of_formats_is_exact() {
    let folder = run();
    let original = read(&folder.path().join("rig.toml")).unwrap();
    for first in LogFile::ALL {
        let name = format!("{}.{}", first.name(), ending(first));
        let done = converted(&folder, "rig.toml", &name, first).unwrap();
        // This includes the rates of EuRoC: the interval is a power of two, and an integer number of nanoseconds.
        assert!(done.differences.is_empty(), "{}: {:?}", first.name(), done.differences);
        assert_eq!(done.left_out.is_empty(), first.holds_more_than_the_imu());
        let once = read(&done.rig).unwrap();
        assert_eq!(once.recording.increments, original.recording.increments, "{name}");
        assert_eq!(once.rig.attitude, original.rig.attitude);
        assert_eq!(once.station, original.station);
        for second in LogFile::ALL {
            let rig = format!("{}.toml", first.name());
            let name = format!("{}-{}.{}", first.name(), second.name(), ending(second));
            let done = converted(&folder, &rig, &name, second).unwrap();
            assert!(done.differences.is_empty(), "{name}: {:?}", done.differences);
            let twice = read(&done.rig).unwrap();
            assert_eq!(twice.recording.increments, original.recording.increments, "{name}");
            assert_eq!(twice.recording.times, original.recording.times, "{name}");
            if first.holds_more_than_the_imu() && second.holds_more_than_the_imu() {
                assert_eq!(twice.recording, original.recording, "{name}");
                let noise = |loaded: &rins_io::Loaded| loaded.rig.log.table_angle().unwrap().noise;
                assert_eq!(noise(&twice), noise(&original));
            }
        }
    }
}

/// The text columns of a converted log whose increments all differ.
fn columns_of(format: LogFile, name: &str) -> Vec<Vec<f64>> {
    let folder = run();
    converted(&folder, "rig.toml", name, format).unwrap();
    let text = fs::read_to_string(folder.path().join(name)).unwrap();
    let separator = |letter: char| letter == ',' || letter == ' ';
    let numbers = |line: &str| line.split(separator).map(|n| n.parse().unwrap()).collect();
    text.lines().filter(|line| !line.starts_with(['#', '%'])).map(numbers).collect()
}

/// A sample of [`run`] along right, front and up, the sensors' own body axes, computed from its text.
///
/// The rig file has body x = −y, y = x, z = z of the accelerometers; the fact that body x is the spin axis has no effect.
fn expected(sample: usize) -> ([f64; 3], [f64; 3]) {
    let text = log(40);
    let row: Vec<f64> =
        text.lines().nth(sample + 1).unwrap().split(',').map(|n| n.parse().unwrap()).collect();
    let [_, gx, gy, gz, ax, ay, az, ..] = row[..] else { panic!("a row") };
    let (bx, by, bz) = (-ay, ax, az);
    ([gx, gy, gz], [bx, by, bz])
}

#[test]
fn kf_gins_gets_front_right_and_down() {
    let rows = columns_of(LogFile::KfGins, "run.txt");
    assert_eq!(rows.len(), 40);
    for (sample, row) in rows.iter().enumerate() {
        let ([wr, wf, wu], [vr, vf, vu]) = expected(sample);
        assert_eq!(row[1..], [wf, wr, -wu, vf, vr, -vu]);
        assert_close!(row[0], (sample + 1) as f64 / 64.0, 1e-15);
    }
}

#[test]
fn kalibr_and_euroc_get_nanoseconds_rates_and_forces() {
    let rows = columns_of(LogFile::Euroc, "run.csv2");
    for (sample, row) in rows.iter().enumerate() {
        let (angle, velocity) = expected(sample);
        assert_close!(row[0], (sample + 1) as f64 * 1e9 / 64.0, 1e-3);
        for axis in 0..3 {
            assert_close!(row[1 + axis], angle[axis] * 64.0, 1e-15);
            assert_close!(row[4 + axis], velocity[axis] * 64.0, 1e-14);
        }
    }
}

#[test]
fn psins_gets_right_front_up_and_its_units() {
    let rows = columns_of(LogFile::Psins, "run.imu");
    let (place, scale) = (&rows[1], &rows[2]);
    assert_close!(place[0], 34.25, 1e-12);
    assert_close!(place[1], 108.9, 1e-12);
    assert_close!(place[2], 400.0, 1e-9);
    // An interval in ms, and 1 g as gravity at a latitude of 34 degrees.
    assert_close!(place[4], 15.625, 1e-12);
    assert_close!(place[5], 9.7955, 1e-3);
    for (sample, row) in rows[3..].iter().enumerate() {
        let (angle, velocity) = expected(sample);
        for axis in 0..3 {
            let arcsec = angle[axis] * 180.0 * 3600.0 / std::f64::consts::PI;
            assert_close!(row[axis] * scale[axis], arcsec, 1e-9);
            let micro_g_seconds = velocity[axis] / place[5] * 1e6;
            assert_close!(row[3 + axis] * scale[3 + axis], micro_g_seconds, 1e-7);
        }
    }
}

#[test]
fn psins_doubles_are_angles_velocities_and_time() {
    let folder = run();
    converted(&folder, "rig.toml", "run.bin", LogFile::PsinsBinary).unwrap();
    let bytes = fs::read(folder.path().join("run.bin")).unwrap();
    assert_eq!(bytes.len(), 40 * 56);
    for (sample, row) in bytes.chunks(56).enumerate() {
        let number = |place: usize| f64::from_le_bytes(row[8 * place..][..8].try_into().unwrap());
        let (angle, velocity) = expected(sample);
        assert_eq!([number(0), number(1), number(2)], angle);
        assert_eq!([number(3), number(4), number(5)], velocity);
        assert_close!(number(6), (sample + 1) as f64 / 64.0, 1e-15);
    }
}

#[test]
fn a_psins_log_keeps_its_integers() {
    let log = "% a log\n1 2 3 0 0 0\n34.2 108.9 380.5 10 10 9.79\n.1 .1 .1 1.5 1.5 1.5\n\
               1 -2 3 100 -200 6537\n2 -3 5 101 -201 6538\n-4 0 7 99 -199 6536\n";
    let folder = folder(&[
        ("rig.toml", b"[log]\npath = \"a.imu\"\nformat = \"psins\"\n"),
        ("a.imu", log.as_bytes()),
    ]);
    let done = converted(&folder, "rig.toml", "b.imu", LogFile::Psins).unwrap();
    assert!(done.differences.is_empty(), "{:?}", done.differences);
    let text = fs::read_to_string(folder.path().join("b.imu")).unwrap();
    assert!(
        text.ends_with("\n1 -2 3 100 -200 6537\n2 -3 5 101 -201 6538\n-4 0 7 99 -199 6536\n"),
        "{text}"
    );
    let done = converted(&folder, "rig.toml", "c.parquet", LogFile::Parquet).unwrap();
    assert!(done.differences.is_empty(), "{:?}", done.differences);
    // The site came from the header, and is now in the rig file.
    let (old, new) = (read(&folder.path().join("rig.toml")).unwrap(), read(&done.rig).unwrap());
    assert_eq!(old.station, new.station);
    assert_eq!(old.recording, new.recording);
}

#[test]
fn uneven_steps_do_not_fit_a_psins_log() {
    let folder = run();
    let text = log(40).replace("\n0.5,", "\n0.503,");
    fs::write(folder.path().join("run.csv"), text).unwrap();
    let refused = converted(&folder, "rig.toml", "b.imu", LogFile::Psins).unwrap_err();
    assert!(
        refused.starts_with("b.imu: a psins log has no time column, and sample 32 is 3.00"),
        "{refused}"
    );
    assert!(!folder.path().join("b.imu").exists() && !folder.path().join("b.toml").exists());
    let done = converted(&folder, "rig.toml", "b.txt", LogFile::KfGins).unwrap();
    assert!(done.differences.is_empty(), "{:?}", done.differences);
}

#[test]
fn nothing_that_is_there_is_replaced_unasked() {
    let folder = run();
    let path = |name: &str| folder.path().join(name);
    let again = |log: &Path, overwrite| convert(&path("rig.toml"), log, LogFile::Csv, overwrite);
    for name in ["run.csv", "rig.csv"] {
        let refused = again(&path(name), Overwrite::Force).unwrap_err().to_string();
        assert!(
            refused.ends_with(
                "is an input of the same command and is not replaced; choose another name"
            ),
            "{refused}"
        );
    }
    again(&path("new.csv"), Overwrite::Refuse).unwrap();
    for kept in ["new.csv", "new.toml"] {
        let before = fs::read(path("new.csv")).unwrap();
        let refused = again(&path("new.csv"), Overwrite::Refuse).unwrap_err().to_string();
        assert!(refused.ends_with("exists already; choose another name, or --force to replace it"));
        assert_eq!(fs::read(path("new.csv")).unwrap(), before, "{kept}");
    }
    fs::remove_file(path("new.csv")).unwrap();
    again(&path("new.csv"), Overwrite::Refuse).unwrap_err();
    assert!(!path("new.csv").exists());
    again(&path("new.csv"), Overwrite::Force).unwrap();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 4);
}

/// A table that counts in the opposite direction is read with its sign, and written with it.
#[test]
fn a_reversed_table_is_read_once() {
    let reversed =
        RIG.replace("\"table\", unit = \"rad\"", "\"table\", unit = \"rad\", sense = \"reversed\"");
    assert_ne!(reversed, RIG);
    let folder = run();
    fs::write(folder.path().join("reversed.toml"), format!("{SITE}{reversed}")).unwrap();
    let angle = |rig: &str| read(&folder.path().join(rig)).unwrap().recording.table_angle.unwrap();
    let (forward, backward) = (angle("rig.toml"), angle("reversed.toml"));
    assert!(forward.iter().zip(&backward).all(|(a, b)| (a + b).abs() < 1e-15));
    converted(&folder, "reversed.toml", "new.parquet", LogFile::Parquet).unwrap();
    assert_eq!(angle("new.toml"), backward);
}
