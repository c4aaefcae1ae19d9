//! Blind trials of the diagnosis: the program and the trials are built, run, and made a page of the book.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;

use crate::Result;

/// Which trials are run.
#[derive(Args)]
pub(crate) struct Options {
    /// How many trials
    #[arg(long, default_value_t = 1500)]
    trials: usize,
    /// The seed that all of them follow from
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How many run at once
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Go on with the trials that the folder's journal does not hold
    #[arg(long)]
    resume: bool,
    /// Run the frozen trials alone, and no campaign: each has to come out as before
    #[arg(long, conflicts_with_all = ["resume", "card"])]
    frozen: bool,
    /// Run nothing: write the page from the folder's journal
    #[arg(long, conflicts_with = "resume")]
    card: bool,
    /// The folder of the journal
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
    let journal = folder.join("journal.jsonl");
    let path = journal.display().to_string();
    if !options.card {
        if journal.exists() && !options.resume {
            return Err(format!("{path} exists: go on with it by --resume, or remove it").into());
        }
        fs::create_dir_all(&folder)?;
        cargo(root, &["build", "--release", "--package", "rins-cli"], &[])?;
        let program = program(root, "release");
        let (seed, threads) = (options.seed.to_string(), options.threads.to_string());
        trials(root, &["run", &program, &path, &seed, &options.trials.to_string(), &threads])?;
        trials(root, &["time", &program, &path, &seed])?;
    }
    trials(root, &["card", &path, &root.join("docs/src/blind.md").display().to_string()])
}

/// The few frozen trials end before an optimised build would.
const TRIALS: &[&str] = &["run", "--package", "rins-trials", "--bin", "trials"];

fn trials(root: &Path, arguments: &[&str]) -> Result<()> {
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

/// The `rins` command as it was built in this folder of the target's.
fn program(root: &Path, profile: &str) -> String {
    let name = format!("rins{}", env::consts::EXE_SUFFIX);
    target(root).join(profile).join(name).display().to_string()
}

/// Where cargo builds.
fn target(root: &Path) -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from)
}
