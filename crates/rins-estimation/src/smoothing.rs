//! The table angle from two sensors: the reference, whose error is white, and the gyro, whose error is a random walk.

use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

/// The number of stretches of a run, each of which has its own noise level, so that a slip or a ramp counts in one of them only.
const STRETCHES: usize = 32;

/// The log-likelihood that a stretch can lose at most: one with an error that is no noise does not outvote the others.
const MOST_LOST: f64 = 5.0;

/// The ratio of successive time constants that are compared.
const FINENESS: f64 = std::f64::consts::SQRT_2;

/// The smallest of them, in samples: the reading alone determines the angle.
const SHORTEST: f64 = 0.1;

/// The readings of the reference relative to the angle of the gyro, sample by sample.
pub(crate) struct Differences<'a> {
    /// Time at the end of each sample \[s\].
    pub times: &'a [f64],
    /// Readings of the reference \[rad\].
    pub readings: &'a [f64],
    /// Readings minus integrated gyro \[rad\].
    pub values: Vec<f64>,
    /// Whether the gyro measured the rotation since the sample before.
    pub linked: Vec<bool>,
}

impl Differences<'_> {
    /// The differences without the errors of the readings and the angle random walk of the gyro that a random walk in white
    /// noise separates best, at the start and at the end of each sample \[rad\].
    ///
    /// Gyro bias and scale error are estimated first, by least squares. The rest is the minimum of
    /// `Σ (d - s)² + τ² Σ (Δs)²` (Whittaker and Henderson), the two-sided Kalman smoother; τ, the ratio of the standard deviations
    /// of reading and random walk over a sample, is that of the exponential smoothing that predicts the readings best. The
    /// error of the result is then uncorrelated with what remains of readings and gyro, so that no function of the table rate
    /// explains noise. A τ that is known is in samples.
    pub(crate) fn smoothed(mut self, constant: Option<f64>) -> Vec<f64> {
        let trend = self.trend();
        for (value, trend) in self.values.iter_mut().zip(&trend) {
            *value -= trend;
        }
        let smooth = self.smoothed_over(constant.unwrap_or_else(|| self.time_constant()));
        let angles: Vec<f64> =
            smooth.iter().zip(&trend).map(|(smooth, trend)| smooth + trend).collect();
        let start = match *angles {
            [first, second, ..] => first - (second - first),
            _ => angles.first().copied().unwrap_or_default(),
        };
        std::iter::once(start).chain(angles).collect()
    }

    /// The part of the differences that is proportional to time and to the table angle.
    fn trend(&self) -> Vec<f64> {
        let (Some(&start), Some(&first)) = (self.times.first(), self.readings.first()) else {
            return Vec::new();
        };
        let largest = |values: &dyn Fn(usize) -> f64| {
            (0..self.values.len())
                .map(|sample| values(sample).abs())
                .fold(f64::MIN_POSITIVE, f64::max)
        };
        let duration = largest(&|sample| self.times[sample] - start);
        let turned = largest(&|sample| self.readings[sample] - first);
        let row = |sample: usize| {
            Vector3::new(
                1.0,
                (self.times[sample] - start) / duration,
                (self.readings[sample] - first) / turned,
            )
        };
        let mut normal = Matrix3::zeros();
        let mut right = Vector3::zeros();
        for (sample, value) in self.values.iter().enumerate() {
            let row = row(sample);
            normal += row * row.transpose();
            right += row * *value;
        }
        // At a constant rate time and angle are proportional.
        let negligible = f64::EPSILON.sqrt() * normal.trace();
        let of = normal.svd(true, true).solve(&right, negligible).unwrap_or_default();
        (0..self.values.len()).map(|sample| of.dot(&row(sample))).collect()
    }

    /// The time constant of the exponential smoothing that predicts the differences best, in samples.
    ///
    /// Each stretch of the run counts by the log-likelihood that it loses with a time constant, but by at most [`MOST_LOST`].
    fn time_constant(&self) -> f64 {
        let longest = self.values.len().div_ceil(STRETCHES) as f64;
        let constants = std::iter::successors(Some(SHORTEST), |constant| Some(constant * FINENESS));
        let constants: Vec<f64> = constants.take_while(|constant| *constant <= longest).collect();
        let misfits: Vec<Vec<f64>> =
            constants.par_iter().map(|constant| self.misfits(*constant)).collect();
        let least = misfits.iter().cloned().reduce(|least, others| {
            least.iter().zip(&others).map(|(least, other)| least.min(*other)).collect()
        });
        let Some(least) = least else { return SHORTEST };
        let lost = |misfits: &Vec<f64>| -> f64 {
            misfits.iter().zip(&least).map(|(misfit, least)| (misfit - least).min(MOST_LOST)).sum()
        };
        let lost: Vec<f64> = misfits.iter().map(lost).collect();
        let best =
            lost.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |best| best.0);
        // The vertex of the parabola through the best and its neighbors.
        let place = match (best.checked_sub(1).map(|before| lost[before]), lost.get(best + 1)) {
            (Some(before), Some(after)) => {
                let bend = before - 2.0 * lost[best] + after;
                if bend > 0.0 { 0.5 * (before - after) / bend } else { 0.0 }
            }
            _ => 0.0,
        };
        constants.get(best).map_or(SHORTEST, |constant| constant * FINENESS.powf(place))
    }

    /// The negative log-likelihoods of the differences in each stretch, which has its own noise level, up to a constant.
    fn misfits(&self, constant: f64) -> Vec<f64> {
        let keep = kept(constant);
        let mut predicted = self.values.first().copied().unwrap_or_default();
        let length = self.values.len().div_ceil(STRETCHES).max(1);
        let of_stretch = |(values, linked): (&[f64], &[bool])| {
            let mut sum = 0.0;
            for (value, linked) in values.iter().zip(linked) {
                if !linked {
                    predicted = *value;
                }
                let error = value - predicted;
                sum += error * error;
                predicted = value - keep * error;
            }
            let count = values.len() as f64;
            0.5 * count * (sum / count).max(f64::MIN_POSITIVE).ln()
        };
        self.values.chunks(length).zip(self.linked.chunks(length)).map(of_stretch).collect()
    }

    /// The minimum of `Σ (d - s)² + τ² Σ (Δs)²`.
    pub(crate) fn smoothed_over(&self, constant: f64) -> Vec<f64> {
        let link = |sample: usize| {
            if self.linked.get(sample).is_some_and(|linked| *linked) {
                constant * constant
            } else {
                0.0
            }
        };
        // Thomas algorithm: the matrix is tridiagonal, symmetric and diagonally dominant.
        let mut eliminated: Vec<(f64, f64)> = Vec::with_capacity(self.values.len());
        for (sample, value) in self.values.iter().enumerate() {
            let (before, after) = (link(sample), link(sample + 1));
            let (ratio, reduced) = eliminated.last().copied().unwrap_or_default();
            let pivot = 1.0 + before + after - before * ratio;
            eliminated.push((after / pivot, (value + before * reduced) / pivot));
        }
        let mut next = 0.0;
        for (ratio, reduced) in eliminated.iter_mut().rev() {
            next = *reduced + *ratio * next;
            *reduced = next;
        }
        eliminated.into_iter().map(|(_, smooth)| smooth).collect()
    }
}

