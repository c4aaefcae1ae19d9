//! The observability of parameters under a rotation schedule before it is run, and the choice of the next schedule.
//!
//! The information of a run on the parameters `x` of a model is `Jᵀ R⁻¹ J`, with `J` the derivatives of the whitened innovations
//! along the planned motion and `R` the noise of the data sheet: it needs neither measured data nor simulated noise.
//!
//! **What it does.** A [`Planned`] run is a scenario of which only motion, site and data sheet matter. [`information`] is the
//! joint information of several of them. [`Pair`] is the separability of two effects, [`propose`] searches a library of
//! schedules for the shortest one that reaches a [`Goal`] within the [`Limits`] of a table, and [`next_test`] does that for
//! two effects that a run could not distinguish. [`Optimization`] is the optimal schedule for a [`Criterion`], with a bound of what is possible. A [`Budget`] is the error budget of free inertial navigation over minutes, [`Growth`]
//! that over days.
//!
//! **What it does not do.** It reads no files and decides nothing about measured data.

mod budget;
mod candidate;
mod coverage;
mod effect;
mod error;
mod growth;
mod library;
mod limits;
mod next;
mod optimum;
mod pair;
mod planned;
mod proposal;

pub use budget::{Budget, Contribution, Drift, EstimatedParameter, Truth};
pub use candidate::Candidate;
pub use coverage::{COVERAGE, coverage_factor};
pub use effect::Effect;
pub use error::DesignError;
pub use growth::{Draw, GROWTH_STATES, Growth, GrowthError, NOISE_INTERVAL, Service, Voyage};
pub use library::usual_schedules;
pub use limits::{Limits, TYPICAL_ACCELERATION, TYPICAL_RATE};
pub use next::{Confused, NextTest, next_test};
pub use optimum::{
    ApproximateDesign, Criterion, Element, LinearFunction, Motion, Objective, OptimalRun,
    OptimalSchedule, Optimization, value,
};
pub use pair::{ENOUGH, Pair, information};
pub use planned::Planned;
pub use proposal::{Goal, Proposal, propose};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
