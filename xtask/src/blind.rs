//! Blind trials of the diagnosis: builds the programs, runs the trials, and writes the page of the book.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;

use crate::Result;

/// The options of the trials.
#[derive(Args)]
pub(crate) struct Options {
    /// Number of trials
    #[arg(long, default_value_t = 1500)]
    trials: usize,
    /// Seed of all trials
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of trials that run in parallel
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Run only the trials that are not in the journal of the folder
    #[arg(long)]
    resume: bool,
    /// Run the frozen trials only, whose results must be unchanged
    #[arg(long, conflicts_with_all = ["resume", "card"])]
    frozen: bool,
    /// Run no trials: write the page from the journal of the folder
    #[arg(long, conflicts_with = "resume")]
    card: bool,
    /// Folder of the journal
    #[arg(short, long, default_value = "target/blind")]
    output: PathBuf,
}

/// Runs trials and writes `docs/src/blind.md`.
pub(crate) fn run(root: &Path, options: &Options) -> Result<()> {
    if options.frozen {
        cargo(root, &["build", "--package", "rins-cli"], &[])?;
        let program = program(root, "debug");
        return cargo(root, TRIALS, &["frozen", &program]);
    }
    let folder = root.join(&options.output);
    let path = journal_in(&folder).display().to_string();
    if !options.card {
        begin_journal(&folder, options.resume)?;
        let program = optimized(root)?;
        let (seed, threads) = (options.seed.to_string(), options.threads.to_string());
        trials(root, &["run", &program, &path, &seed, &options.trials.to_string(), &threads])?;
        trials(root, &["time", &program, &path, &seed, TIMED])?;
    }
    trials(root, &["card", &path, &root.join("docs/src/blind.md").display().to_string()])
}

/// The journal of a folder.
pub(crate) fn journal_in(folder: &Path) -> PathBuf {
    folder.join("journal.jsonl")
}

/// Creates the folder of a journal, and refuses one that exists unless it is resumed.
pub(crate) fn begin_journal(folder: &Path, resume: bool) -> Result<()> {
    let journal = journal_in(folder);
    if journal.exists() && !resume {
        let path = journal.display();
        return Err(format!("{path} exists: go on with it by --resume, or remove it").into());
    }
    Ok(fs::create_dir_all(folder)?)
}

/// The `rins` command, built for speed.
pub(crate) fn optimized(root: &Path) -> Result<String> {
    cargo(root, &["build", "--release", "--package", "rins-cli"], &[])?;
    Ok(program(root, "release"))
}

/// How many of the longest runs are timed.
const TIMED: &str = "20";

/// The few frozen trials take less time than an optimized build.
const TRIALS: &[&str] = &["run", "--package", "rins-trials", "--bin", "trials"];

/// Runs the trials program, built for speed.
pub(crate) fn trials(root: &Path, arguments: &[&str]) -> Result<()> {
    cargo(root, &[TRIALS, &["--release"]].concat(), arguments)
}

fn cargo(root: &Path, words: &[&str], arguments: &[&str]) -> Result<()> {
    let mut command = Command::new("cargo");
    command.args(words).arg("--quiet");
    if !arguments.is_empty() {
        command.arg("--").args(arguments);
    }
    let status = command.current_dir(root).status()?;
    if status.success() {
        Ok(())
    } else {
        Err(format!("{} failed ({status})", words.join(" ")).into())
    }
}

/// The `rins` command in this profile's folder of the target folder.
fn program(root: &Path, profile: &str) -> String {
    let name = format!("rins{}", env::consts::EXE_SUFFIX);
    target(root).join(profile).join(name).display().to_string()
}

/// The target folder of cargo.
fn target(root: &Path) -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from)
}