/// The share of an error of prediction that the exponential smoothing with this time constant takes for noise, `θ` with
/// `θ + 1/θ = 2 + 1/τ²` (Muth 1960).
fn kept(constant: f64) -> f64 {
    let half = 1.0 + 0.5 / (constant * constant);
    1.0 / (half + (half * half - 1.0).sqrt())
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64;
    use rins_testing::assert_close;

    use super::*;

    /// Standard deviation of the readings \[rad\].
    const WHITE: f64 = 1e-5;

    /// The noise of a run: of each reading, and the angle random walk of the gyro \[rad\].
    fn noise(constant: f64, seed: u64) -> (Vec<f64>, Vec<f64>) {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
        let read = (0..20_000).map(|_| WHITE * draw()).collect();
        let mut walk = 0.0;
        let walked = (0..20_000).map(|_| {
            walk += WHITE / constant * draw();
            walk
        });
        (read, walked.collect())
    }

    struct Table {
        times: Vec<f64>,
        angles: Vec<f64>,
    }

    impl Table {
        /// Forward and back.
        fn new() -> Self {
            let times: Vec<f64> = (1..=20_000).map(|sample| 0.01 * f64::from(sample)).collect();
            let angles = times.iter().map(|time| 0.2 * (100.0 - (time - 100.0).abs())).collect();
            Self { times, angles }
        }

        fn differences(&self, values: Vec<f64>) -> Differences<'_> {
            let linked = (0..values.len()).map(|sample| sample > 0).collect();
            Differences { times: &self.times, readings: &self.angles, values, linked }
        }
    }

    fn minus(one: &[f64], other: &[f64]) -> Vec<f64> {
        one.iter().zip(other).map(|(one, other)| one - other).collect()
    }

    #[test]
    fn time_constant_is_the_ratio_of_the_noise_levels() {
        let table = Table::new();
        for seed in 0..8 {
            for constant in [1.0, 8.0, 60.0] {
                let (read, walk) = noise(constant, seed);
                let mut values = minus(&read, &walk);
                let found = table.differences(values.clone()).time_constant() / constant;
                assert!((0.6..1.7).contains(&found), "{constant} samples, seed {seed}: {found}");
                // A slip counts in one stretch.
                for value in &mut values[7000..] {
                    *value += 1000.0 * WHITE;
                }
                let found = table.differences(values).time_constant() / constant;
                assert!((0.6..1.7).contains(&found), "{constant} samples, seed {seed}: {found}");
            }
        }
    }

    /// A function of the table rate with any slope explains neither what remains of the gyro nor what remains of the readings.
    #[test]
    fn error_of_the_rate_is_uncorrelated_with_what_remains() {
        let table = Table::new();
        let rates = |angles: &[f64]| -> Vec<f64> {
            angles.windows(2).map(|pair| pair[1] - pair[0]).collect()
        };
        let cosine = |one: &[f64], other: &[f64]| {
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            dot(one, other) / (dot(one, one) * dot(other, other)).sqrt()
        };
        for (constant, seed) in [(1.0, 1), (4.0, 2), (30.0, 3)] {
            let (read, walk) = noise(constant, seed);
            let values = minus(&read, &walk);
            let smooth = &table.differences(values).smoothed(None)[1..];
            // The angle is that of the gyro, whose error is the walk, and the smoothed difference.
            let error: Vec<f64> =
                walk.iter().zip(smooth).map(|(walk, smooth)| walk + smooth).collect();
            let of_gyro = minus(&rates(&walk), &rates(&error));
            // Twenty thousand samples, of which so many are independent.
            let bound = 4.0 * (constant / 20_000.0).sqrt();
            let found = cosine(&rates(&error), &of_gyro);
            assert!(found.abs() < bound, "{constant} samples: {found}");
            // An angle that follows one of the two sensors has the noise of that sensor.
            let follows = cosine(&rates(&read), &minus(&rates(&walk), &rates(&read)));
            assert!(follows < -0.5, "{constant} samples: {follows}");
        }
    }

    #[test]
    fn bias_and_scale_error_of_the_gyro_remain() {
        let table = Table::new();
        let values: Vec<f64> = table
            .times
            .iter()
            .zip(&table.angles)
            .map(|(time, angle)| 0.3 + 0.01 * time - 0.02 * angle)
            .collect();
        let smooth = table.differences(values.clone()).smoothed(Some(50.0));
        for (smooth, value) in smooth[1..].iter().zip(&values) {
            assert_close!(*smooth, *value, 1e-9);
        }
        assert_close!(smooth[0], 0.3, 1e-6);
    }
}
