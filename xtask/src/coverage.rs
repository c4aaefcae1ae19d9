//! Coverage of the estimator's intervals, over seeds.

use std::path::Path;

use clap::Args;

use crate::Result;
use crate::reproduce::program;

/// The options of the simulation.
#[derive(Args)]
pub(crate) struct Options {
    /// Runs of each schedule and each noise
    #[arg(long, default_value_t = 200)]
    runs: u32,
}

/// Prints coverage, NEES and variance relative to the bound; fails if they are not those of a consistent estimator.
pub(crate) fn run(root: &Path, options: &Options) -> Result<()> {
    program(root, &["coverage", &options.runs.to_string()])
}
