//! The scope of `--force`: regular files and folders of rins results, and no input.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::{FileTypeExt, symlink};
use std::os::unix::net::UnixListener;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

use crate::support::{Finished, result_in, rins_in};

const SCENARIO: &str = r#"[site]
latitude = "45 deg"
longitude = "0 deg"
height = "0 m"
[log]
rate = "20 Hz"
table_angle = { noise = "1 arcsec" }
[table]
profile = [{ rate = "0 deg/s", duration = "10 s" }, { rate = "20 deg/s", duration = "20 s" }]
[attitude]
roll = "20 deg"
pitch = "0 deg"
yaw = "0 deg"
sigma = "0.1 deg"
[imu.gyro]
noise = "0.02 deg/h/sqrt(Hz)"
bias_sigma = "1 deg/h"
scale_sigma = "500 ppm"
misalignment_sigma = "120 arcsec"
[imu.accel]
noise = "30 ug/sqrt(Hz)"
bias_sigma = "200 ug"
scale_sigma = "300 ppm"
misalignment_sigma = "60 arcsec"
[truth]
seed = 1
"#;

/// Commands that write a file, and the inputs of each.
const TO_FILES: [(&str, &[&str]); 5] = [
    ("init run/run.csv", &["run/run.csv"]),
    ("convert run/rig.toml --format csv", &["run/run.csv", "run/rig.toml"]),
    (
        "apply run/rig.toml --calibration cal/calibration.toml --format csv",
        &["run/run.csv", "run/rig.toml", "cal/calibration.toml"],
    ),
    ("monte-carlo scenario.toml --runs 2", &["scenario.toml"]),
    ("merge one.parquet two.parquet", &["one.parquet", "two.parquet"]),
];

/// Commands that write a folder, and a folder of rins results that contains an input of theirs.
const TO_FOLDERS: [(&str, &str); 8] = [
    ("simulate cal/scenario.toml", "cal"),
    ("check run/rig.toml", "run"),
    ("allan run/rig.toml", "run"),
    ("align run/rig.toml", "run"),
    ("navigate run/rig.toml", "run"),
    ("navigate run/rig.toml --calibration cal/calibration.toml", "cal"),
    ("calibrate run/rig.toml --model paper12", "run"),
    ("calibrate run/rig.toml --model cal/model.toml", "cal"),
];

fn prepared() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("scenario.toml"), SCENARIO).unwrap();
    result_in(path, "simulate scenario.toml -o run");
    result_in(path, "calibrate run/rig.toml --model paper12 -o cal");
    fs::copy(path.join("scenario.toml"), path.join("cal/scenario.toml")).unwrap();
    for (part, name) in [("1/2", "one"), ("2/2", "two")] {
        let campaign =
            format!("monte-carlo scenario.toml --runs 2 --shard {part} -o {name}.parquet");
        assert_eq!(rins_in(path, &campaign).code, Some(0));
    }
    folder
}

/// All entries in a folder except hidden ones: path, kind and content.
fn everything(folder: &Path) -> Vec<(PathBuf, String, Vec<u8>)> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            let kind = fs::symlink_metadata(&path).unwrap().file_type();
            let content = if kind.is_file() { fs::read(&path).unwrap() } else { Vec::new() };
            if kind.is_dir() {
                folders.push(path.clone());
            }
            found.push((path, format!("{kind:?} {}", kind.is_fifo()), content));
        }
    }
    found.sort();
    found
}

/// Asserts that a command is refused with these words, and nothing has changed.
fn assert_refused(folder: &Path, command: &str, destination: &str, says: &str) {
    let before = everything(folder);
    let Finished { code, err, .. } =
        rins_in(folder, &format!("{command} -o {destination} --force"));
    assert_eq!(code, Some(1), "{command} -o {destination}: {err}");
    assert!(err.contains(says), "{command} -o {destination}: {err}");
    assert!(before == everything(folder), "{command} -o {destination} changed something");
}

