//! What is simulated: a table, an IMU on it, and what is written down.

use rins_frames::{Dcm, Nav, Table};
use rins_imu::{ImuError, ImuNoise, NormalStream, Seed};
use rins_motion::{Profile, Station};

/// A run to be simulated.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Where the table stands.
    pub station: Station,
    /// The attitude of the axis frame, which does not move.
    pub nav_from_table: Dcm<Nav, Table>,
    /// The table's motion.
    pub profile: Profile,
    /// The time between samples \[s\]; a last part of an interval is left out.
    pub interval: f64,
    /// The IMU's bias, scale and misalignment.
    pub imu_error: ImuError,
    /// The IMU's noise and resolution, or none at all.
    pub noise: Option<ImuNoise>,
    /// What is recorded of the table.
    pub table: TableRecord,
    /// A temperature to record with every sample \[°C\]; nothing depends on it.
    pub temperature: Option<f64>,
    /// What all random numbers follow from.
    pub seed: Seed,
}

impl Scenario {
    /// A perfect IMU and a perfect encoder on a table in motion, sampled every `interval` \[s\].
    pub fn perfect(
        station: Station,
        nav_from_table: Dcm<Nav, Table>,
        profile: Profile,
        interval: f64,
    ) -> Self {
        Self {
            station,
            nav_from_table,
            profile,
            interval,
            imu_error: ImuError::default(),
            noise: None,
            table: TableRecord::Angle(Encoder::default()),
            temperature: None,
            seed: Seed::new(0),
        }
    }
}

/// What a recording holds of the table's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableRecord {
    /// The angle, as an encoder reads it.
    Angle(Encoder),
    /// The mean commanded rate of each interval.
    CommandedRate,
    /// Neither.
    Nothing,
}

/// How the table's angle is read. The default reads it as it is.
///
/// What is read is the true angle plus `zero` plus noise, rounded to the resolution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Encoder {
    /// The standard deviation of white noise in each reading \[rad\].
    pub noise: f64,
    /// The least significant bit \[rad\].
    pub resolution: Option<f64>,
    /// What is read at table angle zero \[rad\].
    pub zero: f64,
}

impl Encoder {
    /// What is read where the table stands at `angle` \[rad\].
    pub(crate) fn reading(&self, angle: f64, stream: &mut NormalStream) -> f64 {
        let noisy = angle + self.zero + self.noise * stream.sample();
        self.resolution.map_or(noisy, |bit| (noisy / bit).round() * bit)
    }
}
