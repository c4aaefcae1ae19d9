//! The random errors of an IMU.

use rins_frames::Increments;

use super::model::{NoiseError, NoiseModel, Span};
use super::seed::Seed;
use super::source::TriadNoise;
use crate::axis::Triad;

/// The random errors of a gyro and an accelerometer triad. The default is none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImuNoise {
    /// The noise of the gyros, in rad/s and its multiples.
    pub gyro: NoiseModel,
    /// The noise of the accelerometers, in m/s² and its multiples.
    pub accel: NoiseModel,
}

/// The error of a triad's invalid noise model.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the {triad} noise parameters are invalid")]
pub struct ImuNoiseError {
    /// The triad.
    pub triad: Triad,
    /// The reason.
    #[source]
    pub reason: NoiseError,
}

/// A source of the random errors of an IMU.
#[derive(Clone, Debug)]
pub struct ImuNoiseSource {
    gyro: TriadNoise,
    accel: TriadNoise,
}

impl ImuNoise {
    /// The source of this noise in the run of `seed`; flicker noise is approximated for times within `span`.
    ///
    /// # Errors
    /// [`ImuNoiseError`] if a number is negative, not finite, or zero although it must be positive.
    pub fn source(&self, span: &Span, seed: Seed) -> Result<ImuNoiseSource, ImuNoiseError> {
        let of = |model, triad| {
            TriadNoise::new(model, span, triad, seed)
                .map_err(|reason| ImuNoiseError { triad, reason })
        };
        Ok(ImuNoiseSource {
            gyro: of(&self.gyro, Triad::Gyro)?,
            accel: of(&self.accel, Triad::Accel)?,
        })
    }
}

impl ImuNoiseSource {
    /// The output of the IMU over its next interval, of which `increments` is the noise-free output.
    #[must_use]
    pub fn corrupt(&mut self, increments: &Increments) -> Increments {
        let interval = increments.interval;
        Increments {
            angle: self.gyro.corrupt(&increments.angle, interval),
            velocity: self.accel.corrupt(&increments.velocity, interval),
            interval,
        }
    }

    /// The noise of one triad.
    pub fn triad(&self, triad: Triad) -> &TriadNoise {
        match triad {
            Triad::Gyro => &self.gyro,
            Triad::Accel => &self.accel,
        }
    }
}
