//! Monte Carlo of a mission: strapdown navigation with drawn errors.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use nalgebra::Vector3;
use rayon::prelude::*;
use rins_design::{Draw, Voyage};
use rins_imu::{Seed, Sensor};
use rins_motion::CarriedTable;

use super::case::Case;
use super::uncertainty::{Uncertainty, drawn};
use crate::progress::Stage;

/// Draws are divided into portions of a multiple of this number: at most so many are navigated side by side.
const SIDE_BY_SIDE: usize = 8;

/// The simulation that is asked for.
pub(super) struct Wish<'a> {
    pub(super) runs: u32,
    pub(super) seed: u64,
    pub(super) stage: &'a Stage<'a>,
    /// How many results came before this simulation.
    pub(super) done: &'a AtomicUsize,
}

/// The position errors of simulated missions.
#[derive(Clone, Debug)]
pub(super) struct Simulated {
    pub(super) runs: u32,
    pub(super) seed: u64,
    /// The time that they took \[s\].
    pub(super) seconds: f64,
    /// What they say at each time.
    pub(super) spreads: Vec<SampleSpread>,
}

/// The spread of the radial position errors of a sample \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SampleSpread {
    /// The root mean square, and its interval of 95 %.
    pub(super) rms: f64,
    pub(super) rms_within: [f64; 2],
    /// The median, and its interval of 95 %.
    pub(super) half: f64,
    pub(super) half_within: [f64; 2],
    /// The radius that holds 95 % of the sample.
    pub(super) most: f64,
}

impl Simulated {
    /// Simulated missions with errors of this uncertainty.
    pub(super) fn of(
        case: &Case<'_>,
        table: &CarriedTable,
        of: &Uncertainty,
        wish: &Wish<'_>,
    ) -> anyhow::Result<Self> {
        Self::within((case, &case.file.times), table, of, wish)
    }

    /// The same until the last of these times \[s\].
    pub(super) fn within(
        (case, times): (&Case<'_>, &[f64]),
        table: &CarriedTable,
        of: &Uncertainty,
        wish: &Wish<'_>,
    ) -> anyhow::Result<Self> {
        let started = Instant::now();
        let root = of.root();
        let draws: Vec<Draw> = (0..u64::from(wish.runs))
            .map(|run| {
                let seed = Seed { seed: wish.seed, run };
                let mut stream = seed.stream(Sensor::Unit);
                let errors = drawn(&root, &mut stream);
                let sigma = case.file.attitude_sigma;
                let attitude = Vector3::from_fn(|_, _| stream.sample() * sigma);
                Draw { errors, attitude, seed }
            })
            .collect();
        let (model, parameters) = (case.model, case.places);
        let voyage = Voyage { table, model, parameters, noise: of.noise.each_ref() };
        let heard = |_: usize| wish.stage.done(wish.done.fetch_add(1, Ordering::Relaxed) + 1);
        let found: Vec<Vec<Vec<[f64; 2]>>> = draws
            .par_chunks(portion(draws.len()))
            .map(|draws| voyage.simulated(draws, case.file.sample_interval, times, &heard))
            .collect::<Result<_, _>>()?;
        let found: Vec<Vec<[f64; 2]>> = found.into_iter().flatten().collect();
        let spreads = (0..times.len()).map(|time| {
            SampleSpread::of(found.iter().map(|draw| draw[time][0].hypot(draw[time][1])).collect())
        });
        Ok(Self {
            runs: wish.runs,
            seed: wish.seed,
            spreads: spreads.collect(),
            seconds: started.elapsed().as_secs_f64(),
        })
    }

    /// How often `done` is heard for these times.
    pub(super) fn steps(runs: u32, times: usize) -> usize {
        let runs = runs as usize;
        runs.div_ceil(portion(runs)) * times
    }
}

/// The number of draws of each thread.
fn portion(draws: usize) -> usize {
    draws.div_ceil(rayon::current_num_threads()).next_multiple_of(SIDE_BY_SIDE)
}

impl SampleSpread {
    /// That of at least one radius.
    fn of(mut radii: Vec<f64>) -> Self {
        radii.sort_by(f64::total_cmp);
        let count = radii.len() as f64;
        let quantile = |part: f64| {
            let place = (part * (count - 1.0)).clamp(0.0, count - 1.0);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
            let below = place as usize;
            let above = (below + 1).min(radii.len() - 1);
            radii[below] + (place - below as f64) * (radii[above] - radii[below])
        };
        let squares: Vec<f64> = radii.iter().map(|radius| radius * radius).collect();
        let mean = squares.iter().sum::<f64>() / count;
        let variance = squares.iter().map(|square| (square - mean).powi(2)).sum::<f64>() / count;
        // By the central limit theorem; the rank of the median is binomial.
        let reach = 1.96 * (variance / count).sqrt();
        let rank = 1.96 * 0.5 / count.sqrt();
        Self {
            rms: mean.sqrt(),
            rms_within: [mean - reach, mean + reach].map(|square| square.max(0.0).sqrt()),
            half: quantile(0.5),
            half_within: [quantile(0.5 - rank), quantile(0.5 + rank)],
            most: quantile(0.95),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quantiles of a Rayleigh distribution lie in their intervals.
    #[test]
    fn sample_of_a_circle_has_its_quantiles() {
        let count = 2000;
        let radius = |k: u32| (-2.0 * (1.0 - (f64::from(k) + 0.5) / f64::from(count)).ln()).sqrt();
        let spread = SampleSpread::of((0..count).map(radius).collect());
        assert!((spread.half - 1.177_410).abs() < 1e-3, "{spread:?}");
        assert!((spread.most - 2.447_747).abs() < 5e-3, "{spread:?}");
        assert!((spread.rms - std::f64::consts::SQRT_2).abs() < 1e-3, "{spread:?}");
        // The relative error of an rms of 2000 Rayleigh numbers is 1/(2 √2000).
        let half_width = 0.5 * (spread.rms_within[1] - spread.rms_within[0]) / spread.rms;
        assert!((half_width / (1.96 * 0.5 / 2000_f64.sqrt()) - 1.0).abs() < 0.05, "{spread:?}");
        assert!(spread.half_within[0] < spread.half && spread.half < spread.half_within[1]);
    }
}
