//! The options of a campaign.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use rins_io::Overwrite;

use crate::options::{ModelChoice, NoiseChoice};
use crate::progress::Progress;

/// The source of the true values of the estimated parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TruthChoice {
    /// Each run has its own true values, drawn from the prior distribution of the model. The runs are then a simulation-based calibration:
    /// every posterior, also of a parameter that the data do not determine, is calibrated if model and filter are correct.
    #[default]
    Prior,
    /// All runs have the errors that the scenario states.
    Scenario,
}

impl TruthChoice {
    /// The name in results: `prior` or `scenario`.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Prior => "prior",
            Self::Scenario => "scenario",
        }
    }
}

/// The options of [`monte_carlo`](crate::monte_carlo).
#[derive(Clone, Debug)]
pub struct MonteCarloOptions {
    /// The number of runs of each scenario.
    pub runs: u64,
    /// The seed; by default the scenario's.
    pub seed: Option<u64>,
    /// The estimated model; by default the paper's three parameters.
    pub model: ModelChoice,
    /// The noise parameters of the estimation of any other model; the paper's filter uses those of the data sheet.
    pub noise: NoiseChoice,
    /// The source of the true values of any other model; the paper's filter estimates the errors of the scenario.
    pub truth: TruthChoice,
    /// The Parquet file of the results; the report page is written beside it, with the extension `.html`.
    pub output: PathBuf,
    /// Whether an interrupted campaign is resumed.
    pub resume: bool,
    /// The shard to be run, such as (2, 5) for the second of five; by default the whole campaign.
    pub shard: Option<(u64, u64)>,
    /// The number of threads; by default one per core.
    pub threads: Option<u16>,
    /// Whether existing results may be replaced.
    pub overwrite: Overwrite,
    /// The stop flag: once it is set, the campaign stops after the chunks in progress, and can be resumed.
    pub stopped: Arc<AtomicBool>,
    /// The listener for progress reports.
    pub progress: Progress,
}

impl MonteCarloOptions {
    /// Options for `runs` runs of each scenario, with the results in the file `output`.
    pub fn new(runs: u64, output: impl Into<PathBuf>) -> Self {
        Self {
            runs,
            seed: None,
            model: ModelChoice::Paper12,
            noise: NoiseChoice::default(),
            truth: TruthChoice::default(),
            output: output.into(),
            resume: false,
            shard: None,
            threads: None,
            overwrite: Overwrite::Refuse,
            stopped: Arc::default(),
            progress: Progress::default(),
        }
    }
}
