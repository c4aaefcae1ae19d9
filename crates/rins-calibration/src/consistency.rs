//! Consistency of the innovations with the model: whiteness and unit variance.

use nalgebra::SVector;
use rustfft::{FftPlanner, num_complex::Complex};
use statrs::function::erf::erfc;

use crate::filter::MEASUREMENTS;

/// The consistency of whitened innovations with the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Consistency {
    /// The mean normalized innovation squared (NIS).
    pub nis_mean: f64,
    /// Its expectation: the number of channels, averaged over the epochs if some have fewer.
    pub nis_dof: f64,
    /// The p-value of the mean NIS (two-sided).
    pub nis_p: f64,
    /// The p-value of the whiteness test. A channel whose RMS is less than 1 is colored only if its spectral density is above 1 in a
    /// band of frequencies: overstated noise colors innovations without that.
    pub whiteness_p: f64,
    /// The RMS of the whitened innovation of each channel; 1 if the model is correct.
    pub channel_rms: [f64; MEASUREMENTS],
    /// The largest distance of the cumulative periodogram of each channel from a straight line.
    pub periodogram_distance: [f64; MEASUREMENTS],
}

/// The joint result of the two tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The innovations are consistent with the model.
    Fits,
    /// The innovations are too small: the noise is overstated, and the sigmas are too large.
    NoiseOverstated,
    /// The innovations are too large or colored: there are unmodeled effects, and the sigmas are too small.
    Misfit,
}

impl Consistency {
    /// The p-value below which a test rejects the model.
    pub const SIGNIFICANCE: f64 = 0.005;

    /// The consistency of whitened innovations in order of time; `None` if there are fewer than 8.
    ///
    /// A channel of zero is absent in this epoch and is ignored.
    pub fn of(innovations: &[SVector<f64, MEASUREMENTS>]) -> Option<Self> {
        const FEWEST: usize = 8;
        if innovations.len() < FEWEST {
            return None;
        }
        let count = innovations.len() as f64;
        let sum: f64 = innovations.iter().map(SVector::norm_squared).sum();
        let series = |channel: usize| -> Vec<f64> {
            innovations.iter().map(|nu| nu[channel]).filter(|nu| *nu != 0.0).collect()
        };
        let series: [Vec<f64>; MEASUREMENTS] = std::array::from_fn(series);
        let channels = series.iter().filter(|series| !series.is_empty()).count() as f64;
        let dof = series.iter().map(|series| series.len() as f64).sum::<f64>() / count;
        // The sum is chi-squared with so many degrees of freedom that it is approximately normal.
        let off = (sum - count * dof) / (2.0 * count * dof).sqrt();
        let mut channel_rms = [0.0; MEASUREMENTS];
        let mut distance = [0.0; MEASUREMENTS];
        let mut least_p = 1.0_f64;
        for (channel, series) in series.iter().enumerate() {
            // A channel in few epochs has no meaningful spectrum.
            if series.len() < FEWEST {
                continue;
            }
            let square: f64 = series.iter().map(|nu| nu * nu).sum();
            channel_rms[channel] = (square / series.len() as f64).sqrt();
            let power = periodogram(series);
            let (largest, p) = cumulative_periodogram(&power);
            distance[channel] = largest;
            // Overstated noise colors innovations, too; their spectral density is then nowhere above one.
            let is_small = channel_rms[channel] < 1.0;
            let p = if is_small { p.max(excess(&power)) } else { p };
            least_p = least_p.min(p);
        }
        Some(Self {
            nis_mean: sum / count,
            nis_dof: dof,
            nis_p: erfc(off.abs() / std::f64::consts::SQRT_2),
            whiteness_p: (least_p * channels).min(1.0),
            channel_rms,
            periodogram_distance: distance,
        })
    }

    /// Whether the whiteness test rejects the innovations.
    pub fn is_colored(&self) -> bool {
        self.whiteness_p < Self::SIGNIFICANCE
    }

    /// Whether the NIS test rejects the innovations because they are larger than the model predicts.
    pub fn is_too_large(&self) -> bool {
        self.nis_p < Self::SIGNIFICANCE && self.nis_mean > self.nis_dof
    }

    /// The joint result of the tests.
    pub fn verdict(&self) -> Verdict {
        if self.is_colored() || self.is_too_large() {
            Verdict::Misfit
        } else if self.nis_p < Self::SIGNIFICANCE {
            Verdict::NoiseOverstated
        } else {
            Verdict::Fits
        }
    }
}

/// The periodogram from frequency zero on: 1 in the mean for white noise of unit variance.
fn periodogram(series: &[f64]) -> Vec<f64> {
    let mut spectrum: Vec<Complex<f64>> = series.iter().map(|&x| Complex::new(x, 0.0)).collect();
    FftPlanner::new().plan_fft_forward(spectrum.len()).process(&mut spectrum);
    let count = series.len() as f64;
    spectrum[..series.len() / 2].iter().map(|line| line.norm_sqr() / count).collect()
}

