//! A rate table's motion, what a perfect IMU on it measures, and navigation from what one delivers.
mod alignment;
mod inspection;
mod recording;
mod rest;
mod station;
mod strapdown;
mod truth;
mod turntable;

pub use alignment::{
    Alignment, AlignmentError, MeanUncertainty, PlaceSeen, align, level, place_seen, residual,
};
pub use inspection::{CHANNELS, Inspection, RestSeen, Suspicion, Timing, inspect};
pub use recording::Recording;
pub use rest::{RestMean, rest_spans};
pub use station::Station;
pub use strapdown::{NavState, Navigator, VerticalChannel};
pub use truth::{TrueMotion, TrueSample};
pub use turntable::{Profile, ProfileError, Segment};
