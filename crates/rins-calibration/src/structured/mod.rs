//! The filter step in structured form: nine navigation errors, and constants that drive them.
//!
//! About fifty of the 15 by 15 elements of a transition are neither zero nor one, and the prediction does not change the
//! covariance of the constants. The generic filter of `rins-ekf` with dense matrices is equivalent and is the reference; here
//! only the elements that change are calculated, for one run or several in parallel. Both elements of a symmetric pair are
//! identical in all bits.
//!
//! The form is the plain one, `P - P Hᵀ S⁻¹ H P`, in two blocks of three rows. It is precise as long as the prior variance of
//! a measurement does not greatly exceed its noise. [`Covariance::ratios`] is this ratio; the relative rounding error is
//! about 1e-16 times the ratio. Beyond a limit [`crate::SpinAxisFilter`] continues with factors of the covariance.
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

/// The number of navigation errors: position, velocity, attitude, three each.
pub const NAVIGATION: usize = 9;

/// The place of the position errors.
const POSITION: usize = 0;
/// The place of the velocity errors.
const VELOCITY: usize = 3;
/// The place of the attitude errors.
const ATTITUDE: usize = 6;
