//! The noise in a static interval: an initial estimate from its seconds, and the maximum likelihood estimate from the
//! innovations.

use std::ops::Range;

use nalgebra::Vector3;
use rins_ekf::UpdateError;
use rins_frames::{InFrame, Rates};

use crate::median::median;
use crate::recording::Recording;
use crate::rest::RestMean;

/// The time between two zero-velocity updates \[s\].
const UPDATE_INTERVAL: f64 = 1.0;

/// The initial 1σ of the velocity of a stationary base \[m/s\]: a person who walks by shakes it.
const ZERO_VELOCITY_SIGMA: f64 = 1e-3;

/// White noise: noise densities of gyros and accelerometers \[per √Hz\], and the velocity noise of the base \[m/s\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise(pub(super) [f64; 3]);

/// The maximum likelihood estimate of the noise, to ten percent, by a search along each coordinate in turn; for the gyros the
/// upper end of its uncertainty.
///
/// The scatter in a static interval does not distinguish sensor noise from sway; the innovations do.
pub(super) fn most_likely(
    guess: Noise,
    gyro: Option<f64>,
    mut log_likelihood: impl FnMut(Noise) -> Result<f64, UpdateError>,
) -> Result<Noise, UpdateError> {
    const FACTORS: [f64; 3] = [3.0, 1.5, 1.2];
    const ROUNDS: usize = 20;
    let mut best = guess;
    best.0[0] = gyro.unwrap_or(guess.0[0]);
    let first = usize::from(gyro.is_some());
    let mut most = log_likelihood(best)?;
    for factor in FACTORS {
        for _ in 0..ROUNDS {
            let before = most;
            for coordinate in first..3 {
                for factor in [factor, 1.0 / factor] {
                    let mut tried = best;
                    tried.0[coordinate] *= factor;
                    let likelihood = log_likelihood(tried)?;
                    if likelihood > most {
                        (best, most) = (tried, likelihood);
                        break;
                    }
                }
            }
            // Smaller increases do not justify another round.
            if most - before < 0.1 {
                break;
            }
        }
    }
    if gyro.is_some() {
        return Ok(best);
    }
    // Zero-velocity updates hold little information on a noise as small as that of a gyro: the largest density within one
    // sigma of the maximum keeps the covariance consistent.
    for _ in 0..ROUNDS {
        let mut larger = best;
        larger.0[0] *= FACTORS[2];
        if log_likelihood(larger)? < most - 0.5 {
            break;
        }
        best = larger;
    }
    Ok(best)
}

/// A second of the recording, and its mean rates.
pub(super) struct Second {
    pub(super) span: Range<usize>,
    pub(super) rates: Rates,
    pub(super) duration: f64,
}

pub(super) fn seconds(recording: &Recording, span: Range<usize>) -> Vec<Second> {
    let mut seconds = Vec::new();
    let (mut first, mut elapsed) = (span.start, 0.0);
    for index in span {
        elapsed += recording.increments[index].interval;
        if elapsed >= UPDATE_INTERVAL * (1.0 - 1e-9) {
            let span = first..index + 1;
            if let Some(mean) = RestMean::of(recording, span.clone()) {
                seconds.push(Second { span, rates: mean.rates, duration: mean.duration });
            }
            (first, elapsed) = (index + 1, 0.0);
        }
    }
    seconds
}

/// An initial estimate of the noise from the means over several seconds.
///
/// It is the median of the differences of successive means, so that a footstep has no effect. Over ten seconds the rounding
/// of increments, which does not accumulate, averages out; if the interval is shorter than twenty seconds, halves are
/// compared.
pub(super) fn scatter(seconds: &[Second]) -> Option<Noise> {
    const MOST: usize = 10;
    let together = MOST.min(seconds.len() / 2).max(1);
    let means: Vec<Rates> = seconds
        .chunks_exact(together)
        .map(|seconds| {
            let mean = |of: fn(&Rates) -> &Vector3<f64>| {
                let sum: Vector3<f64> = seconds.iter().map(|second| of(&second.rates)).sum();
                InFrame::from_components(sum / together as f64)
            };
            Rates {
                angular_rate: mean(|rates| rates.angular_rate.components()),
                specific_force: mean(|rates| rates.specific_force.components()),
            }
        })
        .collect();
    let duration = together as f64 * UPDATE_INTERVAL;
    let of = |component: fn(&Rates) -> &Vector3<f64>| {
        let steps = means.windows(2).map(|pair| {
            let step = component(&pair[1]) - component(&pair[0]);
            // Each of three components has twice the variance of one mean.
            (step.norm_squared() / 6.0 * duration).sqrt()
        });
        // The median of √(χ²₃ / 3) is 0.888.
        median(steps).map(|median| median / 0.888)
    };
    let gyro = of(|rates| rates.angular_rate.components())?;
    let accel = of(|rates| rates.specific_force.components())?;
    Some(Noise([gyro, accel, ZERO_VELOCITY_SIGMA]))
}
