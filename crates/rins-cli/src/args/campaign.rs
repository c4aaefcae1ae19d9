//! The arguments of `rins monte-carlo` and `rins merge`.

use std::path::PathBuf;

use clap::Args;
use rins::ModelChoice;

use crate::choices::{Noise, Truth};

#[derive(Debug, Args)]
pub(crate) struct MonteCarlo {
    /// The scenario file; it may define a parameter grid
    pub(crate) scenario: PathBuf,
    /// Number of runs of each scenario
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=10_000_000_000))]
    pub(crate) runs: u64,
    /// The model: paper12 (`M_xz`, `M_yz` and `S_z` by the 12-state filter of Nie et al. (2019)), full (biases, scale errors,
    /// misalignments, attitude of the spin axis), or a model file. Any model other than paper12 is estimated as by `rins calibrate`
    #[arg(long, default_value = "paper12", value_parser = ModelChoice::parse)]
    pub(crate) model: ModelChoice,
    /// Source of the noise parameters; paper12 always uses the data sheet
    #[arg(long, value_enum, default_value_t = Noise::Likely)]
    pub(crate) noise: Noise,
    /// Source of the true values of the estimated parameters; paper12 always has those of the scenario
    #[arg(long, value_enum, default_value_t = Truth::Prior)]
    pub(crate) truth: Truth,
    /// Seed of the random numbers; by default the scenario's
    #[arg(long)]
    pub(crate) seed: Option<u64>,
    /// Results file (Parquet); the report has the same name with the extension .html
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Continue a campaign that was interrupted
    #[arg(long)]
    pub(crate) resume: bool,
    /// Run only part I of N (a shard), such as 2/5, for `rins merge`
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub(crate) shard: Option<(u64, u64)>,
    /// Number of threads; by default one per core
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
}

#[derive(Debug, Args)]
pub(crate) struct Merge {
    /// The partial results: one file for each shard
    #[arg(required = true)]
    pub(crate) parts: Vec<PathBuf>,
    /// Merged results file (Parquet); the report has the same name with the extension .html
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
}

/// A shard and how many there are.
fn shard(text: &str) -> Result<(u64, u64), String> {
    let numbers = text
        .split_once('/')
        .and_then(|(shard, of)| Some((shard.parse::<u64>().ok()?, of.parse::<u64>().ok()?)));
    numbers
        .filter(|(shard, of)| (1..=*of).contains(shard))
        .ok_or_else(|| "expected a shard of so many, such as 2/5".into())
}
