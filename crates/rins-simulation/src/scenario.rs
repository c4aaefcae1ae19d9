//! What is simulated: a table, an IMU on it, and what is written down.

use rins_frames::{Dcm, Nav, Table};
use rins_imu::{ImuError, ImuNoise, NormalStream, Seed, rounded};
use rins_motion::{Profile, Station};
use rins_terms::{Model, Noises};

use crate::temperature::Temperature;

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
    /// What else is not as it should be; values are true, roles mean nothing.
    pub effects: Model,
    /// The temperature that is recorded with every sample, and on which effects depend.
    pub temperature: Option<Temperature>,
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
            effects: Model::default(),
            temperature: None,
            seed: Seed::new(0),
        }
    }

    /// The same run without errors of the IMU, noise of the IMU, and effects.
    #[must_use]
    pub fn without_errors(self) -> Self {
        Self { imu_error: ImuError::default(), noise: None, effects: Model::default(), ..self }
    }

    /// The noise of IMU and encoder, with what the effects make of it.
    pub(crate) fn noises(&self) -> Noises {
        let encoder = match self.table {
            TableRecord::Angle(encoder) => encoder.noise,
            TableRecord::CommandedRate | TableRecord::Nothing => 0.0,
        };
        self.effects.stirred(Noises { imu: self.noise.clone().unwrap_or_default(), encoder })
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
        self.resolution.map_or(noisy, |bit| rounded(noisy, bit))
    }
}
