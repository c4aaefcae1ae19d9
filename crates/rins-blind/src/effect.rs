//! A hidden effect, and the law of each effect id.

use nalgebra::Vector3;

use crate::experiment::Experiment;
use crate::laws;
use crate::laws::{Instant, Pose};
use crate::random::Random;
use crate::run::Log;

/// An effect with its parameters and settings.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// The catalogue's id.
    pub id: String,
    /// Its parameters in the catalogue's order, in SI units.
    pub parameters: Vec<f64>,
    /// Its settings in the catalogue's order, in SI units.
    pub settings: Vec<f64>,
}

/// The errors of the readings: of the gyros \[rad/s\], of the accelerometers \[m/s²\].
pub type Read = (Vector3<f64>, Vector3<f64>);

/// The law of an effect as a function of its parameters, its settings, and the state of the run.
#[derive(Clone, Copy, Debug)]
pub enum Law {
    /// A tilt of the axis: a rotation vector in the axis frame \[rad\].
    Tilt(fn(&[f64], &[f64], &Pose) -> Vector3<f64>),
    /// Errors of gyros and accelerometers at every instant \[rad/s, m/s²\].
    Sense(fn(&[f64], &[f64], &Instant) -> Read),
    /// A temperature variation once per revolution, to which gyros respond with a lag.
    Heat,
    /// Errors in proportion to how far the sensors' temperature is above the measured one \[K\], behind which it is; the first setting is
    /// the time constant.
    Soak(fn(&[f64], f64) -> Read),
    /// Lever arms: the position of each accelerometer in the body \[m\].
    Places(fn(&[f64]) -> [Vector3<f64>; 3]),
    /// Delays of gyros and accelerometers \[s\].
    Delay(fn(&[f64]) -> (f64, f64)),
    /// An error of the encoder reading \[rad\].
    Read(fn(&[f64], &[f64], &Pose) -> f64),
    /// A latency of the encoder \[s\].
    Late(fn(&[f64], &[f64], f64) -> f64),
    /// A change of the experiment before it begins.
    Setup(fn(&[f64], &[f64], &mut Experiment)),
    /// A fault of the finished log.
    Spoil(fn(&[f64], &[f64], &mut Log, &mut Random)),
}

/// Every effect id with its law.
pub const LAWS: &[&[(&str, Law)]] = &[
    laws::gyro::LAWS,
    laws::gyro_force::LAWS,
    laws::accel::LAWS,
    laws::table::LAWS,
    laws::encoder::LAWS,
    laws::surroundings::LAWS,
    laws::noise::LAWS,
    laws::fault::LAWS,
];

impl Effect {
    /// An effect of this id.
    pub fn new(id: &str, parameters: &[f64], settings: &[f64]) -> Self {
        Self { id: id.into(), parameters: parameters.to_vec(), settings: settings.to_vec() }
    }

    /// The law of the effect.
    ///
    /// # Panics
    /// If its id has no law.
    pub fn law(&self) -> Law {
        let found = LAWS.iter().copied().flatten().find(|(id, _)| *id == self.id);
        found.unwrap_or_else(|| panic!("no law is known of {:?}", self.id)).1
    }
}
