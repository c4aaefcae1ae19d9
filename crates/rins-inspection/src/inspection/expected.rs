//! What a recording is held against.

use std::ops::Range;

use rins_frames::EulerAngles;
use rins_motion::{RestMean, Station};

use super::units::ReadingUnit;

/// The names of the six channels, in the order of every list here.
pub const CHANNELS: [&str; 6] = ["gyro.x", "gyro.y", "gyro.z", "accel.x", "accel.y", "accel.z"];

/// What was seen in a stretch of rest.
#[derive(Clone, Debug, PartialEq)]
pub struct RestSeen {
    /// The samples.
    pub span: Range<usize>,
    /// The means over them.
    pub mean: RestMean,
}

/// What a triad's data sheet says that its readings can be held against.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExpectedTriad {
    /// How far a bias may be from zero, 1σ \[rad/s\] or \[m/s²\].
    pub bias_sigma: Option<f64>,
    /// The largest rate or specific force that can be read \[rad/s\] or \[m/s²\].
    pub range: Option<f64>,
    /// The unit that readings are said to be in.
    pub unit: Option<ReadingUnit>,
}

/// The attitude that the spin axis is said to have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedAxis {
    /// Of the axis frame at table angle zero, `C_s^n`.
    pub angles: EulerAngles,
    /// Their 1σ \[rad\].
    pub sigma: f64,
}

/// What is known of a run beforehand; what is not, nothing is held against.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Expected {
    /// The place and its gravity.
    pub station: Option<Station>,
    /// The attitude of the spin axis.
    pub axis: Option<ExpectedAxis>,
    /// By how much the table's angle or rate is late \[s\].
    pub table_latency: f64,
    /// The unit that the table's angle or rate is said to be in.
    pub table_unit: Option<ReadingUnit>,
    /// The gyros.
    pub gyro: ExpectedTriad,
    /// The accelerometers.
    pub accel: ExpectedTriad,
}
