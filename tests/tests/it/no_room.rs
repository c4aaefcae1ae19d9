//! If results cannot be written, no part of them remains.
#![cfg(target_os = "linux")]

use std::fs;
use std::path::Path;
use std::process::Command;

use rins_tests::rins;
use tempfile::TempDir;

use crate::support::{Finished, rins_in};

/// Each command that writes, with its output if there is enough space.
const COMMANDS: [(&str, &str); 9] = [
    ("demo -o disk/out", "disk/out"),
    ("simulate scenario.toml -o disk/out", "disk/out"),
    ("check rig.toml -o disk/out", "disk/out"),
    ("align rig.toml -o disk/out", "disk/out"),
    ("navigate rig.toml -o disk/out", "disk/out"),
    ("calibrate rig.toml -o disk/out", "disk/out"),
    ("convert rig.toml -o disk/out.csv", "disk/out.csv"),
    ("convert rig.toml -o disk/out.parquet", "disk/out.parquet"),
    ("convert rig.toml -o disk/out.mat", "disk/out.mat"),
];

fn run() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let demo = rins_tests::workspace().join("crates/rins/data/demo");
    for name in ["rig.toml", "run.csv", "scenario.toml"] {
        fs::copy(demo.join(name), folder.path().join(name)).unwrap();
    }
    fs::create_dir(folder.path().join("disk")).unwrap();
    folder
}

/// Runs a script in `folder`, in which `"$0"` is `rins`.
fn shell(program: &[&str], script: &str, folder: &Path) -> Finished {
    let binary = rins().get_program().to_owned();
    let mut command = Command::new(program[0]);
    command.args(&program[1..]).args(["sh", "-c", script]).arg(binary).current_dir(folder);
    command.output().unwrap().into()
}

fn is_refused(finished: &Finished, command: &str, says: &str) {
    assert_eq!(finished.code, Some(1), "{command}: {}{}", finished.err, finished.out);
    let told =
        finished.err.starts_with("rins: cannot write disk/out") && finished.err.contains(says);
    assert!(told, "{command}: {}", finished.err);
}

/// No file may exceed a few blocks: writing fails in the middle.
#[test]
fn a_file_that_cannot_grow_is_not_left_half_written() {
    // The demo's own files, which are elsewhere, would be the first to fail.
    for (command, _) in COMMANDS.into_iter().skip(1) {
        let folder = run();
        let script = format!("trap '' XFSZ; ulimit -f 16; exec \"$0\" {command}");
        is_refused(&shell(&["env"], &script, folder.path()), command, "File too large");
        let left: Vec<_> = fs::read_dir(folder.path().join("disk")).unwrap().collect();
        assert!(left.is_empty(), "{command} leaves {left:?}");
    }
}

#[test]
#[cfg_attr(not(private_mounts), ignore = "this user may mount nothing")]
fn a_disk_that_is_full_keeps_nothing() {
    for (command, place) in COMMANDS {
        let folder = run();
        let script = format!(
            "mount -t tmpfs -o size=4k tmpfs disk && \"$0\" {command}; code=$?; \
             test -z \"$(ls -A disk)\" || echo left: $(ls -A disk); \
             test -e {place} && echo there; exit $code"
        );
        let finished = shell(&["unshare", "-rm"], &script, folder.path());
        is_refused(&finished, command, "No space left on device");
        assert_eq!(finished.out, "", "{command}");
    }
}

#[test]
#[cfg_attr(not(private_mounts), ignore = "this user may mount nothing")]
fn a_disk_that_cannot_be_written_is_named() {
    for (command, _) in COMMANDS {
        let folder = run();
        let script = format!("mount -t tmpfs -o ro tmpfs disk && exec \"$0\" {command}");
        let finished = shell(&["unshare", "-rm"], &script, folder.path());
        is_refused(&finished, command, "Read-only file system");
    }
}

/// An old result remains if the disk has no space for the new one.
#[test]
#[cfg_attr(not(private_mounts), ignore = "this user may mount nothing")]
fn an_old_result_outlives_a_full_disk() {
    let folder = run();
    let made = rins_in(folder.path(), "check rig.toml -o old");
    assert_eq!(made.code, Some(0), "{}", made.err);
    let script = "size=$(du -sk old | cut -f1); mount -t tmpfs -o size=$((size + 40))k tmpfs disk && \
                  cp -r old disk/out && before=$(cat disk/out/* | cksum); \
                  \"$0\" calibrate rig.toml -o disk/out --force; code=$?; \
                  test \"$before\" = \"$(cat disk/out/* | cksum)\" || echo changed; \
                  test \"$(ls -A disk)\" = out || echo left: $(ls -A disk); exit $code";
    let finished = shell(&["unshare", "-rm"], script, folder.path());
    is_refused(&finished, "calibrate", "No space left on device");
    assert_eq!(finished.out, "");
}

/// If the output cannot be printed, or has no reader, no command panics.
#[test]
fn what_cannot_be_printed_is_said_or_not_missed() {
    let folder = run();
    for (script, code, says) in [
        ("\"$0\" check rig.toml > /dev/full", 1, "rins: cannot write to standard output: "),
        ("\"$0\" check rig.toml --json > /dev/full", 1, "rins: cannot write to standard output: "),
        ("\"$0\" check none.toml 2> /dev/full", 1, ""),
        ("\"$0\" --help > /dev/full; true", 0, ""),
        ("(\"$0\" check rig.toml --json; echo \"code $?\" >&2) | true", 0, "code 0"),
    ] {
        let finished = shell(&["env"], script, folder.path());
        assert_eq!(finished.code, Some(code), "{script}: {}", finished.err);
        assert!(finished.err.starts_with(says), "{script}: {}", finished.err);
        assert!(!finished.err.contains("panicked"), "{script}: {}", finished.err);
    }
}
