//! The false alarm rate of the whole diagnosis, simulated: builds the programs, runs them, and writes the page of the book.

use std::path::{Path, PathBuf};
use std::process::Command;

use clap::Args;

use crate::Result;
use crate::blind::{begin_journal, journal_in, optimized, trials};

/// The options of the simulation.
#[derive(Args)]
pub(crate) struct Options {
    /// Number of runs
    #[arg(long, default_value_t = 1100)]
    runs: usize,
    /// Seed of all runs
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of runs that are diagnosed in parallel
    #[arg(long, default_value_t = 2)]
    threads: usize,
    /// Diagnose only the runs that are not in the journal of the folder
    #[arg(long)]
    resume: bool,
    /// Folder of the journal
    #[arg(long, default_value = "target/false-alarms")]
    output: PathBuf,
}

/// Diagnoses runs without an unmodeled error and writes `docs/src/false-alarms.md`.
pub(crate) fn run(root: &Path, options: &Options) -> Result<()> {
    let folder = root.join(&options.output);
    let path = journal_in(&folder).display().to_string();
    begin_journal(&folder, options.resume)?;
    let program = optimized(root)?;
    let [seed, runs, threads] =
        [options.seed.to_string(), options.runs.to_string(), options.threads.to_string()];
    trials(root, &["null", &program, &path, &seed, &runs, &threads])?;
    let page = root.join("docs/src/false-alarms.md").display().to_string();
    trials(root, &["null-page", &path, &page, &revision(root)?])
}

/// The revision of the workspace, with its date.
pub(crate) fn revision(root: &Path) -> Result<String> {
    let asked = ["log", "-1", "--format=%h (%cs)"];
    let output = Command::new("git").args(asked).current_dir(root).output()?;
    if !output.status.success() {
        return Err("git log failed: the revision is not known".into());
    }
    Ok(String::from_utf8(output.stdout)?.trim().to_owned())
}
