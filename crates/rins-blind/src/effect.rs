//! A hidden effect, and the law by which each id acts.

use nalgebra::Vector3;

use crate::experiment::Experiment;
use crate::laws;
use crate::laws::{Instant, Pose};
use crate::random::Random;
use crate::run::Log;

/// An effect with its size and shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// The catalogue's id.
    pub id: String,
    /// Its parameters in the catalogue's order, in SI units.
    pub parameters: Vec<f64>,
    /// Its settings in the catalogue's order, in SI units.
    pub settings: Vec<f64>,
}

/// What is read too much: by the gyros \[rad/s\], by the accelerometers \[m/s²\].
pub type Read = (Vector3<f64>, Vector3<f64>);

/// How an effect acts: on what, given its parameters, its settings, and what is going on.
#[derive(Clone, Copy, Debug)]
pub enum Law {
    /// It tilts the axis: a rotation vector in the axis frame \[rad\].
    Tilt(fn(&[f64], &[f64], &Pose) -> Vector3<f64>),
    /// It adds to what gyros and accelerometers read, at every instant \[rad/s, m/s²\].
    Sense(fn(&[f64], &[f64], &Instant) -> Read),
    /// A once-per-turn warmth that gyros follow slowly.
    Heat,
    /// The sensors lie off the axis: the place of each accelerometer in the body \[m\].
    Places(fn(&[f64]) -> [Vector3<f64>; 3]),
    /// It delays gyros and accelerometers \[s\].
    Delay(fn(&[f64]) -> (f64, f64)),
    /// It adds to what the encoder reads \[rad\].
    Read(fn(&[f64], &[f64], &Pose) -> f64),
    /// It makes the encoder late \[s\].
    Late(fn(&[f64], &[f64], f64) -> f64),
    /// It changes the experiment before it begins.
    Setup(fn(&[f64], &[f64], &mut Experiment)),
    /// It spoils the finished log.
    Spoil(fn(&[f64], &[f64], &mut Log, &mut Random)),
}

/// Every id and its law.
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

    /// How it acts.
    ///
    /// # Panics
    /// If there is no law of its id.
    pub fn law(&self) -> Law {
        let found = LAWS.iter().copied().flatten().find(|(id, _)| *id == self.id);
        found.unwrap_or_else(|| panic!("no law is known of {:?}", self.id)).1
    }
}
