//! The motion of a rate table, the output of a perfect IMU on it, and inertial navigation.
//!
//! **What it does.** A [`Profile`] is the commanded motion of a single-axis table; [`TrueMotion`] places the table on the
//! rotating Earth and integrates the output of a perfect IMU, exact to rounding. [`align`] and [`Navigator`] are the inverse,
//! from the increments of a [`Recording`] to attitude, velocity and position. The [`mechanism`] module predicts the effect of
//! sensor errors on navigation: the paper's closed forms, with their sign corrected, and a linear model of the round Earth.
//!
//! **What it does not do.** Other crates add sensor errors and noise; the table has one axis, no wobble and no lever arm. The
//! navigator is unaided, its free vertical channel diverges, and it must not come near a pole. `rins-inspection` finds static
//! intervals and errors in a recording. Other crates read files and units: every number is in SI units and radians, in the
//! frames of `rins_frames`.
//!
//! With a perfect IMU on a stationary table the navigation errors stay zero for an hour:
//! ```
//! use rins_frames::units::DEG;
//! use rins_frames::{Body, Dcm, Site, Table};
//! use rins_motion::{Navigator, Profile, Segment, Station, TrueMotion, VerticalChannel};
//! let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 0.0 };
//! let motion = TrueMotion {
//!     station: Station::with_normal_gravity(site),
//!     nav_from_table: Dcm::about_x(20.0 * DEG),
//!     profile: Profile::new(&[Segment { rate: 0.0, duration: 3600.0 }], None)?,
//! };
//! let start = motion.nav_from_table * Dcm::<Table, Body>::identity();
//! let mut navigator = Navigator::at_rest(&motion.station, start, VerticalChannel::Held);
//! for sample in motion.samples(0.1) {
//!     navigator.step(&sample.increments);
//! }
//! assert!(navigator.state().velocity.norm() < 1e-6);
//! # Ok::<(), rins_motion::ProfileError>(())
//! ```
#![expect(
    clippy::inline_always,
    reason = "what is not inlined is compiled without the vector instructions"
)]

mod alignment;
mod carrier;
mod cubic;
mod fine_alignment;
pub mod mechanism;
mod median;
mod ramps;
mod recording;
mod rest;
mod station;
mod strapdown;
mod truth;
mod turntable;
mod whole;

pub use alignment::{
    Alignment, AlignmentError, MeanUncertainty, PlaceSeen, align, level, place_seen, residual,
};
pub use carrier::{
    CarriedSample, CarriedState, CarriedTable, Carrier, CarrierError, CarrierState, Leg,
    Oscillation, Sway,
};
pub use cubic::cubic;
pub use fine_alignment::{FineAlignment, FineAlignmentError, GyroFigures, align_finely};
pub use median::median;
pub use ramps::with_ramps;
pub use recording::Recording;
pub use rest::RestMean;
pub use station::Station;
pub use strapdown::{Figures, Mechanisation, NavState, Navigator, VerticalChannel};
pub use truth::{TrueMotion, TrueSample};
pub use turntable::{Profile, ProfileError, Segment};
pub use whole::whole;
