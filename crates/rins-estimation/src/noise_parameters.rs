//! How strong the random errors are.

use rins_imu::{ImuNoise, ImuSpec, NoiseModel, TriadSpec};
use rins_terms::{Model, Noises, catalogue};

/// The random errors of one triad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TriadStrengths {
    /// The root density of white noise \[per √Hz\].
    pub white: f64,
    /// The flicker floor, as the bias instability `B` of IEEE Std 952: density `B²/(2πf)`.
    pub flicker: f64,
    /// The density of the bias' random walk, `K` \[per √s\].
    pub walk: f64,
}

/// The random errors of an IMU, and of the clock that reads the encoder beside it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoiseParameters {
    /// Of the gyros \[rad/s\].
    pub gyro: TriadStrengths,
    /// Of the accelerometers \[m/s²\].
    pub accel: TriadStrengths,
    /// 1σ of the moments at which the encoder is read, about those of the samples \[s\]; zero if it is read with them.
    pub jitter: f64,
}

impl TriadStrengths {
    /// Those of a data sheet; what it leaves out is zero.
    pub fn of(spec: &TriadSpec) -> Self {
        Self {
            white: spec.noise_density,
            flicker: spec.bias_instability.unwrap_or_default(),
            walk: spec.random_walk.unwrap_or_default(),
        }
    }
}

impl NoiseParameters {
    /// Those of a data sheet; what it leaves out is zero.
    pub fn of(imu: &ImuSpec) -> Self {
        Self {
            gyro: TriadStrengths::of(&imu.gyro),
            accel: TriadStrengths::of(&imu.accel),
            jitter: 0.0,
        }
    }

    /// The same with what the noise among a model's terms makes of it, as it does of a simulation's.
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

/// What is known of the sensors' random errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoiseKnowledge {
    /// They are this strong.
    Given(NoiseParameters),
    /// These strengths are a first guess, and the most likely ones are found from the data, those of
    /// the encoder and of the axis' wobble with them.
    Likely(NoiseParameters),
}

impl NoiseKnowledge {
    /// The strengths that were stated, be they trusted or a first guess.
    pub const fn sheet(&self) -> NoiseParameters {
        let (Self::Given(strengths) | Self::Likely(strengths)) = self;
        *strengths
    }
}

/// All noise of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Of the sensors.
    pub imu: NoiseParameters,
    /// 1σ of the axis' direction at a reading, each of two components \[rad\].
    pub wobble: f64,
    /// 1σ of a reading of the encoder \[rad\]; unused where there is none.
    pub encoder: f64,
    /// How far the velocity of the base may be from zero at a reading, 1σ \[m/s\].
    pub velocity: f64,
    /// The root density with which the attitude of a base that nothing reads strays about each axis \[rad/√s\]; zero if
    /// it is firm. About the third also that of a table from its command, beside what its rig states.
    pub sway: [f64; 3],
}

impl Noise {
    /// That of the sensors' strengths on a rig, whose base is firm.
    pub fn on(rig: &crate::run::Rig, imu: &NoiseParameters) -> Self {
        let encoder = match rig.reference {
            crate::run::Reference::Encoder { noise } => noise,
            _ => rig.wobble,
        };
        Self { imu: *imu, wobble: rig.wobble, encoder, velocity: rig.velocity, sway: [0.0; 3] }
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
            // What is a signal is none.
            TermInstance::new(&catalogue::GYRO_SCALE_ASYMMETRY).with_values(&[1.0]),
        ];
        let found = sheet.with(&Model { terms: terms.to_vec() });
        let gyro = TriadStrengths { white: 3.0, ..triad };
        let accel = TriadStrengths { walk: 0.07, ..triad };
        assert_eq!(found, NoiseParameters { gyro, accel, jitter: 1e-5 });
        assert_eq!(sheet.with(&Model::default()), sheet);
    }
}
