//! One run or several side by side: the arithmetic that a kernel is written in once.
//!
//! **What it does.** A kernel that is generic over [`Real`] runs over `f64`, for one run, and over
//! [`Lane`], for as many runs as the machine's vectors hold; [`Arch`] finds out at run time which
//! instructions there are, so that a default build uses them. [`Vector`] and [`Matrix`] are three
//! and three by three of such numbers, [`rotation`] what navigation does with them.
//!
//! **What it does not do.** It never fuses a multiplication with an addition and takes sines from one
//! library: the bits of a run are the same alone or beside others, on any machine, whatever the
//! target flags.
//!
//! ```
//! use rins_lanes::{Arch, Lane, Real, Simd, WithSimd};
//!
//! fn norm<T: Real>(x: T, y: T) -> T {
//!     (x * x + y * y).sqrt()
//! }
//!
//! struct Norms;
//! impl WithSimd for Norms {
//!     type Output = Vec<f64>;
//!     fn with_simd<S: Simd>(self, simd: S) -> Vec<f64> {
//!         let x = Lane::splat(simd, 0.0).each(|lane| lane as f64);
//!         let norms = norm(x, x.constant(1.0));
//!         (0..norms.lanes()).map(|lane| norms.lane(lane)).collect()
//!     }
//! }
//! for (lane, side_by_side) in Arch::new().dispatch(Norms).into_iter().enumerate() {
//!     assert_eq!(side_by_side, norm(lane as f64, 1.0)); // to the last bit
//! }
//! ```
#![expect(
    clippy::inline_always,
    reason = "what is not inlined is compiled without the vector instructions"
)]

mod real;

mod lane;
mod matrix;
mod vector;

pub mod rotation;

pub use lane::Lane;
pub use matrix::Matrix;
pub use pulp::{Arch, Scalar, Simd, WithSimd, x86};
pub use real::Real;
pub use vector::Vector;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
