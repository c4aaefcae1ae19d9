//! A rate table's motion, what a perfect IMU on it measures, and navigation from what one delivers.
mod recording;
mod station;

pub use recording::Recording;
pub use station::Station;
