//! Errors in a user's files or command line are reported in one message that names them, and no output
//! remains.

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

/// A case: its name, the arguments, the fault that is applied to the valid files before, and texts in the
/// message, in which `{line}` is the line of the fault.
type Row = (&'static str, &'static str, Spoil, &'static [&'static str]);

/// The exit code for an error in the data or the files.
const DATA: i32 = 1;
/// The exit code for an error in the command line.
const USAGE: i32 = 2;

/// Runs the cases, with JSON output and, unless a row states otherwise, with results in `out`.
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

/// The faults in the form of an error message, whatever the error.
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

/// The paths in a folder and the contents of the files.
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

/// The files are valid before a fault is applied: each command succeeds with them.
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
