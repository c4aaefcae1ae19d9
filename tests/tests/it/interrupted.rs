//! Commands that are killed leave what was there, or a result that is whole.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use rins_tests::rins;
use tempfile::TempDir;

use crate::support::rins_in;

/// How often each command is killed.
const KILLS: u32 = 6;

fn run() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let demo = rins_tests::workspace().join("crates/rins-cli/data/demo");
    for name in ["rig.toml", "run.csv", "scenario.toml"] {
        fs::copy(demo.join(name), folder.path().join(name)).unwrap();
    }
    folder
}

fn command(folder: &Path, arguments: &str) -> Command {
    let mut command = rins();
    command.args(arguments.split(' ')).current_dir(folder);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// What is to be seen in a folder, and how long each file is. Hidden names are those of work that
/// was not finished.
fn seen(folder: &Path) -> Vec<(String, u64)> {
    let mut seen = Vec::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap()) {
            let name = entry.file_name().to_string_lossy().into_owned();
            if name.starts_with('.') {
                continue;
            }
            if entry.file_type().unwrap().is_dir() {
                folders.push(entry.path());
            }
            seen.push((name, entry.metadata().map_or(0, |data| data.len())));
        }
    }
    seen.sort();
    seen
}

/// Kills `arguments` at moments all through its run: what is then seen is one of `states`, and
/// with nothing in the way the command works afterwards.
fn killed(arguments: &str, prepare: &str) {
    let whole = run();
    if !prepare.is_empty() {
        assert_eq!(rins_in(whole.path(), prepare).code, Some(0), "{prepare}");
    }
    let before = seen(whole.path());
    let start = Instant::now();
    assert!(command(whole.path(), arguments).status().unwrap().success(), "{arguments}");
    let lasting = start.elapsed();
    let after = seen(whole.path());
    assert_ne!(before, after, "{arguments}");
    for kill in 0..KILLS {
        let folder = run();
        if !prepare.is_empty() {
            assert_eq!(rins_in(folder.path(), prepare).code, Some(0));
        }
        let mut child = command(folder.path(), arguments).spawn().unwrap();
        // More often towards the end, where results are put in their place.
        let part = (f64::from(kill + 1) / f64::from(KILLS)).sqrt();
        std::thread::sleep(Duration::from_secs_f64(lasting.as_secs_f64() * part));
        let _ = child.kill();
        child.wait().unwrap();
        let seen = seen(folder.path());
        // Of two files that belong together one may be there; whatever is there is whole.
        let whole = |file: &(String, u64)| before.contains(file) || after.contains(file);
        assert!(seen.iter().all(whole), "{arguments} killed after {part:.2} left {seen:?}");
        // Only what is to be replaced may be gone: it then stands under a hidden name.
        let kept = |(name, _): &(String, u64)| seen.iter().any(|(seen, _)| seen == name);
        assert!(arguments.ends_with("--force") || before.iter().all(kept), "{seen:?}");
        let again = arguments.trim_end_matches(" --force");
        let finished = rins_in(folder.path(), &format!("{again} --force"));
        assert_eq!(finished.code, Some(0), "{}", finished.err);
    }
}

#[test]
fn a_simulation_is_there_or_not() {
    killed("simulate scenario.toml -o out", "");
}

#[test]
fn a_conversion_is_there_or_not() {
    killed("convert rig.toml -o new.parquet", "");
}

#[test]
fn a_draft_is_there_or_not() {
    killed("init run.csv -o new.toml", "");
}

#[test]
fn a_result_that_is_replaced_is_the_old_one_or_the_new() {
    killed("check rig.toml -o out --force", "simulate scenario.toml -o out");
}
