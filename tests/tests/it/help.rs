//! What `--help` says, kept in `tests/snapshots`.
//!
//! After a change that is meant, `RINS_RENEW=1 cargo test -p rins-tests help` writes them anew; read
//! the difference before it is committed.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::rins_in;

const COMMANDS: [&str; 16] = [
    "",
    "demo",
    "init",
    "simulate",
    "convert",
    "check",
    "allan",
    "align",
    "navigate",
    "calibrate",
    "diagnose",
    "observe",
    "monte-carlo",
    "merge",
    "apply",
    "compare",
];

fn snapshot(command: &str) -> PathBuf {
    let name = if command.is_empty() { "rins" } else { command };
    rins_tests::workspace().join("tests/snapshots").join(format!("{name}.txt"))
}

fn help(command: &str) -> String {
    let finished = rins_in(Path::new("."), &format!("{command} --help"));
    assert_eq!((finished.code, finished.err.as_str()), (Some(0), ""), "{command}");
    finished.out.lines().map(|line| line.trim_end().to_owned() + "\n").collect()
}

#[test]
fn help_is_as_it_was_read_last() {
    for command in COMMANDS {
        let path = snapshot(command);
        let help = help(command);
        if std::env::var_os("RINS_RENEW").is_some() {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(&path, &help).unwrap();
        }
        let kept = fs::read_to_string(&path)
            .unwrap_or_else(|error| panic!("{}: {error}; see help.rs", path.display()));
        assert_eq!(help, kept, "rins {command} --help; see help.rs if that is meant");
    }
}

/// The list of commands in `rins --help` and the one here are the same.
#[test]
fn help_of_every_command_is_kept() {
    let help = help("");
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let listed: Vec<&str> = listed
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.strip_prefix("  ")?.split(' ').next())
        .filter(|word| !word.is_empty() && *word != "help")
        .collect();
    assert_eq!(listed, COMMANDS[1..]);
}

#[test]
fn help_is_told_in_words() {
    for command in COMMANDS {
        let help = help(command);
        let first = help.lines().next().unwrap_or_default();
        assert!(first.starts_with(char::is_uppercase), "{command}: {first:?}");
        assert!(help.contains("\nUsage: rins"), "{command}: {help}");
        for option in help.lines().filter(|line| line.trim_start().starts_with("--")) {
            assert!(option.len() <= 100, "{command}: {option:?} is wider than a terminal");
        }
    }
}

#[test]
fn version_is_the_package_s() {
    let finished = rins_in(Path::new("."), "--version");
    assert_eq!(finished.code, Some(0));
    assert_eq!(finished.out, concat!("rins ", env!("CARGO_PKG_VERSION"), "\n"));
}
