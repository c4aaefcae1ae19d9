//! Files that are designed to fill the memory or to be read endlessly are refused within bounds.
#![cfg(target_os = "linux")]

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use rins_testing::site;
use rins_tests::rins;
use tempfile::TempDir;

use crate::support::Finished;

/// The memory limit of a command \[KiB\], and its time limit.
const MEMORY: u64 = 1 << 20;
const TIME: Duration = Duration::from_secs(10);

const RIG: &str = concat!(
    site!(),
    r#"
[log]
path = "LOG"
"#
);

const COLUMNS: &str = r#"time = { column = "t", unit = "s" }
gyro = { columns = ["gx", "gy", "gz"], unit = "rad/s" }
accel = { columns = ["ax", "ay", "az"], unit = "m/s^2" }
"#;

/// Runs `rins` with limited memory.
fn bounded(folder: &Path, arguments: &str) -> Finished {
    let binary = rins().get_program().to_owned();
    let script = format!("ulimit -v {MEMORY}; exec \"$0\" {arguments}");
    let mut command = Command::new("sh");
    command.args(["-c", &script]).arg(binary).current_dir(folder);
    let start = Instant::now();
    let finished = command.output().unwrap().into();
    assert!(start.elapsed() < TIME, "{arguments}: {:?}", start.elapsed());
    finished
}

fn with_rig(log: &str, keys: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let rig = RIG.replace("LOG", log) + keys;
    fs::write(folder.path().join("rig.toml"), rig).unwrap();
    folder
}

fn refused(folder: &TempDir, arguments: &str, says: &str) {
    let finished = bounded(folder.path(), arguments);
    assert_eq!(finished.code, Some(1), "{arguments}: {}", finished.err);
    assert!(finished.err.contains(says), "{arguments}: {}", finished.err);
    assert!(finished.out.is_empty());
}

#[test]
fn ten_gigabytes_in_one_line() {
    for (log, keys, says) in [
        ("run.csv", COLUMNS, "run.csv:1: a line of more than 1048576 bytes"),
        ("run.txt", "format = \"kf-gins\"\n", "run.txt:1: a line of more than 1048576 bytes"),
        ("run.csv", "format = \"euroc\"\n", "run.csv:1: a line of more than 1048576 bytes"),
        ("run.imu", "format = \"psins\"\n", "run.imu:1: a line of more than 1048576 bytes"),
        (
            "run.asc",
            "format = \"novatel\"\nimu = \"HG1700-AG58\"\n",
            "run.asc:1: a line of more than 1048576 bytes",
        ),
        ("run.bin", "format = \"psins-bin\"\n", "run.bin:2: equal to the previous row"),
        ("run.mat", COLUMNS, "run.mat: not a MATLAB level 5 file"),
        ("run.parquet", COLUMNS, "run.parquet: not a Parquet file"),
        ("rig.toml", "", "rig.toml: more than 1048576 bytes, too large for a file of keys"),
    ] {
        let folder = with_rig(log, keys);
        // A hole in the file, which is read as zeros.
        let file = File::options().create(true).append(true).open(folder.path().join(log)).unwrap();
        file.set_len(10 << 30).unwrap();
        refused(&folder, "check rig.toml", says);
        if log != "rig.toml" {
            let drafted = bounded(folder.path(), &format!("init {log}"));
            assert_eq!(drafted.code, Some(1), "{log}: {}", drafted.err);
        }
    }
}

#[test]
fn columns_by_the_hundred_thousand() {
    let folder = with_rig("run.csv", COLUMNS);
    let line = "7,".repeat(400_000) + "\n";
    fs::write(folder.path().join("run.csv"), line.repeat(3)).unwrap();
    refused(&folder, "check rig.toml", "run.csv:1: more than 4096 columns");
    refused(&folder, "init run.csv", "run.csv:1: more than 4096 columns");
}

/// A matrix of zeros that is compressed a thousandfold.
#[test]
fn few_bytes_that_unpack_to_very_many() {
    let rows: u32 = 32 << 20;
    let mut element = Vec::new();
    let word = |element: &mut Vec<u8>, word: u32| element.extend(word.to_le_bytes());
    for number in [14, 48 + 8 * rows, 6, 8, 6, 0, 5, 8, rows, 1, 1, 1] {
        word(&mut element, number);
    }
    element.extend(*b"t\0\0\0\0\0\0\0");
    word(&mut element, 9);
    word(&mut element, 8 * rows);
    let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    packed.write_all(&element).unwrap();
    for _ in 0..rows / 1024 {
        packed.write_all(&[0; 8192]).unwrap();
    }
    let packed = packed.finish().unwrap();
    let mut file = [b' '; 124].to_vec();
    file.extend([0, 1, b'I', b'M']);
    word(&mut file, 15);
    word(&mut file, u32::try_from(packed.len()).unwrap());
    file.extend(&packed);
    assert!(file.len() < 4 << 20, "{}", file.len());
    let folder = with_rig("run.mat", COLUMNS);
    fs::write(folder.path().join("run.mat"), file).unwrap();
    refused(&folder, "check rig.toml", "rows, the most that are read of a log of this size");
}

/// Nested keys, a hundred thousand levels deep.
#[test]
fn keys_without_an_end() {
    for (text, says) in [
        (format!("a = {}", "[".repeat(900_000)), "rig.toml:1: cannot recurse further"),
        (format!("a = {}", "{b=".repeat(300_000)), "rig.toml:1: cannot recurse further"),
        (format!("{}c = 1", "a.".repeat(400_000)), "rig.toml: recursion limit"),
        (format!("[{}c]", "a.".repeat(400_000)), "rig.toml: recursion limit"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("rig.toml"), text).unwrap();
        refused(&folder, "check rig.toml", says);
        refused(&folder, "calibrate rig.toml", says);
        refused(&folder, "simulate rig.toml -o out", says);
    }
}

#[test]
fn runs_that_would_last_for_ever() {
    let demo = rins_tests::workspace().join("crates/rins/data/demo/scenario.toml");
    let scenario = fs::read_to_string(demo).unwrap();
    for (from, to) in [
        ("\"180 s\"", "\"1e11 s\""),
        ("\"25 Hz\"", "\"1 MHz\""),
        ("\"180 s\"", "\"1e308 s\""),
        ("\"20 deg/s\"", "\"1e11 deg/s\""),
    ] {
        let folder = tempfile::tempdir().unwrap();
        assert!(scenario.contains(from));
        fs::write(folder.path().join("long.toml"), scenario.replace(from, to)).unwrap();
        let finished = bounded(folder.path(), "simulate long.toml -o out");
        assert_eq!(finished.code, Some(1), "{to}: {}", finished.err);
        assert!(finished.err.starts_with("rins: long.toml"), "{to}: {}", finished.err);
        assert!(!folder.path().join("out").exists());
    }
}
