//! The physical effects that an inertial measurement unit on a rate table shows, each as one item.
//!
//! **What it does.** A [`Term`] is one effect: its equation, parameters, units, usual magnitudes, what it
//! needs, what it can be confused with. The [`catalogue`] holds them all by id. A [`Model`] is a
//! list of terms: [`MeasurementModel`] simulates it, [`compensated`] undoes it, and [`TermInstance::signals`] gives what a term
//! adds to the sensors, to the
//! encoder and to the direction of the axis, with its derivative by any parameter, which an estimator
//! takes from there. The formula stands in one place, and is differentiated automatically.
//!
//! **What it does not do.** It estimates nothing and reads no files. Terms add; the product of two small
//! errors is left out.
//!
//! Numbers are in SI units and radians; [`Unit`] says in which unit a parameter is shown.
//!
//! ```
//! use rins_terms::{TermInstance, Model, catalogue};
//! let model = Model::full().with(TermInstance::new(catalogue::term("mounting").unwrap()));
//! assert_eq!(model.terms.last().unwrap().term.name, "mounting of the IMU on the table");
//! ```
mod acting;
pub mod catalogue;
mod compensation;
mod edges;
mod following;
mod grade;
mod kinematic_state;
mod kinematic_states;
mod measurement_model;
mod model;
mod page;
mod senses;
mod sensor_axes;
mod setting;
mod signals;
mod slope;
mod surroundings;
mod term;
mod track;
mod triads;
mod turns;
mod unit;
mod waves;

pub use acting::Acting;
pub use compensation::{NotUndone, compensated};
pub use grade::Grade;
pub use kinematic_state::{Instant, KinematicState};
pub use kinematic_states::KinematicStates;
pub use measurement_model::{MeasurementModel, Reading};
pub use model::{FreeParameter, Model, Role, TermInstance};
/// A number with its derivative, of which [`Signals`] are made.
pub use num_dual::Dual64;
pub use page::page;
pub use sensor_axes::own_channel;
pub use setting::{GridPoint, Setting, SettingKind, SettingPrior};
pub use signals::{DualVector, Signals, derivatives, values};
pub use surroundings::Surroundings;
pub use term::{Action, Need, Noises, Owner, Parameter, Parity, Prevalence, Prior, Term};
pub use track::Track;
pub use unit::Unit;
pub use waves::sin_cos;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
