//! Monte Carlo campaigns: many simulated and calibrated runs of a scenario.

mod execution;
mod merge;
mod model;
mod monte_carlo;
mod options;
mod outcome;
mod page;
mod paper;
mod result;
mod runs;
mod size;

pub use self::merge::merge;
pub use self::model::{CombinationResult, CoverageResult, PosteriorResult, RankBandResult};
pub use self::monte_carlo::monte_carlo;
pub use self::options::{MonteCarloOptions, TruthChoice};
pub use self::outcome::CampaignOutcome;
pub use self::result::{CampaignResult, CellResult, ScatterResult};
