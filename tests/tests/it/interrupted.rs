//! Commands that are killed leave the previous files, or a complete result.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use rins_tests::rins;
use tempfile::TempDir;

use crate::monte_carlo::scenario;
use crate::support::rins_in;

/// The default number of kills of each command, without `RINS_KILLS`.
const KILLS: u32 = 6;

fn kills() -> u32 {
    std::env::var("RINS_KILLS").map_or(KILLS, |kills| kills.parse().unwrap())
}

/// Kills a command after a fraction of its duration; returns whether it was still running.
fn kill_after(mut command: Command, lasting: Duration, part: f64) -> bool {
    let mut child = command.spawn().unwrap();
    std::thread::sleep(lasting.mul_f64(part));
    let _ = child.kill();
    child.wait().unwrap().code().is_none()
}

/// The fractions of the duration after which a command is killed: more often towards the end, when results
/// are moved to their place.
fn parts() -> impl Iterator<Item = f64> {
    let kills = kills();
    (1..=kills).map(move |kill| (f64::from(kill) / f64::from(kills)).sqrt())
}

/// Reports how often a command was killed while running; fails if that was only a small part of many kills.
#[expect(clippy::print_stderr, reason = "a test that is asked for figures gives them")]
fn assert_at_work(arguments: &str, at_work: u32) {
    eprintln!("{arguments}: killed {at_work} of {} times while at work", kills());
    // On a busy machine durations vary: if there are few kills, all may come too late.
    if std::env::var_os("RINS_KILLS").is_some() {
        assert!(4 * at_work >= kills(), "{arguments}: {at_work} of {} times at work", kills());
    }
}

/// A scenario of a minute, and its run.
fn run() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let demo = rins_tests::workspace().join("crates/rins/data/demo");
    let scenario = fs::read_to_string(demo.join("scenario.toml")).unwrap();
    assert!(scenario.contains("\"180 s\""));
    let short = scenario.replace("\"180 s\"", "\"30 s\"");
    fs::write(folder.path().join("scenario.toml"), short).unwrap();
    assert_eq!(rins_in(folder.path(), "simulate scenario.toml -o run").code, Some(0));
    folder
}

/// The same folder once more.
fn copy(from: &Path) -> TempDir {
    fn all(from: &Path, to: &Path) {
        for entry in fs::read_dir(from).unwrap().map(|entry| entry.unwrap()) {
            let to = to.join(entry.file_name());
            if entry.file_type().unwrap().is_dir() {
                fs::create_dir(&to).unwrap();
                all(&entry.path(), &to);
            } else {
                fs::copy(entry.path(), to).unwrap();
            }
        }
    }
    let folder = tempfile::tempdir().unwrap();
    all(from, folder.path());
    folder
}

fn command(folder: &Path, arguments: &str) -> Command {
    let mut command = rins();
    command.args(arguments.split(' ')).current_dir(folder);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// The visible entries of a folder, with the content of each file. Hidden names are those of unfinished
/// output.
fn seen(folder: &Path) -> Vec<(String, Vec<u8>)> {
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
                seen.push((name, Vec::new()));
            } else {
                seen.push((name, fs::read(entry.path()).unwrap()));
            }
        }
    }
    seen.sort();
    seen
}

/// Kills `arguments` at times distributed over its run: the visible files are then one of `states`, and
/// the command works afterwards without manual cleanup.
fn killed(arguments: &str, prepare: &str) {
    let whole = run();
    if !prepare.is_empty() {
        assert_eq!(rins_in(whole.path(), prepare).code, Some(0), "{prepare}");
    }
    let before = seen(whole.path());
    let ready = copy(whole.path());
    let start = Instant::now();
    assert!(command(whole.path(), arguments).status().unwrap().success(), "{arguments}");
    let lasting = start.elapsed();
    let after = seen(whole.path());
    assert_ne!(before, after, "{arguments}");
    let mut at_work = 0;
    for part in parts() {
        let folder = copy(ready.path());
        at_work += u32::from(kill_after(command(folder.path(), arguments), lasting, part));
        let seen = seen(folder.path());
        // Of two files that belong together only one may exist; every existing file is complete.
        let whole = |file: &&(String, Vec<u8>)| !before.contains(file) && !after.contains(file);
        let odd: Vec<&str> = seen.iter().filter(whole).map(|(name, _)| name.as_str()).collect();
        assert!(odd.is_empty(), "{arguments} killed after {part:.3} left {odd:?}");
        // Only the file to be replaced may be missing: it then exists under a hidden name.
        let kept = |(name, _): &(String, Vec<u8>)| seen.iter().any(|(seen, _)| seen == name);
        assert!(
            arguments.ends_with("--force") || before.iter().all(kept),
            "{arguments}: {part:.3}"
        );
        let again = arguments.trim_end_matches(" --force");
        let finished = rins_in(folder.path(), &format!("{again} --force"));
        assert_eq!(finished.code, Some(0), "{}", finished.err);
    }
    assert_at_work(arguments, at_work);
}

#[test]
fn a_simulation_is_there_or_not() {
    killed("simulate scenario.toml -o out", "");
}

