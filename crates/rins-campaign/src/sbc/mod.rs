//! Calibration of Gaussian posteriors over simulated runs, in which the true values are known.

mod combination;
mod ecdf;
mod interval;
mod posterior;
mod quantity;
mod tally;

pub use self::combination::{Combinations, DETERMINED, Nees};
pub use self::ecdf::{EcdfBand, POINTS};
pub use self::interval::clopper_pearson;
pub use self::posterior::PosteriorRun;
pub use self::quantity::{COVERAGES, Coverage, QuantityStatistics};
pub use self::tally::{PosteriorStatistics, PosteriorTally};
