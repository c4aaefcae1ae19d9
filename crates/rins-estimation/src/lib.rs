//! Estimates any list of physical effects from runs of an inertial measurement unit on a rate table.
//!
//! **What it does.** [`fit`] takes one [`Run`] or several of one IMU, a [`Model`](rins_terms::Model) and the strengths of the
//! noise, and finds the parameters that the model leaves free, with their covariance: iterated least
//! squares over an error-state filter of attitude, velocity and coloured noise, whose readings are
//! zero velocity, the direction of the axis, and the table angle, which is never differenced. Where the noise is
//! not known its strengths are found by restricted maximum likelihood. [`Filter`] is the same model
//! taken sample by sample with the parameters as states: it ends where the batch does. [`Evidence`] is all that a
//! run says of any number of parameters, [`innovations`] what a model leaves of it, and [`Identifiability`] which of them,
//! alone or in what combination, it tells.
//!
//! The reference is an encoder, a commanded rate, or, on a tilted axis, gravity turning in the plane of
//! rotation ([`Reference`]).
//!
//! **What it does not do.** The base does not travel: position is no state, since a fixed site shows nothing of
//! it. Which terms to choose is the caller's business, and files are read elsewhere.
//!
//! Numbers are in SI units and radians.
mod layout;
mod noise_parameters;
mod rounding;
mod run;

mod gravity;
mod held;
mod path;
mod sway;

mod linear;

mod build;
mod colour;
mod gains;
mod space;
mod step;

mod evidence;
mod gram;
mod pass;
mod posterior;
mod prediction;
mod stride;

mod epoch;
mod estimate;
mod filter;
mod fit;
mod fit_error;
mod likely;
mod named;
mod prior_consistency;
mod unobservable;

mod identifiability;

pub use estimate::{Estimate, Fit, Iteration};
pub use evidence::{Indefinite, Turned, attitudes, innovations};
pub use filter::Filter;
pub use fit::{fit, fit_near};
pub use fit_error::FitError;
pub use gravity::{AXIS_BY_GRAVITY, AxisSeen, axis_from_gravity, turning_span};
pub use identifiability::{
    Alias, Direction, EXACT, GAUGES, Gauge, Identifiability, Joint, JointError, Observable,
    ParameterObservability, Rank, Separation, Unknown, Unobservable, distance, gauge_of, joint,
    separation,
};
pub use layout::Layout;
pub use linear::{Linear, linearise, linearise_coarsely};
pub use named::InRun;
pub use noise_parameters::{Noise, NoiseKnowledge, NoiseParameters, TriadStrengths};
pub use posterior::{Evidence, Posterior, correlation};
pub use prediction::{EpochPrediction, ParameterPosterior};
pub use prior_consistency::{Departure, Quantity};
pub use rounding::AngleSteps;
pub use run::{Reference, Rig, Run, RunError};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
