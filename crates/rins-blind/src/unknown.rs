//! Error structures outside the catalogue.

use std::f64::consts::{PI, TAU};

use rand::RngExt;
use rand_distr::{Distribution, StudentT};

use crate::random::{Random, random};

/// An error of one channel that is no effect of the catalogue.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// The channel.
    pub channel: Channel,
    /// The shape.
    pub shape: Shape,
    /// Amplitude, in SI units; for shapes of noise, the factor by which the noise increases.
    pub size: f64,
}

/// One of six sensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Gyro 0, 1, 2.
    Gyro(usize),
    /// Accelerometer 0, 1, 2.
    Accel(usize),
}

/// Shape of a structure; its maximum is about 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Sawtooth in time.
    Sawtooth {
        /// \[s\].
        period: f64,
    },
    /// Harmonic of the table angle with a non-integer order.
    Order {
        /// Periods per revolution.
        order: f64,
        /// \[rad\].
        phase: f64,
    },
    /// Sinusoid whose frequency increases at a constant rate.
    Chirp {
        /// At the start of the run \[Hz\].
        from: f64,
        /// Rate of change of the frequency \[Hz/s\].
        growth: f64,
    },
    /// Telegraph signal: random switching between two levels.
    Telegraph {
        /// The times at which it switches \[s\].
        switches: Vec<f64>,
    },
    /// First harmonic of the table angle with modulated amplitude.
    Modulated {
        /// Period of the modulation \[s\].
        period: f64,
        /// Phase \[rad\].
        phase: f64,
    },
    /// Pulse at one table angle in every revolution.
    Bump {
        /// Table angle \[rad\].
        at: f64,
        /// Width \[rad\].
        width: f64,
    },
    /// Burst of noise.
    Burst {
        /// From \[s\].
        from: f64,
        /// To \[s\].
        to: f64,
    },
    /// Heavy-tailed noise: Student's t with three degrees of freedom in addition to the normal noise.
    Tails,
}

impl Shape {
    /// The times at which a telegraph switches on average every `mean` seconds, up to `duration`.
    pub fn telegraph(mean: f64, duration: f64, seed: u64) -> Self {
        let mut random = random(seed, 99);
        let mut switches = Vec::new();
        let mut time = 0.0;
        while time < duration {
            let uniform: f64 = random.random();
            time -= mean * (1.0 - uniform).ln();
            switches.push(time);
        }
        Self::Telegraph { switches }
    }

    /// Name in words.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Sawtooth { .. } => "sawtooth",
            Self::Order { .. } => "non-integer harmonic order",
            Self::Chirp { .. } => "chirp",
            Self::Telegraph { .. } => "telegraph",
            Self::Modulated { .. } => "modulated, once per revolution",
            Self::Bump { .. } => "pulse once per revolution",
            Self::Burst { .. } => "burst of noise",
            Self::Tails => "heavy tails",
        }
    }

    /// Whether it is a signal and not noise.
    pub const fn is_signal(&self) -> bool {
        !matches!(self, Self::Burst { .. } | Self::Tails)
    }

    /// Its value at this time and table angle.
    pub(crate) fn value(&self, time: f64, angle: f64) -> f64 {
        match self {
            Self::Sawtooth { period } => 2.0 * (time / period).rem_euclid(1.0) - 1.0,
            Self::Order { order, phase } => (order * angle + phase).cos(),
            Self::Chirp { from, growth } => (TAU * time * (from + 0.5 * growth * time)).sin(),
            Self::Telegraph { switches } => {
                let passed = switches.partition_point(|switch| *switch < time);
                if passed.is_multiple_of(2) { 1.0 } else { -1.0 }
            }
            Self::Modulated { period, phase } => {
                (angle + phase).cos() * (TAU * time / period).sin()
            }
            Self::Bump { at, width } => {
                let off = (angle - at + PI).rem_euclid(TAU) - PI;
                (-0.5 * (off / width).powi(2)).exp()
            }
            Self::Burst { .. } | Self::Tails => 0.0,
        }
    }
}

impl Unknown {
    /// Factor of the white noise at this time.
    pub(crate) fn noise(&self, time: f64, random: &mut Random) -> f64 {
        match &self.shape {
            Shape::Burst { from, to } if (*from..*to).contains(&time) => self.size,
            Shape::Tails => {
                // The product of a normal number and this factor has Student's t distribution: normal over the root of χ².
                let heavy = StudentT::new(3.0).map_or(0.0, |t| t.sample(random));
                (1.0 + (self.size * heavy).powi(2)).sqrt()
            }
            _ => 1.0,
        }
    }
}
