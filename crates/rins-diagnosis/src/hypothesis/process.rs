//! Noise processes that no data sheet states: random walks of the biases, and a jitter of the encoder's time stamps.

use rins_estimation::{Noise, NoiseParameters, Reference, Run};
use rins_imu::ImuSpec;
use rins_terms::{Term, catalogue};

use crate::criticism::noise::triad;

/// A noise process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Process {
    /// Rate random walk of the gyros.
    GyroWalk,
    /// Random walk of the accelerometers' biases.
    AccelWalk,
    /// Jitter of the times at which the encoder is read.
    Jitter,
}

impl Process {
    const ALL: [Self; 3] = [Self::GyroWalk, Self::AccelWalk, Self::Jitter];

    /// Its entry in the catalogue.
    pub(crate) const fn term(self) -> &'static Term {
        match self {
            Self::GyroWalk => &catalogue::GYRO_RATE_RANDOM_WALK,
            Self::AccelWalk => &catalogue::ACCEL_RATE_RANDOM_WALK,
            Self::Jitter => &catalogue::TIMESTAMP_JITTER,
        }
    }

    /// Its parameter among the noise parameters.
    pub(crate) fn slot(self, noise: &mut NoiseParameters) -> &mut f64 {
        match self {
            Self::GyroWalk => &mut triad(noise, 0).walk,
            Self::AccelWalk => &mut triad(noise, 1).walk,
            Self::Jitter => &mut noise.jitter,
        }
    }

    /// What passes for it where it is absent: bias instability for a random walk, noise of the encoder for jitter.
    fn substitute(self, noise: &mut Noise) -> &mut f64 {
        match self {
            Self::GyroWalk => &mut triad(&mut noise.imu, 0).flicker,
            Self::AccelWalk => &mut triad(&mut noise.imu, 1).flicker,
            Self::Jitter => &mut noise.encoder,
        }
    }

    /// Its value where it is as visible as the other noise, over so long \[s\], at so fast a rate \[rad/s\].
    fn visible(self, noise: &Noise, duration: f64, fastest: f64) -> f64 {
        match self {
            Self::GyroWalk => noise.imu.gyro.walk_as_visible(duration),
            Self::AccelWalk => noise.imu.accel.walk_as_visible(duration),
            Self::Jitter => noise.encoder / fastest,
        }
    }

    /// Its typical value for an IMU with this data sheet, in SI units: the geometric mean of the ends of its range.
    pub(crate) fn typical(self, imu: &ImuSpec) -> f64 {
        let (low, high) = self.term().parameters[0].range(imu);
        (low * high).sqrt()
    }

    /// The processes that may act in some runs beyond what is stated.
    pub(crate) fn available(runs: &[Run], stated: &NoiseParameters) -> Vec<Self> {
        let read = |run: &Run| matches!(run.rig.reference, Reference::Encoder { .. });
        let may_act = |one: &Self| {
            *one.slot(&mut { *stated }) == 0.0 && (*one != Self::Jitter || runs.iter().any(read))
        };
        Self::ALL.into_iter().filter(may_act).collect()
    }

    /// Noises in which it acts, about those of a fit in which it does not: visible over so long \[s\], at so fast a rate
    /// \[rad/s\].
    pub(crate) fn opened(self, noise: &[Noise], duration: f64, fastest: f64) -> Vec<Vec<Noise>> {
        let with = |strength: f64, rest: f64| {
            let mut other = noise.to_vec();
            for one in &mut other {
                *self.slot(&mut one.imu) = strength * self.visible(one, duration, fastest);
                *self.substitute(one) *= rest;
            }
            other
        };
        let strengths = [3.0, 0.75, 0.2].into_iter();
        strengths.flat_map(|strength| [1.0, 0.1].map(|rest| with(strength, rest))).collect()
    }

    /// Noises in which it does not act, about those of a fit in which it does: what it explains over so long \[s\], at so fast a
    /// rate \[rad/s\], passes for the other noise.
    pub(crate) fn closed(self, noise: &[Noise], duration: f64, fastest: f64) -> Vec<Vec<Noise>> {
        let with = |part: f64| {
            let mut other = noise.to_vec();
            for one in &mut other {
                let was = std::mem::take(self.slot(&mut one.imu));
                let alike = part * was * self.substituted(duration, fastest);
                let beside = self.substitute(one);
                *beside = beside.hypot(alike);
            }
            other
        };
        [0.0, 0.2, 0.6, 2.0].map(with).to_vec()
    }

    /// How much of the noise that passes for it is as visible as one unit of it, over so long \[s\], at so fast a rate \[rad/s\].
    fn substituted(self, duration: f64, fastest: f64) -> f64 {
        match self {
            Self::GyroWalk | Self::AccelWalk => duration.sqrt(),
            Self::Jitter => fastest,
        }
    }
}