#[test]
fn a_conversion_is_there_or_not() {
    killed("convert run/rig.toml -o new.parquet", "");
}

#[test]
fn a_draft_is_there_or_not() {
    killed("init run/run.csv -o new.toml", "");
}

#[test]
fn a_result_that_is_replaced_is_the_old_one_or_the_new() {
    killed("check run/rig.toml -o out --force", "simulate scenario.toml -o out");
}

#[test]
fn a_calibration_is_there_or_not() {
    killed("calibrate run/rig.toml --model paper12 -o out", "");
}

#[test]
fn a_log_is_compensated_or_not() {
    let calibrate = "calibrate run/rig.toml --model paper12 -o cal";
    killed("apply run/rig.toml --calibration cal/calibration.toml -o clean.csv", calibrate);
}

/// The entries of a folder, hidden or not.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// An interrupt other than a kill leaves no unfinished output.
#[test]
fn what_an_interrupted_command_had_begun_is_removed() {
    ended_by("-INT", 130);
}

#[test]
fn what_a_command_had_begun_that_is_told_to_end_is_removed() {
    ended_by("-TERM", 143);
}

/// The hangup of a terminal is such a signal, unless it is ignored.
#[test]
fn what_a_command_had_begun_whose_terminal_hangs_up_is_removed() {
    ended_by("-HUP", 129);
}

/// The command with the signal handling of a terminal, independent of that of the tests.
fn listening(folder: &Path, arguments: &str) -> Command {
    let rins = command(folder, arguments);
    let mut command = Command::new("env");
    command.arg("--default-signal=HUP,INT,TERM").arg(rins.get_program()).args(rins.get_args());
    command.current_dir(folder).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

fn ended_by(signal: &str, expected: i32) {
    let mut at_work = 0;
    for (arguments, results) in [
        ("simulate scenario.toml -o out", &["out"][..]),
        ("convert run/rig.toml -o new.csv", &["new.csv", "new.toml"]),
        ("check run/rig.toml -o out", &["out"]),
    ] {
        let whole = run();
        let ready = copy(whole.path());
        let start = Instant::now();
        assert!(command(whole.path(), arguments).status().unwrap().success(), "{arguments}");
        let lasting = start.elapsed();
        let before = names(ready.path());
        let mut after: Vec<String> =
            before.iter().cloned().chain(results.iter().map(|&name| name.into())).collect();
        after.sort();
        for part in parts() {
            let folder = copy(ready.path());
            let mut child = listening(folder.path(), arguments).spawn().unwrap();
            std::thread::sleep(lasting.mul_f64(part));
            let interrupt = [signal, &child.id().to_string()];
            let _ = Command::new("kill").args(interrupt).stderr(Stdio::null()).status().unwrap();
            let code = child.wait().unwrap().code();
            let left = names(folder.path());
            // A signal that arrives before the handler is installed ends the command without a code.
            let whole = if code == Some(0) { vec![&after] } else { vec![&before, &after] };
            assert!(whole.contains(&&left), "{arguments}: {part:.3}, {code:?}: {left:?}");
            assert!([Some(0), Some(expected), None].contains(&code), "{arguments}: {code:?}");
            at_work += u32::from(code == Some(expected));
        }
    }
    assert!(at_work > 0, "no command was at work when it was sent {signal}");
}

/// A campaign that is repeatedly killed and resumed gives the same bytes as an uninterrupted
/// one.
#[test]
fn a_campaign_that_is_killed_time_and_again_loses_nothing() {
    const CAMPAIGN: &str = "monte-carlo scenario.toml --runs 150 --seed 3";
    let whole = tempfile::tempdir().unwrap();
    scenario(whole.path());
    let folder = copy(whole.path());
    let mut alone = command(whole.path(), &format!("{CAMPAIGN} -o c.parquet"));
    let start = Instant::now();
    assert!(alone.status().unwrap().success());
    let lasting = start.elapsed();
    let results = fs::read(whole.path().join("c.parquet")).unwrap();
    let path = |name: &str| folder.path().join(name);
    let (mut at_work, mut journals) = (0, 0);
    for part in parts() {
        let resume = if path("c.parquet.part").exists() { " --resume" } else { "" };
        let campaign = command(folder.path(), &format!("{CAMPAIGN} -o c.parquet --force{resume}"));
        at_work += u32::from(kill_after(campaign, lasting, part));
        journals += u32::from(path("c.parquet.part").exists());
        if let Ok(bytes) = fs::read(path("c.parquet")) {
            assert!(bytes == results, "killed after {part:.3}");
            // Once more from the start.
            fs::remove_file(path("c.parquet")).unwrap();
            let _ = fs::remove_file(path("c.parquet.part"));
        }
    }
    assert!(journals > 0, "no campaign was killed between its beginning and its end");
    let resume = if path("c.parquet.part").exists() { " --resume" } else { "" };
    let finished = rins_in(folder.path(), &format!("{CAMPAIGN} -o c.parquet --force{resume}"));
    assert_eq!(finished.code, Some(0), "{}", finished.err);
    assert!(fs::read(path("c.parquet")).unwrap() == results);
    assert_at_work(CAMPAIGN, at_work);
}
