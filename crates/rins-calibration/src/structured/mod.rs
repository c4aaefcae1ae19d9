//! The filter step with its structure written out: nine navigation errors, and constants that drive
//! them.
//!
//! Of the 15 by 15 elements of a transition some fifty are not zero or one, and of the constants'
//! covariance a prediction changes nothing. The generic filter of `rins-ekf` says the same with dense
//! matrices and is the reference; here only what moves is computed, over one run or several side by
//! side. Both of a symmetric pair are the same bits.
//!
//! The form is the plain one, `P - P Hᵀ S⁻¹ H P`, in two blocks of three rows: it keeps the digits
//! as long as what is measured is not known very much worse than it is measured. [`Covariance::ratios`]
//! says how much; a rounding error is some 1e-16 of that. Beyond, [`crate::SpinAxisFilter`] goes on with
//! factors of the covariance.
#![expect(
    clippy::needless_range_loop,
    reason = "an index counts through rows of several arrays at once"
)]

mod covariance;
mod measurement;
#[cfg(test)]
mod reference;
mod transition;
mod update;

pub use covariance::Covariance;
pub use transition::{Input, Means, States, Transition};
pub use update::{Comparison, UpdateResult, With};

/// How many navigation errors there are: position, velocity, attitude, three each.
pub const NAVIGATION: usize = 9;

/// Where the position errors stand.
const POSITION: usize = 0;
/// Where the velocity errors stand.
const VELOCITY: usize = 3;
/// Where the attitude errors stand.
const ATTITUDE: usize = 6;
