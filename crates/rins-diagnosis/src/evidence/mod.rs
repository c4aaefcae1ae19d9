//! The marginal likelihood of effects: amplitudes are integrated out with their priors, noise parameters are profiled.

mod exact;
pub(crate) mod left;
mod screen;
pub(crate) mod survey;

pub(crate) use exact::log_evidence;
pub(crate) use screen::{Family, Scored, Screen};
