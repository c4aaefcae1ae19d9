//! Estimates any list of physical effects from runs of an inertial measurement unit on a rate table.
//!
//! **What it does.** [`fit`] takes one [`Run`] or several of one IMU, a [`Model`](rins_terms::Model) and the noise
//! parameters, and estimates the free parameters of the model with their covariance. The method is iterated least squares
//! over an error-state filter with the states attitude, velocity and colored noise. The measurements are zero velocity, the
//! direction of the spin axis, and the table angle, which is never differenced. Unknown noise parameters are estimated by
//! restricted maximum likelihood. [`Filter`] is the sequential solution of the same model, with the parameters as augmented
//! states: its final estimate is that of the batch. [`Evidence`] is the information of a run on any number of parameters,
//! [`innovations`] are the whitened innovations under a model, and [`Identifiability`] states which parameters, or which
//! combinations of them, are observable.
//!
//! The reference of the table angle is an encoder, a commanded rate, a static table, or, on a tilted axis, the direction of
//! gravity in the plane of rotation ([`Reference`]).
//!
//! **What it does not do.** The base does not travel: position is not a state, because it is unobservable at a fixed site.
//! The caller chooses the terms of the model, and other crates read files.
//!
//! Numbers are in SI units and radians.
mod layout;
mod noise_parameters;
mod rounding;
mod run;
mod sequence;

mod gravity;
mod held;
mod latency;
mod path;
mod smoothing;
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
mod turn;

mod estimate;
mod filter;
mod fit;
mod fit_error;
mod likely;
mod named;
mod noise_prior;
mod online;
mod prior_consistency;
mod unobservable;

mod identifiability;

pub use estimate::{Estimate, Fit, Iteration};
pub use evidence::{Indefinite, Turned, attitudes, innovations};
pub use filter::Filter;
pub use fit::{fit, fit_approximately, fit_near};
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
pub use online::{
    Bits, OnlineCheckpoint, OnlineError, OnlineFilter, OnlineSample, OnlineSetup, OnlineUpdate,
};
pub use posterior::{Evidence, Posterior, correlation};
pub use prediction::{EpochPrediction, ParameterPosterior};
pub use prior_consistency::{Departure, Quantity};
pub use rounding::AngleSteps;
pub use run::{LEAST_TILT, Reference, Rig, Run, RunError};
pub use sequence::{InSequence, StatedTurn, Turn, rotation};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
