//! Random errors of sensors: white noise, flicker noise and random walk, one number per sample.

use std::f64::consts::PI;

use rand_distr::{Distribution, StandardNormal};

use crate::random::Random;

/// The noise parameters of a sensor; densities are two-sided.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Noise {
    /// The noise density of white noise.
    pub white: f64,
    /// `B` of flicker noise with the density `B²/(2πf)`.
    pub flicker: f64,
    /// `K` of a random walk with the density `K²/(2πf)²`.
    pub walk: f64,
}

/// The ratio of the time constants of adjacent processes that approximate flicker noise.
const RATIO: f64 = 3.0;

/// The time constant of the slowest process, in durations of the run: slower ones are a bias.
const SLOWEST: f64 = 16.0;

/// A generator of noise, sample by sample.
#[derive(Clone, Debug)]
pub(crate) struct Scatter {
    sigma: f64,
    /// Gauss-Markov processes: the decay factor, the standard deviation of the driving noise, the state.
    slow: Vec<(f64, f64, f64)>,
    step: f64,
    walked: f64,
}

impl Scatter {
    /// A generator for samples of `interval` \[s\], in a run of `duration` \[s\].
    pub(crate) fn new(noise: &Noise, interval: f64, duration: f64, random: &mut Random) -> Self {
        // One process has the one-sided density 4 σ² τ / (1 + (2πfτ)²); the sum of processes with time constants in the ratio
        // RATIO is σ² / (f ln RATIO), which must equal B² / (πf).
        let sigma = noise.flicker * (RATIO.ln() / PI).sqrt();
        let mut slow = Vec::new();
        let mut time = interval;
        while sigma > 0.0 && time < SLOWEST * duration {
            let kept = (-interval / time).exp();
            let start: f64 = StandardNormal.sample(random);
            slow.push((kept, sigma * (1.0 - kept * kept).sqrt(), sigma * start));
            time *= RATIO;
        }
        let sigma = noise.white / interval.sqrt();
        Self { sigma, slow, step: noise.walk * interval.sqrt(), walked: 0.0 }
    }

    /// The next number, with its white part multiplied by `times`.
    pub(crate) fn next(&mut self, times: f64, random: &mut Random) -> f64 {
        let mut normal = || -> f64 { StandardNormal.sample(random) };
        let mut sum = self.sigma * times * normal();
        for (kept, added, state) in &mut self.slow {
            *state = *kept * *state + *added * normal();
            sum += *state;
        }
        if self.step > 0.0 {
            self.walked += self.step * normal();
        }
        sum + self.walked
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::random;

    /// The Allan variance of flicker noise is constant, `2 ln 2 B² / π`, by IEEE Std 952.
    #[test]
    fn flicker_is_flat_at_its_level() {
        const LEVEL: f64 = 3.0;
        let mut random = random(7, 0);
        let noise = Noise { flicker: LEVEL, ..Noise::default() };
        let expected = 2.0 * 2.0_f64.ln() / PI * LEVEL.powi(2);
        for length in [16, 128, 1024] {
            let (mut sum, mut count) = (0.0, 0.0);
            for _ in 0..40 {
                let mut scatter = Scatter::new(&noise, 0.02, 1e3, &mut random);
                let mut mean = || {
                    let sum: f64 = (0..length).map(|_| scatter.next(1.0, &mut random)).sum();
                    sum / f64::from(length)
                };
                let means: Vec<f64> = (0..32).map(|_| mean()).collect();
                sum += means.windows(2).map(|w| 0.5 * (w[1] - w[0]).powi(2)).sum::<f64>();
                count += 31.0;
            }
            let ratio = sum / count / expected;
            // About 600 nearly independent differences: 6 % at 1σ.
            assert!((ratio - 1.0).abs() < 0.2, "{length} samples: {ratio}");
        }
    }

    #[test]
    fn white_noise_and_walk_have_their_densities() {
        let mut random = random(8, 0);
        let noise = Noise { white: 2.0, flicker: 0.0, walk: 0.0 };
        let mut scatter = Scatter::new(&noise, 0.25, 1e3, &mut random);
        let square: f64 = (0..10_000).map(|_| scatter.next(1.0, &mut random).powi(2)).sum();
        assert!((square / 10_000.0 - 16.0).abs() < 1.0, "{square}");
        let noise = Noise { white: 0.0, flicker: 0.0, walk: 2.0 };
        let ends = (0..2000).map(|_| {
            let mut scatter = Scatter::new(&noise, 0.25, 1e3, &mut random);
            (0..100).fold(0.0, |_, _| scatter.next(1.0, &mut random))
        });
        // After 25 s: K² · 25 s.
        let square: f64 = ends.map(|end| end.powi(2)).sum();
        assert!((square / 2000.0 - 100.0).abs() < 15.0, "{square}");
    }
}
