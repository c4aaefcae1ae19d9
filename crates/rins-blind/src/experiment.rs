//! The truth of a run, and the knowledge of a laboratory about it.

use nalgebra::{Matrix3, Vector3};

use crate::drive::Drive;
use crate::effect::Effect;
use crate::noise::Noise;
use crate::place::Place;
use crate::temperature::Temperature;
use crate::unknown::Unknown;

/// The truth of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// The site of the table.
    pub place: Place,
    /// The rate of the base about the vertical \[rad/s\].
    pub base_rate: f64,
    /// The attitude of the axis frame: roll, pitch, yaw of `Rz(yaw) Rx(pitch) Ry(roll)`, east-north-up \[rad\].
    pub attitude: [f64; 3],
    /// The motion of the table.
    pub drive: Drive,
    /// The misalignment of the IMU on the table: rotation about its x and y \[rad\].
    pub mounting: [f64; 2],
    /// Its gyros.
    pub gyro: Sensors,
    /// Its accelerometers.
    pub accel: Sensors,
    /// The encoder.
    pub encoder: Encoder,
    /// The temperature of the IMU.
    pub temperature: Temperature,
    /// The length of a sample \[s\].
    pub interval: f64,
    /// The number of short steps in a sample.
    pub substeps: usize,
    /// The effects, including the imperfections of the table.
    pub effects: Vec<Effect>,
    /// Error structures outside the catalogue.
    pub unknowns: Vec<Unknown>,
    /// The seed of all random numbers.
    pub seed: u64,
}

/// Three sensors with their errors: the reading is true + `bias + matrix · true` + noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensors {
    /// The bias \[rad/s or m/s²\].
    pub bias: Vector3<f64>,
    /// Scale errors on the diagonal, misalignments off it.
    pub matrix: Matrix3<f64>,
    /// The random errors.
    pub noise: Noise,
    /// The LSB; `None` if it is negligible.
    pub rounding: Option<Rounding>,
}

/// The LSB of a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rounding {
    /// Of increments; the remainder is carried to the next one \[rad or m/s\].
    Increment(f64),
    /// Of mean values \[rad/s or m/s²\].
    Mean(f64),
}

/// An encoder on the table's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    /// 1σ of one reading \[rad\].
    pub noise: f64,
    /// Its LSB \[rad\]; zero means none.
    pub resolution: f64,
}

/// The knowledge of a laboratory about a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// The assumed site of the table.
    pub place: Place,
    /// The surveyed attitude of the axis frame \[rad\].
    pub attitude: [f64; 3],
    /// Its 1σ for each angle \[rad\].
    pub attitude_sigma: f64,
    /// The gyros' data sheet.
    pub gyro: SensorsKnown,
    /// The accelerometers' data sheet.
    pub accel: SensorsKnown,
    /// 1σ of one reading of the encoder \[rad\].
    pub encoder_noise: f64,
    /// The wobble: 1σ of the direction of the axis \[rad\], if the bearing's manufacturer states it.
    pub wobble: Option<f64>,
}

/// The data sheet of three sensors, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorsKnown {
    /// The noise density.
    pub noise: f64,
    /// The 1σ of the turn-on bias.
    pub bias: f64,
    /// The 1σ of the scale errors.
    pub scale: f64,
    /// The 1σ of the misalignments \[rad\].
    pub misalignment: f64,
}
