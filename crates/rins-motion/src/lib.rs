//! A rate table's motion, what a perfect IMU on it measures, and navigation from what one delivers.
//!
//! **What it does.** A [`Profile`] tells a single-axis table what to do; [`TrueMotion`] puts the
//! table on the turning Earth and integrates what a perfect IMU measures there, to the last digit.
//! [`align`] and [`Navigator`] go the other way, from the increments of a [`Recording`] to attitude, velocity and position.
//! The [`mechanism`] module predicts what sensor errors do to all this: the paper's closed forms, with
//! their sign corrected, and a linear model of the round Earth beside them.
//!
//! **What it does not do.** Sensor errors and noise are added elsewhere; the table has one axis, no
//! wobble and no lever arm. The navigator is a strapdown navigator alone: nothing aids it, its
//! free vertical channel diverges, and it must not come near a pole. Where a recording is static and what
//! is wrong with it is found by `rins-inspection`. Files and units are read elsewhere: every number is in SI units and radians, in the frames of `rins_frames`.
//!
//! An hour on a standing table, its IMU perfect, leads nowhere:
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