/// The p-value of the hypothesis that the spectral density is nowhere above 1.
///
/// The largest sum of (periodogram - 1) over a band is, for white noise of unit variance, the largest rise of a Brownian motion above its
/// past minimum. This has the distribution of the largest distance of a Brownian motion from zero (Lévy's theorem).
fn excess(power: &[f64]) -> f64 {
    let (mut rise, mut largest) = (0.0_f64, 0.0_f64);
    for power in power {
        rise = (rise + power - 1.0).max(0.0);
        largest = largest.max(rise);
    }
    brownian_maximum(largest / (power.len() as f64).sqrt())
}

/// The probability that a Brownian motion is farther than `x` from zero within unit time.
fn brownian_maximum(x: f64) -> f64 {
    // Below this the probability is 1 to five digits and the series converges slowly.
    if x < 0.3 {
        return 1.0;
    }
    let tail = |x: f64| 0.5 * erfc(x / std::f64::consts::SQRT_2);
    let term = |k: i32| f64::from(1 - 2 * (k % 2)) * tail(f64::from(2 * k + 1) * x);
    (4.0 * (0..50).map(term).sum::<f64>()).clamp(0.0, 1.0)
}

/// Bartlett's test: the largest distance of the normalized cumulative periodogram from that of white noise, and its p-value
/// (Kolmogorov's distribution).
///
/// The mean is included as the lowest frequency, since a constant innovation is not noise either.
fn cumulative_periodogram(power: &[f64]) -> (f64, f64) {
    let total: f64 = power.iter().sum();
    if total <= 0.0 {
        return (1.0, 0.0);
    }
    let count = power.len() as f64;
    let mut sum = 0.0;
    let mut largest = 0.0_f64;
    for (index, power) in power.iter().enumerate() {
        let expected = index as f64 / count;
        largest = largest.max((sum / total - expected).abs());
        sum += power;
        largest = largest.max((sum / total - expected - 1.0 / count).abs());
    }
    (largest, kolmogorov(largest * count.sqrt()))
}

