//! A rate table's motion, what a perfect IMU on it measures, and navigation from what one delivers.
mod recording;
mod station;
mod truth;
mod turntable;

pub use recording::Recording;
pub use station::Station;
pub use truth::{TrueMotion, TrueSample};
pub use turntable::{Profile, ProfileError, Segment};
