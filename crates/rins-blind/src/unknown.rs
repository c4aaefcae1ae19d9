//! What no catalogue holds.

use std::f64::consts::{PI, TAU};

use rand::RngExt;
use rand_distr::{Distribution, StudentT};

use crate::random::{Random, random};

/// Something on one channel that is none of the effects.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// Where it is.
    pub channel: Channel,
    /// What it looks like.
    pub shape: Shape,
    /// How large it is, in SI units; of the shapes of scatter, how many times as strong it becomes.
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

/// What a structure looks like; its largest value is about 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Up slowly and down at once, in time.
    Sawtooth {
        /// \[s\].
        period: f64,
    },
    /// A wave of the table angle that is no harmonic.
    Order {
        /// How often a turn.
        order: f64,
        /// \[rad\].
        phase: f64,
    },
    /// A wave whose frequency grows.
    Chirp {
        /// At the start of the run \[Hz\].
        from: f64,
        /// How much faster it becomes \[Hz/s\].
        growth: f64,
    },
    /// Up or down at random.
    Telegraph {
        /// The times at which it switches \[s\].
        switches: Vec<f64>,
    },
    /// A wave once a turn that comes and goes.
    Modulated {
        /// Over what time \[s\].
        period: f64,
        /// Where in the turn \[rad\].
        phase: f64,
    },
    /// A bump at one place of every turn.
    Bump {
        /// Where \[rad\].
        at: f64,
        /// How wide \[rad\].
        width: f64,
    },
    /// Noise that is stronger for a while.
    Burst {
        /// From \[s\].
        from: f64,
        /// To \[s\].
        to: f64,
    },
    /// Noise with tails: Student's t of three degrees of freedom beside what is normal.
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

    /// What it is in words.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Sawtooth { .. } => "sawtooth",
            Self::Order { .. } => "broken order",
            Self::Chirp { .. } => "chirp",
            Self::Telegraph { .. } => "telegraph",
            Self::Modulated { .. } => "modulated once per turn",
            Self::Bump { .. } => "bump in the turn",
            Self::Burst { .. } => "burst of noise",
            Self::Tails => "heavy tails",
        }
    }

    /// Whether it is a signal, and not a matter of scatter.
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
    /// How many times as strong white noise is at this time.
    pub(crate) fn noise(&self, time: f64, random: &mut Random) -> f64 {
        match &self.shape {
            Shape::Burst { from, to } if (*from..*to).contains(&time) => self.size,
            Shape::Tails => {
                // A normal number times this is Student's t: normal over the root of chi-square.
                let heavy = StudentT::new(3.0).map_or(0.0, |t| t.sample(random));
                (1.0 + (self.size * heavy).powi(2)).sqrt()
            }
            _ => 1.0,
        }
    }
}
