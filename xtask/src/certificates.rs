//! The coverage of the expanded uncertainty: calibrates in simulated laboratories, and writes the page of the book.

use std::path::Path;

use clap::Args;

use crate::Result;
use crate::blind::{optimized, trials};
use crate::false_alarms::revision;

/// The options of the simulation.
#[derive(Args)]
pub(crate) struct Options {
    /// Number of laboratories
    #[arg(long, default_value_t = 2000)]
    laboratories: u64,
    /// Seed of all laboratories
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of laboratories that calibrate in parallel
    #[arg(long, default_value_t = 2)]
    threads: usize,
}

/// Simulates laboratories and writes `docs/src/certificates.md`.
pub(crate) fn run(root: &Path, options: &Options) -> Result<()> {
    let program = optimized(root)?;
    let page = root.join("docs/src/certificates.md").display().to_string();
    let [seed, laboratories] =
        [options.seed, options.laboratories].map(|number| number.to_string());
    let threads = options.threads.to_string();
    let revision = revision(root)?;
    trials(root, &["certificates", &program, &seed, &laboratories, &threads, &page, &revision])
}
