//! Monte Carlo campaigns: many simulated and calibrated runs of a scenario.

mod merge;
mod monte_carlo;
mod page;
mod result;
mod runs;
mod size;

pub use self::merge::merge;
pub use self::monte_carlo::{MonteCarloOptions, monte_carlo};
pub use self::page::CampaignOutcome;
pub use self::result::{CampaignResult, CellResult, ScatterResult};
