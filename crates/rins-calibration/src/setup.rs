//! What is known before the calibration starts.

use rins_frames::EulerAngles;
use rins_frames::units::ARCSEC;
use rins_imu::ImuSpec;
use rins_motion::Station;

/// The attitude of the axis frame as it was surveyed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisAttitude {
    /// Of the axis frame at table angle zero, eq. (5).
    pub angles: EulerAngles,
    /// The 1σ of each component of its error \[rad\].
    pub sigma: f64,
}

/// How well the table tells its own motion: 1σ of one reading, and its delay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableSpec {
    /// Of the table angle \[rad\].
    pub angle_noise: f64,
    /// Of the spin axis' direction, each of two components \[rad\].
    pub wobble: f64,
    /// Of the commanded rate's mean over a sample \[rad/s\].
    pub rate_noise: f64,
    /// By how much the angle is late, as far as known \[s\]: what is read at `t` was so at `t - latency`.
    pub latency: f64,
}

impl TableSpec {
    /// The angle noise of an encoder for which none is given \[rad\].
    pub const DEFAULT_ANGLE_NOISE: f64 = 1.0 * ARCSEC;
}

/// What is known of the station, the table and the IMU.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// Where the table stands.
    pub station: Station,
    /// The axis frame's attitude; without it the rest at the start must align it.
    pub axis: Option<AxisAttitude>,
    /// The table's figures.
    pub table: TableSpec,
    /// The IMU's data sheet.
    pub imu: ImuSpec,
    /// How far the velocity of a fixed table may be from zero in one sample, 1σ \[m/s\].
    pub velocity_noise: f64,
}

impl Setup {
    /// The velocity noise of a table that stands on a pier \[m/s\]: a tenth of a micrometre at 2 Hz.
    pub const FIXED_TABLE_VELOCITY_NOISE: f64 = 1e-6;
}
