//! Noise with more large values than a normal distribution has, sample by sample: means over epochs hide it.

use std::ops::Range;

use rins_bayes::ln_tail;
use rins_estimation::{Fit, Noise};
use rins_terms::catalogue;

use crate::case::Case;
use crate::criticism::residuals::{ABOUT_AXIS, residuals};
use crate::criticism::structure::Structure;
use crate::criticism::unexplained::Unexplained;
use crate::diagnosis::FALSE_ALARMS;
use crate::generic::disturbance::CHANNELS;
use crate::proposal::jolt;

/// Within so many samples the spread is taken to be one: noise that grows with the rate has no heavy tails.
const BLOCK: usize = 256;

/// The skewness of the kurtosis of a block of differences of normal samples.
const SKEWNESS: f64 = 0.97;

/// A smaller excess of the kurtosis is of no consequence, however sure it is.
const SLIGHT: f64 = 0.2;

/// An encoder that repeats more than one reading in so many is too coarse to show noise.
const MOST_REPEATS: usize = 20;

/// The six sensors of a run.
const SENSORS: f64 = 6.0;

impl Case<'_> {
    /// The sensor of a run whose noise has the heaviest tails, if they are significant; `without` these samples.
    pub(crate) fn tails(
        &self,
        fit: &Fit,
        run: usize,
        without: &[Range<usize>],
    ) -> Option<Unexplained> {
        let recording = &self.runs[run].recording;
        let mut all = residuals(&self.runs[run], fit, run);
        self.even_out(&mut all[ABOUT_AXIS], fit, run);
        // An encoder that often reads the same again shows its least bit, and no noise.
        let angles = recording.table_angle.as_deref().unwrap_or_default();
        #[expect(clippy::float_cmp, reason = "a repeated reading is the same to the last bit")]
        let repeats = |samples: Range<usize>| {
            let read = angles.get(samples).unwrap_or_default();
            read.windows(2).filter(|pair| pair[0] == pair[1]).count() > BLOCK / MOST_REPEATS
        };
        let jolts = jolted(fit, run);
        let jolted = |samples: &Range<usize>| {
            let within = |jolt: &Range<usize>| jolt.start < samples.end && samples.start < jolt.end;
            jolts.iter().chain(without).any(within)
        };
        let excesses = all.iter().enumerate().map(|(channel, residuals)| {
            let counts = |samples: Range<usize>| {
                !jolted(&samples) && (channel != ABOUT_AXIS || !repeats(samples))
            };
            (channel, excess(residuals, counts))
        });
        let (channel, (excess, ln_p)) = excesses
            .filter(|(channel, _)| !self.rounding.is_coarse(run, *channel))
            .min_by(|a, b| a.1.1.total_cmp(&b.1.1))
            .filter(|(_, (e, _))| *e > SLIGHT)?;
        let tests = SENSORS * self.runs.len() as f64;
        let one = Unexplained {
            run,
            channel: CHANNELS[channel],
            structure: Structure::Tails,
            of: None,
            ln_p: ln_p + tests.ln(),
            amplitude: None,
            worst: Vec::new(),
        };
        (excess.is_finite() && one.ln_p < FALSE_ALARMS.ln()).then_some(one)
    }

    /// Takes from what is left about the spin axis that jittering time stamps make it scatter the more the faster the table
    /// turns, within a block too.
    fn even_out(&self, about_axis: &mut [f64], fit: &Fit, run: usize) {
        let Noise { imu, encoder, .. } = &fit.noise[run];
        if imu.jitter <= 0.0 {
            return;
        }
        let turns = fit.linear[run].track().angles().windows(2).map(|pair| pair[1] - pair[0]);
        let samples = &self.runs[run].recording.increments;
        for ((residual, turn), sample) in about_axis.iter_mut().zip(turns).zip(samples) {
            // As angles: a gyro's own noise, that of two readings, and how far the table turns meanwhile.
            let steady = imu.gyro.white.powi(2) * sample.interval + 2.0 * encoder.powi(2);
            let jitter = 2.0 * (imu.jitter * turn / sample.interval).powi(2);
            *residual *= (steady / (steady + jitter)).sqrt();
        }
    }
}

