//! The output of `--help`, stored in `tests/snapshots`.
//!
//! After an intended change, `RINS_RENEW=1 cargo test -p rins-tests help` writes it again; read
//! the difference before it is committed.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use rins_testing::{Fault, assert_rows, is, says};

use crate::support::rins_in;

const COMMANDS: [&str; 20] = [
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
    "design",
    "monte-carlo",
    "merge",
    "apply",
    "compare",
    "history",
    "mission",
    "completions",
];

/// The assumed width of a terminal.
const TERMINAL: usize = 100;

/// The maximum indentation of an option's name, which is followed by its description.
const OPTION_INDENT: usize = 6;
const DESCRIPTION: &str = "          ";

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

/// The page of the book with all commands and options, from the same texts.
fn page() -> String {
    let mut page = String::from(
        "# All commands and options\n\n`rins COMMAND --help` prints these texts. The page is generated from them.\n",
    );
    for command in COMMANDS {
        let name = if command.is_empty() { "rins".into() } else { format!("rins {command}") };
        let text = fs::read_to_string(snapshot(command)).unwrap();
        // Writing to a string cannot fail.
        let _ = write!(page, "\n## `{name}`\n\n```text\n{}\n```\n", text.trim_end());
    }
    page
}

#[test]
fn the_page_of_commands_has_the_help_of_each() {
    let path = rins_tests::workspace().join("docs/src/commands.md");
    if std::env::var_os("RINS_RENEW").is_some() {
        help_is_as_it_was_read_last();
        fs::write(&path, page()).unwrap();
    }
    let kept = fs::read_to_string(&path).unwrap_or_default();
    assert!(kept == page(), "{} is old; see help.rs", path.display());
}

/// The list of commands in `rins --help` is the same as that of this test.
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

/// The faults of a help text: it must begin with a sentence, then the usage, then every option with its description, and no
/// line may be wider than a terminal.
fn help_fault(command: &str, help: &str) -> Fault {
    let lines: Vec<&str> = help.lines().collect();
    let starts_in_words = lines.first().is_some_and(|line| line.starts_with(char::is_uppercase));
    is(&starts_in_words, &true).map_err(|_| format!("begins with {:?}", lines.first()))?;
    says(help, format!("\nUsage: rins {command}").trim_end())?;
    if let Some(wide) = lines.iter().find(|line| line.chars().count() > TERMINAL) {
        return Err(format!("{wide:?} is wider than a terminal"));
    }
    let options = lines.iter().position(|line| *line == "Options:").ok_or("lists no options")? + 1;
    let mut names = Vec::new();
    for (at, line) in lines.iter().enumerate().skip(options) {
        let name = line.trim_start();
        // Deeper lines are descriptions of options and their values.
        if !name.starts_with('-') || line.len() - name.len() > OPTION_INDENT {
            continue;
        }
        let beside = name.split_once("  ").is_some_and(|(_, text)| !text.trim().is_empty());
        let below = lines.get(at + 1).is_some_and(|next| next.starts_with(DESCRIPTION));
        let described = beside || below;
        is(&described, &true).map_err(|_| format!("does not say what {name:?} does"))?;
        names.push(name);
    }
    is(&names.iter().any(|name| name.starts_with("-h, --help")), &true)
        .map_err(|_| format!("has no --help among {names:?}"))
}

#[test]
fn help_says_how_a_command_is_used_and_what_each_option_does() {
    assert_rows(COMMANDS.iter().map(|command| (command, help_fault(command, &help(command)))));
}

/// Missing descriptions, wide lines and missing parts are detected.
#[test]
fn help_that_says_too_little_is_found_out() {
    let right = help("calibrate");
    assert_eq!(help_fault("calibrate", &right), Ok(()));
    let undescribed = right.replace("          Overwrite existing results\n", "");
    let wide = right.replacen('\n', &format!("\n{}\n", "x".repeat(TERMINAL + 1)), 1);
    let without_options = &right[..right.find("Options:").unwrap()];
    for (text, fault) in [
        (undescribed.as_str(), "does not say what \"--force\" does"),
        (&wide, "wider than a terminal"),
        (without_options, "lists no options"),
        (&right.replace("--help", "--hlep"), "has no --help"),
    ] {
        let found = help_fault("calibrate", text).unwrap_err();
        assert!(found.contains(fault), "{found}");
    }
}

/// The scripts of the shells know the commands and their options; there is a man page of each command.
#[test]
fn shells_know_the_commands() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let finished = rins_in(folder.path(), &format!("completions {shell}"));
        assert_eq!(finished.code, Some(0), "{}", finished.err);
        for word in ["diagnose", "monte-carlo", "held-out"] {
            assert!(finished.out.contains(word), "{shell}: {word}");
        }
        let told = crate::support::result_in(folder.path(), &format!("completions {shell}"));
        assert_eq!(told["script"], finished.out);
    }
    let refused = rins_in(folder.path(), "completions tcsh");
    assert_eq!(refused.code, Some(2));
    let finished = rins_in(folder.path(), "man -o man1");
    assert_eq!(finished.code, Some(0), "{}", finished.err);
    for command in COMMANDS {
        let name = if command.is_empty() { "rins".into() } else { format!("rins-{command}") };
        let page = fs::read_to_string(folder.path().join(format!("man1/{name}.1"))).unwrap();
        assert!(page.contains(&format!(".TH {name} 1")), "{name}");
        assert!(page.contains("\\-\\-json"), "{name}");
    }
    assert_eq!(rins_in(folder.path(), "man -o man1").code, Some(1));
}

#[test]
fn version_is_the_package_s() {
    let finished = rins_in(Path::new("."), "--version");
    assert_eq!(finished.code, Some(0));
    assert_eq!(finished.out, concat!("rins ", env!("CARGO_PKG_VERSION"), "\n"));
}
