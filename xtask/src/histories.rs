//! How well variations between runs are named and predicted: simulates campaigns of runs, and writes the page of the book.

use std::path::Path;

use clap::Args;

use crate::Result;
use crate::blind::trials;
use crate::false_alarms::revision;

/// The options of the simulation.
#[derive(Args)]
pub(crate) struct Options {
    /// Number of campaigns
    #[arg(long, default_value_t = 1500)]
    campaigns: u64,
    /// Seed of all campaigns
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Simulates campaigns and writes `docs/src/history-trials.md`.
pub(crate) fn run(root: &Path, options: &Options) -> Result<()> {
    let page = root.join("docs/src/history-trials.md").display().to_string();
    let [seed, campaigns] = [options.seed, options.campaigns].map(|number| number.to_string());
    trials(root, &["histories", &seed, &campaigns, &page, &revision(root)?])
}
