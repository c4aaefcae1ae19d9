//! Invalid command lines.

use super::files::Spoil::Nothing;
use super::{Row, USAGE, refused};

const USAGES: &[Row] = &[
    (
        "unknown command",
        "frobnicate",
        Nothing,
        &["unrecognized subcommand 'frobnicate'", "Usage: rins"],
    ),
    (
        "mistyped command",
        "calibrat rig.toml",
        Nothing,
        &["'calibrat'", "a similar subcommand exists: 'calibrate'"],
    ),
    ("unknown option", "check rig.toml --frob", Nothing, &["unexpected argument '--frob'"]),
    (
        "mistyped option",
        "calibrate rig.toml --modle paper12",
        Nothing,
        &["unexpected argument '--modle'", "'--model'"],
    ),
    (
        "unknown model",
        "calibrate rig.toml --model paper13",
        Nothing,
        &["invalid value 'paper13' for '--model <MODEL>'", "paper12"],
    ),
    (
        "a diagnosis by the paper's filter",
        "diagnose rig.toml --model paper12",
        Nothing,
        &["invalid value 'paper12' for '--model <MODEL>'", "expected full or a model file"],
    ),
    (
        "one run diagnosed twice",
        "diagnose rig.toml rig.toml",
        Nothing,
        &["rig.toml is given twice", "Usage: rins diagnose"],
    ),
    (
        "a run held out of itself",
        "diagnose rig.toml --held-out rig.toml",
        Nothing,
        &["rig.toml is given twice", "Usage: rins diagnose"],
    ),
    ("no rig", "check", Nothing, &["required arguments were not provided", "<RIG>"]),
    ("a rig too many", "align rig.toml rig.toml", Nothing, &["unexpected argument 'rig.toml'"]),
    (
        "no folder for a run",
        "simulate scenario.toml",
        Nothing,
        &["required arguments were not provided", "--output <DIR>"],
    ),
    ("a folder without a name", "check rig.toml --output=", Nothing, &["--output <DIR>"]),
    (
        "a seed in words",
        "simulate scenario.toml -o out --seed five",
        Nothing,
        &["invalid value 'five' for '--seed <SEED>'"],
    ),
    (
        "a negative seed",
        "simulate scenario.toml -o out --seed=-5",
        Nothing,
        &["invalid value '-5' for '--seed <SEED>'"],
    ),
    (
        "a seed beyond 64 bits",
        "simulate scenario.toml -o out --seed 18446744073709551616",
        Nothing,
        &["invalid value '18446744073709551616'"],
    ),
    (
        "one folder after another",
        "check rig.toml -o a -o b",
        Nothing,
        &["cannot be used multiple times"],
    ),
    ("JSON of what", "check rig.toml --json=yes", Nothing, &["'--json'"]),
    ("a demo of what", "demo rig.toml", Nothing, &["unexpected argument 'rig.toml'"]),
    ("no log to draft from", "init", Nothing, &["<LOG>"]),
];

#[test]
fn command_line_that_is_not_understood() {
    refused(USAGE, USAGES);
}
