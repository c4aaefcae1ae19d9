//! The grade of an IMU, as its data sheet shows it.

use rins_frames::units::{DEG_PER_HOUR, DEG_PER_HOUR_PER_ROOT_HZ};
use rins_imu::ImuSpec;

/// The kinds of IMU for which usual magnitudes of effects are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grade {
    /// Fibre-optic gyros with pendulous accelerometers.
    Fibre,
    /// Laser gyros.
    Laser,
    /// Micromechanical sensors.
    Mems,
}

impl Grade {
    /// The grade of an IMU with this data sheet.
    ///
    /// Noisier than 1 deg/h/√Hz, or biased by more than 5 deg/h, is MEMS; laser gyros cannot be
    /// told from fibre gyros by their figures, and the latter, whose effects are larger, are assumed.
    pub fn of(imu: &ImuSpec) -> Self {
        let mems = imu.gyro.noise_density > DEG_PER_HOUR_PER_ROOT_HZ
            || imu.gyro.bias_sigma > 5.0 * DEG_PER_HOUR;
        if mems { Self::Mems } else { Self::Fibre }
    }
}
