//! The laws that the noise of a sensor follows, and how each correlates in time.

use std::f64::consts::{LN_2, PI};

/// A noise with a law of its own in the Allan variance (‹ieee952›, annex C).
///
/// A rate is in rad/s for gyros and in m/s² for accelerometers, its integral an angle or a velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoiseLaw {
    /// `Q`, white noise in the integral \[rad or m/s\]: 3 Q²/τ². Pulses of one bit make bit/√12.
    Quantisation,
    /// `N`, white noise in the rate \[rate/√Hz\]: N²/τ.
    White,
    /// `B`, the bias instability, flicker noise in the rate \[rate\]: (2 ln 2/π) B².
    Flicker,
    /// `K`, white noise in the derivative of the rate \[rate/√s\]: K² τ/3.
    RandomWalk,
}

impl NoiseLaw {
    /// All of them, by their slope over the averaging time.
    pub const ALL: [Self; 4] = [Self::Quantisation, Self::White, Self::Flicker, Self::RandomWalk];

    /// The Allan variance of strength one at the averaging time `time` \[s\].
    pub fn allan_variance(self, time: f64) -> f64 {
        match self {
            Self::Quantisation => 3.0 / (time * time),
            Self::White => 1.0 / time,
            Self::Flicker => 2.0 * LN_2 / PI,
            Self::RandomWalk => time / 3.0,
        }
    }

    /// The generalised autocovariance of the integrated rate at strength one, `lag` \[s\] apart.
    ///
    /// Only its fourth differences mean something: they are the covariances of second differences
    /// (‹greenhall2003›).
    pub(super) fn autocovariance(self, lag: f64) -> f64 {
        let lag = lag.abs();
        match self {
            Self::Quantisation => f64::from(u8::from(lag == 0.0)),
            Self::White => -lag / 2.0,
            Self::Flicker if lag == 0.0 => 0.0,
            Self::Flicker => lag * lag * lag.ln() / (2.0 * PI),
            Self::RandomWalk => lag * lag * lag / 12.0,
        }
    }
}
