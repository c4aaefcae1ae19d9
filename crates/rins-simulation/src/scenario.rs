//! Scenarios: a table, an IMU on it, and the recorded signals.

use rins_frames::{Dcm, Nav, Table};
use rins_imu::{ImuError, ImuNoise, NormalStream, Seed, rounded};
use rins_motion::{Profile, Station};
use rins_terms::{Model, Noises};

use crate::temperature::Temperature;

/// A run to be simulated.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// The site of the table.
    pub station: Station,
    /// The attitude of the axis frame, which is constant.
    pub nav_from_table: Dcm<Nav, Table>,
    /// The motion of the table.
    pub profile: Profile,
    /// The time between samples \[s\]; an incomplete last interval is omitted.
    pub interval: f64,
    /// The IMU's bias, scale error and misalignment.
    pub imu_error: ImuError,
    /// The IMU's noise and resolution, or none at all.
    pub noise: Option<ImuNoise>,
    /// The recorded signal of the table.
    pub table: TableRecord,
    /// Further effects; values are true, and roles are ignored.
    pub effects: Model,
    /// The temperature, which is recorded with every sample, and on which effects depend.
    pub temperature: Option<Temperature>,
    /// The seed of all random numbers.
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

    /// The same run without errors and noise of the IMU, and without effects.
    #[must_use]
    pub fn without_errors(self) -> Self {
        Self { imu_error: ImuError::default(), noise: None, effects: Model::default(), ..self }
    }

    /// The noise of IMU and encoder, as modified by the effects.
    pub(crate) fn noises(&self) -> Noises {
        let encoder = match self.table {
            TableRecord::Angle(encoder) => encoder.noise,
            TableRecord::CommandedRate | TableRecord::Nothing => 0.0,
        };
        self.effects.stirred(Noises { imu: self.noise.clone().unwrap_or_default(), encoder })
    }
}

/// The recorded signal of the table's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableRecord {
    /// The angle, as measured by an encoder.
    Angle(Encoder),
    /// The mean commanded rate of each interval.
    CommandedRate,
    /// Neither.
    Nothing,
}

/// The encoder of the table angle. The default has no errors.
///
/// Its reading is the true angle plus `zero` plus noise, rounded to the resolution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Encoder {
    /// The standard deviation of the white noise of each reading \[rad\].
    pub noise: f64,
    /// The least significant bit \[rad\].
    pub resolution: Option<f64>,
    /// The reading at table angle zero \[rad\].
    pub zero: f64,
}

impl Encoder {
    /// The reading at the true table angle `angle` \[rad\].
    pub(crate) fn reading(&self, angle: f64, stream: &mut NormalStream) -> f64 {
        let noisy = angle + self.zero + self.noise * stream.sample();
        self.resolution.map_or(noisy, |bit| rounded(noisy, bit))
    }
}
