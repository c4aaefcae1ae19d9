//! The paper's experiments, run by a program of its own: the tests of the workspace's commands need not wait for it.

use std::path::Path;
use std::process::Command;

use clap::Args;

use crate::Result;

/// Whether to write the page or to look at it.
#[derive(Args)]
pub(crate) struct Options {
    /// Write nothing; fail if the page or a figure in the repository says something else
    #[arg(long)]
    check: bool,
}

/// Runs the experiments and writes `docs/src/reproduction.md` with its figures, or checks them.
pub(crate) fn run(root: &Path, options: &Options) -> Result<()> {
    let arguments: &[&str] = if options.check { &["reproduce", "--check"] } else { &["reproduce"] };
    program(root, arguments)
}

/// Runs the program `reproduction`.
pub(crate) fn program(root: &Path, arguments: &[&str]) -> Result<()> {
    let status = Command::new("cargo")
        .args(["run", "--quiet", "--package", "rins-reproduction", "--"])
        .args(arguments)
        .current_dir(root)
        .status()?;
    if status.success() {
        Ok(())
    } else {
        Err(format!("{} failed ({status})", arguments.join(" ")).into())
    }
}
