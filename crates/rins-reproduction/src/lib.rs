//! The paper's experiments, run again and set beside what it prints.
//!
//! **What it does.** Every figure of the paper (‹nie2019›) that can be had again is: the Monte
//! Carlo of its Tables 3 and 4 ([`Campaign`]), the honesty of the filter's covariance
//! ([`coverage`]), the read-out lag that its attitudes hold ([`readout`]), the experiment of its section 5,
//! emulated ([`real_test`]), the uncertainty of its estimates ([`uncertainty`]), its claims of precision
//! ([`enhancement`]), convergence ([`convergence`]), modulation ([`rotation`], [`accelerometers`]) and online
//! compensation ([`running`]), and the equations against numerical integration ([`grid`]). [`report`] turns all
//! of it into a page of the book and its figures; [`differences`] says where a page kept in the
//! repository has fallen behind.
//!
//! **What it does not do.** It holds no algorithm that the other crates should have, but for one:
//! [`BiasFilter`], a filter with gyro biases among its states, shows what the paper's filter lacks.
//!
//! Numbers are in SI units and radians, but in [`printed`], which keeps the paper's.
mod error;
mod experiment;
mod monte_carlo;
mod pure_navigation;
mod statistics;

pub mod accelerometers;
mod bias_filter;
pub mod causes;
pub mod convergence;
pub mod coverage;
pub mod enhancement;
pub mod equations;
pub mod grid;
pub mod model_coverage;
pub mod plain_model;
pub mod printed;
pub mod readout;
pub mod real_test;
pub mod report;
pub mod rotation;
pub mod running;
mod stale;
pub mod uncertainty;

pub use bias_filter::BiasFilter;
pub use error::ReproductionError;
pub use experiment::{Experiment, Sensors};
pub use monte_carlo::{Calibrated, Campaign};
pub use pure_navigation::{Outcome, PureNavigation, Reference};
pub use stale::{Difference, differences};
pub use statistics::Sample;
