//! All that is true of a run, and what a laboratory would know of it.

use nalgebra::{Matrix3, Vector3};

use crate::drive::Drive;
use crate::effect::Effect;
use crate::noise::Noise;
use crate::place::Place;
use crate::temperature::Temperature;
use crate::unknown::Unknown;

/// What is true of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// Where the table stands.
    pub place: Place,
    /// How fast what the table stands on turns about the vertical \[rad/s\].
    pub base_rate: f64,
    /// The attitude of the axis frame: roll, pitch, yaw of `Rz(yaw) Rx(pitch) Ry(roll)`, east-north-up \[rad\].
    pub attitude: [f64; 3],
    /// How the table turns.
    pub drive: Drive,
    /// How the IMU sits on the table: rotation about its x and y \[rad\].
    pub mounting: [f64; 2],
    /// Its gyros.
    pub gyro: Sensors,
    /// Its accelerometers.
    pub accel: Sensors,
    /// The encoder.
    pub encoder: Encoder,
    /// How warm the IMU is.
    pub temperature: Temperature,
    /// The length of a sample \[s\].
    pub interval: f64,
    /// How many short steps make up a sample.
    pub substeps: usize,
    /// The effects that are there, the table's imperfections among them.
    pub effects: Vec<Effect>,
    /// What is there and in no catalogue.
    pub unknowns: Vec<Unknown>,
    /// What all scatter follows from.
    pub seed: u64,
}

/// Three sensors and their errors: read is true, and `bias + matrix · true`, and noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensors {
    /// \[rad/s or m/s²\].
    pub bias: Vector3<f64>,
    /// Scale errors on the diagonal, misalignments off it.
    pub matrix: Matrix3<f64>,
    /// What scatters.
    pub noise: Noise,
    /// The least bit, if it matters.
    pub rounding: Option<Rounding>,
}

/// A least bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rounding {
    /// Of increments; what is left over comes with the next one \[rad or m/s\].
    Increment(f64),
    /// Of means \[rad/s or m/s²\].
    Mean(f64),
}

/// An encoder on the table's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    /// 1σ of one reading \[rad\].
    pub noise: f64,
    /// Its least bit \[rad\]; zero is none.
    pub resolution: f64,
}

/// What a laboratory knows of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// Where it believes the table to stand.
    pub place: Place,
    /// The attitude of the axis frame as it was surveyed \[rad\].
    pub attitude: [f64; 3],
    /// How well, 1σ of each angle \[rad\].
    pub attitude_sigma: f64,
    /// The gyros' data sheet.
    pub gyro: SensorsKnown,
    /// The accelerometers' data sheet.
    pub accel: SensorsKnown,
    /// 1σ of one reading of the encoder \[rad\].
    pub encoder_noise: f64,
    /// 1σ of the axis' direction \[rad\], if the bearing's maker gives it.
    pub wobble: Option<f64>,
}

/// What a data sheet says of three sensors, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorsKnown {
    /// The root density of white noise.
    pub noise: f64,
    /// 1σ of the bias from one turn-on to the next.
    pub bias: f64,
    /// 1σ of the scale errors.
    pub scale: f64,
    /// 1σ of the misalignments \[rad\].
    pub misalignment: f64,
}
