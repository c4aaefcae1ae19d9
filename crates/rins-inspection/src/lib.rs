//! Inspection of a recording of an IMU on a table, before any estimation.
//!
//! **What it does.** [`inspect`] compares a [`Recording`](rins_motion::Recording) with its [`Expected`] properties: gaps and
//! jitter, channels that are stuck, saturated or have spikes, resolution, units, axes and signs, the table's motion, its
//! latency and the ratio of the clocks. A [`Suspicion`] is a probable gross error, with the [`Correction`]s that would
//! explain it. [`StaticIntervals`] are the spans over which the IMU is static. [`Repeats`] are samples that a driver delivers
//! twice, and [`QuantizationGrids`] the quantization grids of the readings.
//!
//! **What it does not do.** It estimates only what an inspection needs, and corrects only repeated samples, which become
//! gaps. Other crates read files: every number is in SI units and radians, in the frames of `rins_frames`.

mod inspection;
mod quantization_grid;
mod repeats;
mod rows;
mod static_intervals;
mod sticking;

pub use inspection::{
    CHANNELS, Correction, Expected, ExpectedAxis, ExpectedTriad, Inspection, ReadingOf,
    ReadingUnit, RestSeen, Suspicion, TableLag, Timing, inspect, inspect_with,
};
pub use quantization_grid::{ENOUGH_ANGLES, QuantizationGrid, QuantizationGrids};
pub use repeats::Repeats;
pub use static_intervals::{
    NotStatic, SensorFigures, StaticInterval, StaticIntervals, StaticOptions,
};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