/// The samples about the moments at which the base of a run tips over.
pub(crate) fn jolted(fit: &Fit, run: usize) -> Vec<Range<usize>> {
    let linear = &fit.linear[run];
    let steps = fit.models[run].terms.iter();
    steps
        .filter(|chosen| chosen.term.is(&catalogue::BASE_TILT_STEP))
        .map(|step| jolt::around(step, linear.track(), linear.mean_epoch()))
        .collect()
}

/// By how much the kurtosis of white noise is more than a normal distribution's, and the logarithm of the chance of that.
///
/// It is taken of the differences of neighbours, in which what is slow is nothing: they have half the excess.
///
/// Blocks of samples that do not `count` are left out.
fn excess(residuals: &[f64], counts: impl Fn(Range<usize>) -> bool) -> (f64, f64) {
    let differences: Vec<f64> = residuals.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let of = |(block, values)| counts(block * BLOCK..(block + 1) * BLOCK).then_some(values);
    let blocks: Vec<&[f64]> = differences.chunks_exact(BLOCK).enumerate().filter_map(of).collect();
    let count = blocks.len();
    let n = BLOCK as f64;
    // The mean of it over normal samples of this size, whose neighbours correlate by -1/2: 3 - 6/n without that.
    let normal = 3.0 - 9.0 / n;
    let sum: f64 = blocks.iter().map(|block| kurtosis(block) - normal).sum();
    let mean = sum / count as f64;
    // That of n normal samples, Fisher (1930). Neighbouring differences share a value: their squares correlate by 1/4, their
    // fourth powers' part by 1/16.
    let of_block = 24.0 * n * (n - 2.0) * (n - 3.0) / ((n + 1.0).powi(2) * (n + 3.0) * (n + 5.0));
    let sigma = (of_block * (1.0 + 2.0 / 16.0) / count as f64).sqrt();
    let size = mean / sigma;
    let ln_p = if size > 0.0 { ln_chance(size, SKEWNESS / (count as f64).sqrt()) } else { 0.0 };
    (2.0 * mean, ln_p)
}

/// The logarithm of the chance that something that is nearly normal, of this skewness, exceeds `size` sigmas: the first term of
/// Edgeworth's series.
fn ln_chance(size: f64, skewness: f64) -> f64 {
    let normal = ln_tail(size * size, 1) - 2.0_f64.ln();
    let ln_density = -0.5 * (size * size + std::f64::consts::TAU.ln());
    let more = skewness / 6.0 * (size * size - 1.0) * (ln_density - normal).exp();
    (normal + more.max(0.0).ln_1p()).min(0.0)
}

fn kurtosis(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let moment = |power: i32| values.iter().map(|x| (x - mean).powi(power)).sum::<f64>() / n;
    moment(4) / moment(2).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal, StudentT};
    use rand_pcg::Pcg64;

    fn noise(distribution: impl Distribution<f64>, seed: u64) -> Vec<f64> {
        distribution.sample_iter(Pcg64::seed_from_u64(seed)).take(20_000).collect()
    }

    /// The chance of normal noise is what it says: below a tenth in a tenth of all series, and far out too.
    #[test]
    fn normal_noise_is_as_rare_as_it_says() {
        let all: Vec<f64> =
            (0..20_000).map(|seed| excess(&noise(StandardNormal, seed), |_| true).1).collect();
        for (chance, within) in [(0.1, 1850..2150), (0.003, 36..72)] {
            let share = all.iter().filter(|ln_p| **ln_p < f64::ln(chance)).count();
            assert!(within.contains(&share), "{chance}: {share} of {}", all.len());
        }
    }

    #[test]
    fn heavy_tails_are_told_with_their_excess() {
        // Student's t of ten degrees: 6 / (10 - 4).
        let (found, ln_p) = excess(&noise(StudentT::new(10.0).unwrap(), 1), |_| true);
        // Blocks know their own spread, and less of the tails.
        assert!((0.6..1.1).contains(&found) && ln_p < -50.0, "{found} {ln_p}");
    }

    #[test]
    fn noise_that_grows_has_no_tails() {
        let mut growing = noise(StandardNormal, 2);
        let n = growing.len() as f64;
        for (place, value) in growing.iter_mut().enumerate() {
            *value *= 1.0 + 4.0 * place as f64 / n;
        }
        let (found, _) = excess(&growing, |_| true);
        assert!(found < SLIGHT, "{found}");
    }
}