/// The probability that Kolmogorov's statistic exceeds `x`.
fn kolmogorov(x: f64) -> f64 {
    // Below this the probability is 1 to ten digits and the series converges slowly.
    if x < 0.2 {
        return 1.0;
    }
    let mut sum = 0.0;
    let mut sign = 1.0;
    for term in 1..=100 {
        let term = f64::from(term);
        let part = (-2.0 * term * term * x * x).exp();
        sum += sign * part;
        sign = -sign;
        if part < 1e-18 {
            break;
        }
    }
    (2.0 * sum).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64;
    use rins_testing::assert_close;

    type Innovations = Vec<SVector<f64, MEASUREMENTS>>;

    fn white(seed: u128) -> Innovations {
        let mut random = Pcg64::new(7, seed);
        (0..2000).map(|_| SVector::from_fn(|_, _| StandardNormal.sample(&mut random))).collect()
    }

    /// The numbers of inconsistent results of the two tests at 5 % for 400 innovation sequences.
    fn refused(spoil: fn(usize, &mut SVector<f64, MEASUREMENTS>)) -> (usize, usize) {
        let mut refused = (0, 0);
        for seed in 0..400 {
            let mut innovations = white(seed);
            for (index, innovation) in innovations.iter_mut().enumerate() {
                spoil(index, innovation);
            }
            let consistency = Consistency::of(&innovations).unwrap();
            refused.0 += usize::from(consistency.nis_p < 0.05);
            refused.1 += usize::from(consistency.whiteness_p < 0.05);
        }
        refused
    }

    #[test]
    fn white_innovations_are_refused_as_often_as_claimed() {
        let (nis, whiteness) = refused(|_, _| ());
        // 20 of 400 are expected; 4σ is 17. The whiteness test, over six channels, is conservative.
        assert!((4..=37).contains(&nis), "{nis} of 400 by NIS");
        assert!(whiteness <= 37, "{whiteness} of 400 by whiteness");
        assert!(whiteness >= 4, "{whiteness} of 400: the test has no teeth");
    }

    #[test]
    fn too_large_innovations_fail_the_nis_test_and_stay_white() {
        let (nis, whiteness) = refused(|_, innovation| *innovation *= 1.05);
        assert_eq!(nis, 400);
        assert!(whiteness <= 37, "{whiteness} of 400 by whiteness");
    }

    #[test]
    fn a_slow_line_in_one_channel_fails_the_whiteness_test() {
        let (_, whiteness) =
            refused(|index, innovation| innovation[4] += 0.6 * (index as f64 / 50.0).sin());
        assert_eq!(whiteness, 400);
    }

    #[test]
    fn a_constant_in_one_channel_fails_the_whiteness_test() {
        let (_, whiteness) = refused(|_, innovation| innovation[1] += 0.3);
        assert_eq!(whiteness, 400);
    }

    #[test]
    fn kolmogorovs_distribution_has_its_tabled_points() {
        // The 5 % and 1 % points of Smirnov's table.
        assert_close!(kolmogorov(1.3581), 0.05, 1e-5);
        assert_close!(kolmogorov(1.6276), 0.01, 1e-5);
    }

    #[test]
    fn verdicts_tell_too_much_noise_from_a_misfit() {
        let verdict = |spoil: fn(usize, &mut SVector<f64, MEASUREMENTS>)| {
            let mut innovations = white(5);
            for (index, innovation) in innovations.iter_mut().enumerate() {
                spoil(index, innovation);
            }
            Consistency::of(&innovations).unwrap().verdict()
        };
        assert_eq!(verdict(|_, _| ()), Verdict::Fits);
        assert_eq!(verdict(|_, innovation| *innovation *= 0.9), Verdict::NoiseOverstated);
        assert_eq!(verdict(|_, innovation| *innovation *= 1.1), Verdict::Misfit);
        assert_eq!(verdict(|_, innovation| innovation[1] += 0.5), Verdict::Misfit);
    }

    /// The innovations of a filter of a random walk for its position, in all channels: measurements have the variance `part` of that
    /// which the filter assumes, the position moves by `step` per sample, and `line` is added to the measurements.
    fn filtered(seed: u128, part: f64, step: f64, line: f64) -> Innovations {
        let mut random = Pcg64::new(9, seed);
        let mut draw = move || -> f64 { StandardNormal.sample(&mut random) };
        let mut channels = [(0.0_f64, 0.0_f64, 1.0_f64); MEASUREMENTS];
        let mut sample = |index: usize| {
            SVector::from_fn(|channel, _| {
                let (position, estimate, variance) = &mut channels[channel];
                *position += step * draw();
                *variance += step * step;
                let added = line * (0.05 * index as f64).sin();
                let innovation = *position + added + part.sqrt() * draw() - *estimate;
                let sum = *variance + 1.0;
                *estimate += *variance / sum * innovation;
                *variance /= sum;
                innovation / sum.sqrt()
            })
        };
        (0..2000).map(&mut sample).collect()
    }

    /// A filter with overstated noise colors its innovations: that is no misfit, however much it is overstated. An effect above the
    /// stated noise is one.
    #[test]
    fn color_by_overstated_noise_is_no_misfit_and_a_line_is() {
        let verdicts = |part: f64, line: f64| -> [usize; 3] {
            let mut counts = [0; 3];
            for seed in 0..60 {
                let step = [0.01, 0.1, 1.0][seed as usize % 3];
                let innovations = filtered(seed, part, step, line);
                let verdict = Consistency::of(&innovations).unwrap().verdict();
                counts[verdict as usize] += 1;
            }
            counts
        };
        let exact = verdicts(1.0, 0.0);
        assert!(exact[0] >= 56, "{exact:?}");
        for part in [0.03, 0.3, 0.7, 0.9] {
            let small = verdicts(part, 0.0);
            assert!(small[2] <= 3, "{part}: {small:?}");
            assert!(part > 0.8 || small[1] >= 38, "{part}: {small:?}");
        }
        for part in [0.03, 0.7, 1.0] {
            let spoilt = verdicts(part, 2.0);
            assert!(spoilt[2] >= 38, "{part}: {spoilt:?}");
        }
    }

    #[test]
    fn brownian_maximum_has_its_known_points() {
        // Four times the upper tail of the normal distribution; for x = 1 less four times that beyond 3.
        for (x, p) in [(2.241_403, 0.05), (2.807_034, 0.01), (1.0, 0.629_2)] {
            assert_close!(brownian_maximum(x), p, 2e-4);
        }
        assert_close!(brownian_maximum(0.301), 1.0, 1e-4);
    }

    /// All power is at the `k`th of `n` frequencies: the step of the cumulative periodogram is `k/n` above the line of white
    /// noise or `1 - (k + 1)/n` below it, whichever is larger.
    #[test]
    fn a_single_line_is_as_far_from_white_as_its_frequency_says() {
        const SAMPLES: usize = 64;
        let frequencies = SAMPLES as f64 / 2.0;
        for k in [0, 1, 7, 15, 16, 24, 31] {
            let line = |at: usize| (std::f64::consts::TAU * (k * at) as f64 / SAMPLES as f64).cos();
            let (distance, _) =
                cumulative_periodogram(&periodogram(&(0..SAMPLES).map(line).collect::<Vec<_>>()));
            let k = k as f64;
            let want = (k / frequencies).max(1.0 - (k + 1.0) / frequencies);
            assert_close!(distance, want, 1e-12);
        }
    }

    #[test]
    fn a_channel_that_is_not_there_counts_for_nothing() {
        let mut innovations = white(5);
        for innovation in &mut innovations {
            innovation[2] = 0.0;
        }
        let consistency = Consistency::of(&innovations).unwrap();
        assert_eq!((consistency.nis_dof, consistency.verdict()), (5.0, Verdict::Fits));
        // Two kinds of epochs in succession.
        innovations.extend(white(6));
        let consistency = Consistency::of(&innovations).unwrap();
        assert_eq!((consistency.nis_dof, consistency.verdict()), (5.5, Verdict::Fits));
    }

    #[test]
    fn too_few_innovations_say_nothing() {
        assert_eq!(Consistency::of(&white(1)[..7]), None);
    }
}
