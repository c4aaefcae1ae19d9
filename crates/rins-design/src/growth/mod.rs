//! The growth of navigation errors over days: a linear model, exact for pieces of constant table rate.
//!
//! A free inertial navigator at a fixed place has the errors `x = (φ, δv, δr)`: of the attitude about east, north and up, defined by
//! `C~_b^n = (I - φ×) C_b^n`, of the horizontal velocity, and of the position. With the Earth's rate `ω_ie`, gravity `g` and the radii of
//! curvature,
//!
//! ```text
//! φ'  = -ω_ie × φ + δω_in - C_b^n δω_ib
//! δv' = (0, 0, g) × φ + C_b^n δf - 2 ω_ie × δv
//! δr' = δv
//! ```
//!
//! with `δω_in` by the errors of latitude and velocity: the oscillations of Schuler, of Foucault and of the Earth's rate, and the growth of
//! the longitude. The vertical channel is held. The sensor errors are terms of the catalogue at the table angle `ζ`: `C_b^n δω_ib` is a
//! Fourier series in `ζ`, and `ζ` is linear in time, so that the integral over a piece is a matrix exponential.

mod alignment;
mod input;
mod piece;
mod sensitivity;
mod service;
mod simulation;
mod system;
mod voyage;

use std::collections::HashMap;

use rins_motion::Segment;

use self::input::Input;
use self::piece::Piece;
use self::service::{Columns, Square};
pub use self::service::{GROWTH_STATES, Growth, Service};
pub use self::simulation::Draw;
pub use self::voyage::{NOISE_INTERVAL, Voyage};

/// Pieces are at most so long \[s\], and at most one revolution: a matrix exponential loses accuracy with its argument.
const LONGEST_PIECE: f64 = 600.0;

/// The reason why no growth can be computed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GrowthError {
    /// The cycle has no segment.
    #[error("the cycle of the table has no segment")]
    Empty,
    /// A segment of the cycle has no finite rate, or no positive duration.
    #[error(
        "segment {index} of the cycle: {rate} rad/s for {duration} s, expected a finite rate and a positive duration"
    )]
    Segment {
        /// The segment, from 1.
        index: usize,
        /// Its rate \[rad/s\].
        rate: f64,
        /// Its duration \[s\].
        duration: f64,
    },
    /// The times are not in order, or negative, or not finite.
    #[error("time {time} s: expected finite times since the start in ascending order")]
    Time {
        /// The time \[s\].
        time: f64,
    },
    /// The site is a pole, where east is undefined.
    #[error("the latitude is that of a pole, where east and north are undefined")]
    Pole,
    /// A term is no affine function of angular rate and specific force.
    #[error("{term} is no affine function of angular rate and specific force")]
    NotAffine {
        /// Its id.
        term: &'static str,
    },
    /// The noise is not as it must be.
    #[error("the noise cannot be simulated")]
    Noise(#[from] rins_imu::ImuNoiseError),
}

impl Service<'_> {
    /// The navigation errors at these times \[s\], in ascending order.
    ///
    /// # Errors
    /// [`GrowthError`] if the cycle or a time is not as it must be, or the site is a pole.
    pub fn growth(&self, times: &[f64]) -> Result<Vec<Growth>, GrowthError> {
        self.check(times)?;
        let count = self.parameters.len();
        let mut now = Growth {
            time: 0.0,
            by_parameter: Columns::zeros(count),
            by_start: Square::identity(),
            by_noise: Square::zeros(),
        };
        let mut inputs: HashMap<u64, Input> = HashMap::new();
        let mut pieces: HashMap<[u64; 2], Piece> = HashMap::new();
        let mut grown = Vec::with_capacity(times.len());
        let mut cycle = self.cycle.iter().cycle();
        let mut angle = 0.0;
        let (mut rate, mut left) = (0.0, 0.0);
        for &time in times {
            // What rounding leaves of a segment is none.
            let least = 1e-12 * time;
            while time - now.time > least {
                if left <= least {
                    let Some(next) = cycle.next() else { return Err(GrowthError::Empty) };
                    (rate, left) = (next.rate, next.duration);
                }
                let duration = longest(rate).min(left).min(time - now.time);
                let key = [rate.to_bits(), duration.to_bits()];
                let piece = pieces.entry(key).or_insert_with(|| {
                    Piece::new(&self.surroundings, (rate, duration), self.noise)
                });
                let input = inputs.entry(rate.to_bits()).or_insert_with(|| Input::of(self, rate));
                piece.grow(&mut now, input, angle);
                angle = (angle + rate * duration).rem_euclid(std::f64::consts::TAU);
                left -= duration;
                now.time += duration;
            }
            now.time = time;
            grown.push(now.clone());
        }
        Ok(grown)
    }

    /// The secular growth of the position error east \[m/s\] per unit of each parameter, if a cycle is a whole number of revolutions: the gyro
    /// errors along the Earth's axis, averaged over the cycle, move the longitude; all else oscillates.
    ///
    /// # Errors
    /// [`GrowthError`] as of [`growth`](Self::growth).
    pub fn secular_east(&self) -> Result<Option<Vec<f64>>, GrowthError> {
        self.check(&[])?;
        let site = self.surroundings.station.site;
        let (sin, cos) = site.latitude.sin_cos();
        let radius = (site.transverse_radius() + site.height) * cos;
        let mut sums = vec![0.0; self.parameters.len()];
        let mut inputs: HashMap<u64, Input> = HashMap::new();
        let (mut angle, mut lasting) = (0.0, 0.0);
        for &Segment { rate, duration } in self.cycle {
            let input = inputs.entry(rate.to_bits()).or_insert_with(|| Input::of(self, rate));
            let mean = input.mean(angle, rate * duration);
            for (sum, column) in sums.iter_mut().zip(mean.column_iter()) {
                *sum -= radius * (column[2] * sin + column[1] * cos) * duration;
            }
            angle += rate * duration;
            lasting += duration;
        }
        let turns = angle / std::f64::consts::TAU;
        let closes = (turns - turns.round()).abs() < 1e-6;
        Ok(closes.then(|| sums.into_iter().map(|sum| sum / lasting).collect()))
    }

    fn check(&self, times: &[f64]) -> Result<(), GrowthError> {
        if self.cycle.is_empty() {
            return Err(GrowthError::Empty);
        }
        for (place, &Segment { rate, duration }) in self.cycle.iter().enumerate() {
            if !(rate.is_finite() && duration.is_finite() && duration > 0.0) {
                return Err(GrowthError::Segment { index: place + 1, rate, duration });
            }
        }
        check_times(times)?;
        let latitude = self.surroundings.station.site.latitude;
        if latitude.cos().abs() < 1e-6 { Err(GrowthError::Pole) } else { Ok(()) }
    }
}

/// The longest piece at a rate \[rad/s\], in s.
fn longest(rate: f64) -> f64 {
    let revolution = std::f64::consts::TAU / rate.abs();
    revolution.min(LONGEST_PIECE)
}

fn check_times(times: &[f64]) -> Result<(), GrowthError> {
    let mut before = 0.0;
    for &time in times {
        if !(time.is_finite() && time >= before) {
            return Err(GrowthError::Time { time });
        }
        before = time;
    }
    Ok(())
}
