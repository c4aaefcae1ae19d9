//! The paper's experiments, run by a separate program, so that the tests of xtask need not wait for its build.

use std::path::Path;
use std::process::Command;

use clap::Args;

use crate::Result;

/// The options of the experiments.
#[derive(Args)]
pub(crate) struct Options {
    /// Write nothing; fail if the page or a figure in the repository differs
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
