//! Noise parameters: densities of the random errors.

use rins_imu::{ImuNoise, ImuSpec, NoiseModel, TriadSpec};
use rins_terms::{Model, Noises, catalogue};

/// The noise parameters of one triad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TriadStrengths {
    /// Noise density: the square root of the power spectral density of white noise \[per √Hz\].
    pub white: f64,
    /// Bias instability `B` of IEEE Std 952 (flicker noise): power spectral density `B²/(2πf)`.
    pub flicker: f64,
    /// Density `K` of the random walk of the bias \[per √s\].
    pub walk: f64,
}

/// The noise parameters of an IMU, and the timing jitter of the encoder.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoiseParameters {
    /// Those of the gyros \[rad/s\].
    pub gyro: TriadStrengths,
    /// Those of the accelerometers \[m/s²\].
    pub accel: TriadStrengths,
    /// 1σ of the times of the encoder readings relative to those of the samples \[s\]; zero if they are simultaneous.
    pub jitter: f64,
}

impl TriadStrengths {
    /// The random walk that is as visible as white noise and bias instability together over so long \[s\].
    pub fn walk_as_visible(&self, duration: f64) -> f64 {
        (self.white / duration).hypot(self.flicker / duration.sqrt())
    }

    /// Those of a data sheet; a value that it does not state is zero.
    pub fn of(spec: &TriadSpec) -> Self {
        Self {
            white: spec.noise_density,
            flicker: spec.bias_instability.unwrap_or_default(),
            walk: spec.random_walk.unwrap_or_default(),
        }
    }
}

impl NoiseParameters {
    /// Those of a data sheet; a value that it does not state is zero.
    pub fn of(imu: &ImuSpec) -> Self {
        Self {
            gyro: TriadStrengths::of(&imu.gyro),
            accel: TriadStrengths::of(&imu.accel),
            jitter: 0.0,
        }
    }

    /// The same with the noise terms of a model applied, as in a simulation.
    #[must_use]
    pub fn with(&self, model: &Model) -> Self {
        let noise = |triad: &TriadStrengths| NoiseModel {
            bias_random_walk: triad.walk,
            flicker: (triad.flicker > 0.0).then_some(triad.flicker),
            ..NoiseModel::white(triad.white)
        };
        let strengths = |noise: &NoiseModel| TriadStrengths {
            white: noise.white_density,
            flicker: noise.flicker.unwrap_or_default(),
            walk: noise.bias_random_walk,
        };
        let imu = ImuNoise { gyro: noise(&self.gyro), accel: noise(&self.accel) };
        let Noises { imu, .. } = model.stirred(Noises { imu, encoder: 0.0 });
        let of_jitter = model.terms.iter().find(|one| one.term.is(&catalogue::TIMESTAMP_JITTER));
        let jitter = of_jitter.map_or(0.0, |one| one.values[0]);
        Self {
            gyro: strengths(&imu.gyro),
            accel: strengths(&imu.accel),
            jitter: self.jitter.hypot(jitter),
        }
    }
}

/// The prior knowledge of the sensors' noise parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoiseKnowledge {
    /// The noise parameters are known.
    Given(NoiseParameters),
    /// These are prior values; the noise parameters of the sensors, of the encoder and of the axis wobble are estimated
    /// from the data by restricted maximum likelihood.
    Likely(NoiseParameters),
    /// The same, with further processes that the data sheet does not state: random walks of the biases and timing jitter.
    Open {
        /// The prior values of what is stated.
        stated: NoiseParameters,
        /// The prior values of what is not, each known to a factor of twenty; zero where a process is absent.
        open: NoiseParameters,
    },
}

impl NoiseKnowledge {
    /// The stated noise parameters, whether fixed or prior values.
    pub const fn sheet(&self) -> NoiseParameters {
        let (Self::Given(stated) | Self::Likely(stated) | Self::Open { stated, .. }) = self;
        *stated
    }

    /// The prior values of the processes that are not stated; zero where there is none.
    pub fn open(&self) -> NoiseParameters {
        match self {
            Self::Open { open, .. } => *open,
            Self::Given(_) | Self::Likely(_) => NoiseParameters::default(),
        }
    }

    /// Whether the noise parameters are estimated.
    pub const fn is_estimated(&self) -> bool {
        matches!(self, Self::Likely(_) | Self::Open { .. })
    }
}

/// The noise of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// That of the sensors.
    pub imu: NoiseParameters,
    /// Wobble: 1σ of the direction of the spin axis in one reading, for each of two components \[rad\].
    pub wobble: f64,
    /// 1σ of an encoder reading \[rad\]; unused without an encoder.
    pub encoder: f64,
    /// 1σ of the velocity of the base in one reading \[m/s\]; its mean is zero.
    pub velocity: f64,
    /// Sway: the density of the random walk of the base attitude about each axis, if no table angle is measured \[rad/√s\];
    /// zero for a stationary base. The third component is also the deviation of the table from its command, in addition to
    /// that of the rig.
    pub sway: [f64; 3],
    /// 1σ of the error of a rotation between static intervals, relative to the rotation: what sampling, bandwidth and
    /// nonlinearity of the gyros leave. It is not a random walk: a rotation takes seconds.
    pub turn: f64,
}

/// The expected error of a rotation between static intervals, relative to the rotation.
const TURN: f64 = 1e-5;

impl Noise {
    /// The noise of these noise parameters on a rig with a stationary base.
    pub fn on(rig: &crate::run::Rig, imu: &NoiseParameters) -> Self {
        let encoder = match rig.reference {
            crate::run::Reference::Encoder { noise } => noise,
            _ => rig.wobble,
        };
        Self {
            imu: *imu,
            wobble: rig.wobble,
            encoder,
            velocity: rig.velocity,
            sway: [0.0; 3],
            turn: TURN,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_terms::{TermInstance, catalogue};

    #[test]
    fn noise_of_a_model_comes_to_that_of_the_sheet() {
        let triad = TriadStrengths { white: 2.0, flicker: 0.3, walk: 0.0 };
        let sheet = NoiseParameters { gyro: triad, accel: triad, jitter: 0.0 };
        let terms = [
            TermInstance::new(&catalogue::GYRO_NOISE_LEVEL).with_values(&[0.5]),
            TermInstance::new(&catalogue::ACCEL_RATE_RANDOM_WALK).with_values(&[0.07]),
            TermInstance::new(&catalogue::TIMESTAMP_JITTER).with_values(&[1e-5]),
            // A signal is not noise.
            TermInstance::new(&catalogue::GYRO_SCALE_ASYMMETRY).with_values(&[1.0]),
        ];
        let found = sheet.with(&Model { terms: terms.to_vec() });
        let gyro = TriadStrengths { white: 3.0, ..triad };
        let accel = TriadStrengths { walk: 0.07, ..triad };
        assert_eq!(found, NoiseParameters { gyro, accel, jitter: 1e-5 });
        assert_eq!(sheet.with(&Model::default()), sheet);
    }
}
