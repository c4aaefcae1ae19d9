//! What a recording of an IMU on a table is worth, before anything is estimated from it.
//!
//! **What it does.** [`inspect`] holds a [`Recording`](rins_motion::Recording) against what is [`Expected`] of it: gaps and
//! jitter, channels that stick, saturate or have spikes, resolution, units, axes and signs, the table's motion, its latency and the
//! ratio of the clocks. A [`Suspicion`] is a likely mistake, with the [`Correction`]s that would explain it. [`StaticIntervals`] are
//! the spans over which the IMU is static. [`Repeats`] are samples that a driver hands out again, and [`QuantizationGrids`] the grids of
//! quantized readings.
//!
//! **What it does not do.** Nothing is estimated but what an inspection needs, and nothing is corrected but repeated samples, which
//! become gaps. Files are read elsewhere: every number is in SI units and radians, in the frames of `rins_frames`.

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
