//! The measurement setup of a calibration from a rig file.

use anyhow::Context;
use rins_calibration::{AxisAttitude, Setup, TableSpec};
use rins_imu::ImuSpec;
use rins_io::{Loaded, Rig};
use rins_motion::Station;

use super::DataSheet;

/// The station, table and IMU of a rig.
///
/// If the rig file does not state the wobble of the spin axis, the resolution of the encoder is the preliminary value.
///
/// The second value is what was assumed of data sheet and site, in sentences.
pub(crate) fn setup(loaded: &Loaded) -> (Setup, Vec<String>) {
    let DataSheet { imu, assumption } = DataSheet::of(loaded);
    let mut assumptions = Vec::from_iter(assumption);
    assumptions.extend(site_assumption(&loaded.rig));
    (setup_with(&loaded.rig, loaded.station, imu), assumptions)
}

/// The assumption of a site without height.
pub(crate) fn site_assumption(rig: &Rig) -> Option<String> {
    let told =
        "The site has no height: gravity is that of sea level; it decreases by 0.03 % in 1000 m.";
    rig.at_sea_level.then(|| told.into())
}

/// [`setup`] where the station is known.
pub(crate) fn setup_at(rig: &Rig, station: Station) -> anyhow::Result<Setup> {
    let imu = *rig.require_imu().context("the calibration needs the IMU's data sheet")?;
    Ok(setup_with(rig, station, imu))
}

fn setup_with(rig: &Rig, station: Station, imu: ImuSpec) -> Setup {
    let (angle_noise, wobble) = table_accuracy(rig);
    let latency = rig.log.table_angle().and_then(|angle| angle.latency).unwrap_or_default();
    Setup {
        station,
        axis: rig
            .attitude
            .map(|attitude| AxisAttitude { angles: attitude.angles, sigma: attitude.sigma }),
        table: TableSpec { angle_noise, wobble, rate_noise: 0.0, latency },
        imu,
        velocity_noise: Setup::FIXED_TABLE_VELOCITY_NOISE,
    }
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
