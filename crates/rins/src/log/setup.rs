//! The measurement setup of a calibration from a rig file.

use anyhow::Context;
use rins_calibration::{AxisAttitude, Setup, TableSpec};
use rins_io::{Loaded, Rig};
use rins_motion::Station;

/// The station, table and IMU of a rig.
///
/// If the rig file does not state the wobble of the spin axis, the resolution of the encoder is the preliminary value.
pub(crate) fn setup(loaded: &Loaded) -> anyhow::Result<Setup> {
    setup_at(&loaded.rig, loaded.station)
}

/// [`setup`] where the station is known.
pub(crate) fn setup_at(rig: &Rig, station: Station) -> anyhow::Result<Setup> {
    let imu = *rig.require_imu().context("the calibration needs the IMU's data sheet")?;
    let (angle_noise, wobble) = table_accuracy(rig);
    let latency = rig.log.table_angle().and_then(|angle| angle.latency).unwrap_or_default();
    Ok(Setup {
        station,
        axis: rig
            .attitude
            .map(|attitude| AxisAttitude { angles: attitude.angles, sigma: attitude.sigma }),
        table: TableSpec { angle_noise, wobble, rate_noise: 0.0, latency },
        imu,
        velocity_noise: Setup::FIXED_TABLE_VELOCITY_NOISE,
    })
}

/// The 1σ of the table angle and of the direction of the spin axis, from the rig file or by default \[rad\].
pub(crate) fn table_accuracy(rig: &Rig) -> (f64, f64) {
    let encoder = rig.log.table_angle();
    let read = encoder.and_then(|angle| angle.noise).unwrap_or(TableSpec::DEFAULT_ANGLE_NOISE);
    // The error of a reading that is rounded to its resolution has a uniform distribution.
    let rounding = encoder.and_then(|angle| angle.resolution).unwrap_or_default() / 12.0_f64.sqrt();
    let angle_noise = read.hypot(rounding);
    (angle_noise, rig.table.as_ref().and_then(|table| table.wobble).unwrap_or(angle_noise))
}