/// Destinations of every kind that must not be replaced, except devices, which need a privilege to be created.
fn specials(folder: &Path) -> [(&'static str, &'static str); 5] {
    let made = Command::new("mkfifo").arg(folder.join("pipe")).status().unwrap();
    assert!(made.success());
    drop(UnixListener::bind(folder.join("socket")).unwrap());
    fs::write(folder.join("mine.txt"), "mine").unwrap();
    fs::create_dir(folder.join("mine")).unwrap();
    fs::write(folder.join("mine/letter.txt"), "mine").unwrap();
    symlink("mine.txt", folder.join("link")).unwrap();
    symlink("mine", folder.join("folder-link")).unwrap();
    [
        ("pipe", "is a pipe"),
        ("socket", "is a socket"),
        ("link", "is a symbolic link"),
        ("folder-link", "is a symbolic link"),
        ("mine", "mine: is "),
    ]
}

#[test]
fn what_is_no_file_or_folder_of_ours_is_never_replaced() {
    let folder = prepared();
    let folder = folder.path();
    for (destination, says) in specials(folder) {
        for (command, _) in TO_FILES {
            assert_refused(folder, command, destination, says);
        }
        for (command, _) in TO_FOLDERS {
            assert_refused(folder, command, destination, says);
        }
    }
}

#[test]
fn no_command_writes_over_what_it_reads() {
    let folder = prepared();
    let folder = folder.path();
    for (command, inputs) in TO_FILES {
        for input in inputs {
            assert_refused(folder, command, input, "choose another name");
            // Another name of the same file is refused too.
            let other = folder.join("other-name");
            fs::hard_link(folder.join(input), &other).unwrap();
            assert_refused(folder, command, "other-name", "choose another name");
            fs::remove_file(other).unwrap();
        }
    }
    for (command, holding) in TO_FOLDERS {
        assert_refused(folder, command, holding, "an input of the same command");
    }
}

/// Results of rins are replaced on request.
#[test]
fn results_are_replaced() {
    let folder = prepared();
    let folder = folder.path();
    for (place, (command, _)) in TO_FILES.into_iter().enumerate() {
        for _ in 0..2 {
            let again = format!("{command} -o result-{place} --force");
            let Finished { code, err, .. } = rins_in(folder, &again);
            assert_eq!(code, Some(0), "{again}: {err}");
        }
    }
    for (place, (command, _)) in TO_FOLDERS.into_iter().enumerate() {
        for _ in 0..2 {
            let again = format!("{command} -o folder-{place} --force");
            let Finished { code, err, .. } = rins_in(folder, &again);
            assert_eq!(code, Some(0), "{again}: {err}");
        }
    }
    // An unfinished campaign too.
    fs::write(folder.join("campaign.part"), "").unwrap();
    let campaign = rins_in(folder, "monte-carlo scenario.toml --runs 2 -o campaign --force");
    assert_eq!((campaign.code, folder.join("campaign.part").exists()), (Some(0), false));
}

/// A pipe does not block, and control characters in a path are not written to the terminal.
#[test]
fn pipes_and_paths_with_control_characters_are_told() {
    let folder = prepared();
    let folder = folder.path();
    let made = Command::new("mkfifo").arg(folder.join("pipe.csv")).status().unwrap();
    assert!(made.success());
    let rig = fs::read_to_string(folder.join("run/rig.toml")).unwrap();
    let with = |log: &str| rig.replace("path = \"run.csv\"", &format!("path = \"{log}\""));
    fs::write(folder.join("pipe.toml"), with("pipe.csv")).unwrap();
    for command in ["check pipe.toml", "init pipe.csv", "check pipe.csv"] {
        let Finished { code, err, .. } = rins_in(folder, command);
        assert_eq!(code, Some(1), "{command}: {err}");
        assert!(err.contains("is a pipe, expected a regular file"), "{command}: {err}");
    }
    fs::write(folder.join("hostile.toml"), with(r"\u001b[31mred\nrins: ok.csv")).unwrap();
    for command in ["check hostile.toml", "calibrate hostile.toml"] {
        let Finished { err, .. } = rins_in(folder, command);
        assert!(err.contains("\\u{1b}[31mred\\nrins: ok.csv"), "{err:?}");
        assert!(!err.trim_end().contains(['\u{1b}', '\n']), "{err:?}");
    }
}
