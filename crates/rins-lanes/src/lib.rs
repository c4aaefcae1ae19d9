//! Arithmetic for one run or for several runs in SIMD lanes, with which a kernel is written once.
//!
//! **What it does.** A kernel that is generic over [`Real`] works with `f64`, for one run, and with
//! [`Lane`], for as many runs as the vector registers of the machine hold; [`Arch`] detects the instruction set
//! at run time, so that a default build uses it. [`Vector`] and [`Matrix`] contain three
//! and three by three such numbers, and [`rotation`] has the rotations of a navigation kernel.
//!
//! **What it does not do.** It never fuses a multiplication with an addition and uses the trigonometric functions of one
//! library: the bits of a run are the same alone or with others, on any machine and with any
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
