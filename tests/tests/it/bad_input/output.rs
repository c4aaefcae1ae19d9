//! Results that cannot be written to their destination.

use super::files::Spoil::{All, Filled, Nothing};
use super::{DATA, Row, refused};

const OUTPUTS: &[Row] = &[
    (
        "a result that is there",
        "calibrate rig.toml -o old",
        Filled("old", "result.json"),
        &["old: exists already; choose another name, or --force to replace it"],
    ),
    (
        "a folder that is not a result",
        "calibrate rig.toml -o old --force",
        Filled("old", "thesis.tex"),
        &["old: is not replaced, as it does not hold a result of rins"],
    ),
    (
        "a result with a thesis in it",
        "simulate scenario.toml -o old --force",
        All(&[Filled("old", "result.json"), Filled("old", "thesis.tex")]),
        &["old: is not replaced, as it also holds \"thesis.tex\""],
    ),
    ("a file", "check rig.toml -o run.csv", Nothing, &["run.csv: is a file, expected a folder"]),
    (
        "a file, forced",
        "check rig.toml -o run.csv --force",
        Nothing,
        &["run.csv: is a file, expected a folder"],
    ),
    (
        "no parent",
        "navigate rig.toml -o no/such/out",
        Nothing,
        &["cannot write no/such/out", "No such file"],
    ),
    (
        "a parent that is a file",
        "align rig.toml -o rig.toml/out",
        Nothing,
        &["cannot write rig.toml/out", "Not a directory"],
    ),
    ("the folder itself", "simulate scenario.toml -o .", Nothing, &["."]),
    ("the folder above", "demo -o ..", Nothing, &[".."]),
    ("a demo that is there", "demo -o old", Filled("old", "report.html"), &["old: exists already"]),
    (
        "a draft over its log",
        "init run.csv -o run.csv --force",
        Nothing,
        &["run.csv: is the log itself"],
    ),
    ("a draft over a rig", "init run.csv -o rig.toml", Nothing, &["rig.toml: exists already"]),
];

/// `/proc` refuses new folders for any user.
#[cfg(target_os = "linux")]
const READ_ONLY: &[Row] =
    &[("read-only", "calibrate rig.toml -o /proc/out", Nothing, &["cannot write /proc/out"])];

#[test]
fn result_that_has_no_place() {
    refused(DATA, OUTPUTS);
}

#[cfg(target_os = "linux")]
#[test]
fn result_in_a_folder_that_cannot_be_written() {
    refused(DATA, READ_ONLY);
}
