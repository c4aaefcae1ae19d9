//! A generic extended Kalman filter and smoother.
//!
//! **What it does.** [`Filter`] predicts and updates a state of `N` elements with fixed-size matrices and without allocation.
//! Every update returns its [`Innovation`], whitened: N(0, I) if the model is correct, so that consistency tests need no
//! further algebra. A [`Measurement`] contains its own matrix and noise, and optionally the correlation of its noise with the
//! state's error. A [`Block`] is a named block of the state. A [`Smoother`] estimates past states.
//!
//! **What it does not do.** It contains no inertial navigation. It never rejects an outlier, clamps, inflates a covariance or
//! falls back: a step is carried out as requested, or it is an error and nothing has changed.
//!
//! **Form of the covariance.** [`Filter`]'s sigmas keep six digits while the variances of the states that a row combines stay
//! below 1e6 times the noise, and three digits up to 1e10 times; beyond, it refuses the measurement. [`FactorisedFilter`]
//! carries out the same steps on the factors `U D Uᵀ`, and keeps six digits up to 1e16 times.
//!
//! Position and velocity from position measurements:
//! ```
//! use nalgebra::{Matrix1, Matrix2, RowVector2, Vector1, Vector2};
//! use rins_ekf::{Filter, Measurement};
//! let mut filter = Filter::new(Vector2::zeros(), Matrix2::identity() * 100.0)?;
//! let transition = Matrix2::new(1.0, 1.0, 0.0, 1.0); // one second
//! for time in 1..=20 {
//!     filter.predict(&transition, &Matrix2::zeros());
//!     let position = Vector1::new(3.0 * f64::from(time));
//!     let seen = Measurement::new(position, RowVector2::new(1.0, 0.0), Matrix1::new(0.01));
//!     filter.update(&seen)?;
//! }
//! assert!((filter.state.y - 3.0).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;

mod block;
mod error;
mod factorised;
mod factors;
mod filter;
mod innovation;
mod kernel;
mod measurement;
#[cfg(feature = "alloc")]
mod smoother;

pub use block::Block;
pub use error::{CovarianceError, Quantity, UpdateError};
pub use factorised::FactorisedFilter;
pub use factors::Factors;
pub use filter::Filter;
pub use innovation::Innovation;
pub use kernel::congruence;
pub use measurement::Measurement;
#[cfg(feature = "alloc")]
pub use smoother::{Smoothed, Smoother, SmootherError, Step};

/// Compiles the README's examples.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
