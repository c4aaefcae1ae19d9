//! The expected properties of a recording.

use std::ops::Range;

use rins_frames::EulerAngles;
use rins_motion::{RestMean, Station};

use super::units::ReadingUnit;

/// The names of the six channels, in the order of every list here.
pub const CHANNELS: [&str; 6] = ["gyro.x", "gyro.y", "gyro.z", "accel.x", "accel.y", "accel.z"];

/// The data of a static interval.
#[derive(Clone, Debug, PartialEq)]
pub struct RestSeen {
    /// The samples.
    pub span: Range<usize>,
    /// The means over them.
    pub mean: RestMean,
}

/// The data sheet of a triad, as far as readings can be compared with it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExpectedTriad {
    /// 1σ of a bias \[rad/s\] or \[m/s²\].
    pub bias_sigma: Option<f64>,
    /// The largest rate or specific force that the sensor can measure \[rad/s\] or \[m/s²\].
    pub range: Option<f64>,
    /// The declared unit of the readings.
    pub unit: Option<ReadingUnit>,
}

/// The declared attitude of the spin axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedAxis {
    /// The angles of the axis frame at table angle zero, `C_s^n`.
    pub angles: EulerAngles,
    /// Their 1σ \[rad\].
    pub sigma: f64,
}

/// The prior knowledge of a run; properties that are `None` are not tested.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Expected {
    /// The site and its gravity.
    pub station: Option<Station>,
    /// The attitude of the spin axis.
    pub axis: Option<ExpectedAxis>,
    /// The latency of the table angle or rate \[s\].
    pub table_latency: f64,
    /// The declared unit of the table angle or rate.
    pub table_unit: Option<ReadingUnit>,
    /// The gyros.
    pub gyro: ExpectedTriad,
    /// The accelerometers.
    pub accel: ExpectedTriad,
}
