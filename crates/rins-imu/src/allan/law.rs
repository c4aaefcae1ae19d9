//! The laws of sensor noise, with their Allan variances and correlations in time.

use std::f64::consts::{LN_2, PI};

/// A kind of noise with its own dependence of the Allan variance on averaging time (‹ieee952›, annex C).
///
/// A rate is in rad/s for gyros and in m/s² for accelerometers; its integral is an angle or a velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoiseLaw {
    /// `Q`, quantization noise: white noise in the integral \[rad or m/s\]: 3 Q²/τ². For pulses of one bit, Q = bit/√12.
    Quantisation,
    /// `N`, white noise in the rate \[rate/√Hz\]: N²/τ.
    White,
    /// `B`, the bias instability, flicker noise in the rate \[rate\]: (2 ln 2/π) B².
    Flicker,
    /// `K`, white noise in the derivative of the rate \[rate/√s\]: K² τ/3.
    RandomWalk,
}

impl NoiseLaw {
    /// All laws, in the order of their slope over the averaging time.
    pub const ALL: [Self; 4] = [Self::Quantisation, Self::White, Self::Flicker, Self::RandomWalk];

    /// The Allan variance for a unit noise parameter at the averaging time `time` \[s\].
    pub fn allan_variance(self, time: f64) -> f64 {
        match self {
            Self::Quantisation => 3.0 / (time * time),
            Self::White => 1.0 / time,
            Self::Flicker => 2.0 * LN_2 / PI,
            Self::RandomWalk => time / 3.0,
        }
    }

    /// The generalized autocovariance of the integrated rate for a unit noise parameter at the lag `lag` \[s\].
    ///
    /// Only its fourth differences are meaningful: they are the covariances of second differences
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
