//! Campaigns of any model: sensor errors are drawn from their priors, simulated, and estimated as by `rins calibrate`.

mod cell;
mod deliver;
mod page;
mod result;
mod run;
mod scored;
mod text;
mod truth;

pub(super) use self::cell::ModelRuns;
pub(super) use self::deliver::deliver_model;
pub use self::result::{CombinationResult, CoverageResult, PosteriorResult, RankBandResult};
pub(super) use self::run::ModelRun;
