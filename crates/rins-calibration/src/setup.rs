//! The prior knowledge for the calibration.

use rins_frames::EulerAngles;
use rins_frames::units::ARCSEC;
use rins_imu::ImuSpec;
use rins_motion::Station;

/// The surveyed attitude of the axis frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisAttitude {
    /// The Euler angles of the axis frame at table angle zero, eq. (5).
    pub angles: EulerAngles,
    /// The 1σ of each component of its error \[rad\].
    pub sigma: f64,
}

/// The uncertainties of the table's readings, each 1σ, and their latency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableSpec {
    /// 1σ of the table angle \[rad\].
    pub angle_noise: f64,
    /// Wobble: 1σ of the spin axis' direction, for each of two components \[rad\].
    pub wobble: f64,
    /// 1σ of the commanded rate's mean over a sample \[rad/s\].
    pub rate_noise: f64,
    /// The known latency of the table angle \[s\]: the reading at `t` is the angle at `t - latency`.
    pub latency: f64,
}

impl TableSpec {
    /// The default noise of an encoder angle \[rad\].
    pub const DEFAULT_ANGLE_NOISE: f64 = 1.0 * ARCSEC;
}

/// The prior knowledge of the station, the table and the IMU.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// The site of the table.
    pub station: Station,
    /// The attitude of the axis frame; without it, it is determined by alignment over the static interval at the start.
    pub axis: Option<AxisAttitude>,
    /// The uncertainties of the table.
    pub table: TableSpec,
    /// The IMU's data sheet.
    pub imu: ImuSpec,
    /// 1σ of the velocity of a fixed table in one sample, whose mean is zero \[m/s\].
    pub velocity_noise: f64,
}

impl Setup {
    /// The velocity noise of a table on a pier \[m/s\]: a tenth of a micrometer at 2 Hz.
    pub const FIXED_TABLE_VELOCITY_NOISE: f64 = 1e-6;
}
