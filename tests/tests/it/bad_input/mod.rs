//! What is wrong with a user's files or command line is said in one message that names it, and
//! leaves nothing behind.

mod calibration;
mod files;
mod log;
mod model;
mod output;
mod rig;
mod scenario;
mod suspected;
mod usage;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::support::{Finished, rins_in};
use files::{Folder, Spoil};

/// A case: what it is, the arguments, what is done to the good files before, and what the message
/// says. In that, `{line}` stands for the line that was spoiled.
type Row = (&'static str, &'static str, Spoil, &'static [&'static str]);

/// The exit code if the data or the files are at fault.
const DATA: i32 = 1;
/// The exit code if the command line is.
const USAGE: i32 = 2;

/// Runs the cases, asking for JSON and, unless a row says where to, for results in `out`.
fn refused(code: i32, rows: &[Row]) {
    let mut failures = String::new();
    for (name, arguments, spoil, says) in rows {
        let folder = Folder::new();
        let line = folder.spoil(spoil);
        let before = listing(folder.path());
        let to = if arguments.contains("-o ") || code == USAGE { "" } else { " -o out" };
        let finished = rins_in(folder.path(), &format!("{arguments}{to} --json"));
        let mut faults = message_faults(code, &finished);
        for fragment in *says {
            let fragment = fragment.replace("{line}", &line.to_string());
            if !finished.err.contains(&fragment) {
                faults.push(format!("does not say {fragment:?}"));
            }
        }
        if listing(folder.path()) != before {
            faults.push("leaves files changed".into());
        }
        if !faults.is_empty() {
            let _ = writeln!(
                failures,
                "{name}: {}; exit {:?}, standard error {:?}",
                faults.join(", "),
                finished.code,
                finished.err
            );
        }
    }
    assert!(failures.is_empty(), "of {} cases:\n{failures}", rows.len());
}

/// What is wrong with the way something is refused, whatever it is.
fn message_faults(code: i32, finished: &Finished) -> Vec<String> {
    let mut faults = Vec::new();
    if finished.code != Some(code) {
        faults.push(format!("does not exit with {code}"));
    }
    if !finished.out.is_empty() {
        faults.push(format!("prints {:?}", finished.out));
    }
    let opening = if code == USAGE { "error: " } else { "rins: " };
    if !finished.err.starts_with(opening) || finished.err.matches(opening).count() != 1 {
        faults.push(format!("is not one message that begins with {opening:?}"));
    }
    if code == DATA && finished.err.trim_end().lines().count() != 1 {
        faults.push("is not one line".into());
    }
    for word in ["panicked", "backtrace", "RUST_"] {
        if finished.err.contains(word) {
            faults.push(format!("says {word:?}"));
        }
    }
    faults
}

/// The paths under a folder and what is in the files.
fn listing(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.display().to_string();
        if path.is_dir() {
            found.extend(listing(&path));
            found.insert(name, Vec::new());
        } else {
            found.insert(name, fs::read(&path).unwrap());
        }
    }
    found
}

/// What the cases spoil is good: each command does its work on it.
#[test]
fn good_files_are_taken() {
    let folder = Folder::new();
    let commands = [
        "check rig.toml",
        "align rig.toml",
        "navigate rig.toml --calibration calibration.toml",
        "calibrate rig.toml",
        "simulate scenario.toml",
        "init run.csv",
    ];
    for command in commands {
        let command = format!("{command} -o {}", command.replace([' ', '.'], "_"));
        let finished = rins_in(folder.path(), &command);
        assert_eq!((finished.code, finished.err.as_str()), (Some(0), ""), "{command}");
    }
}
