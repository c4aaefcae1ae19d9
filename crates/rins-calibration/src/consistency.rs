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
    /// The p-value of the whiteness test, without the channels whose noise is overstated.
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

/// The RMS of whitened innovations below which a channel is not tested for whiteness: a filter with overstated noise colors
/// its innovations.
const OVERSTATED: f64 = 0.8;

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
            let (largest, p) = cumulative_periodogram(series);
            distance[channel] = largest;
            if channel_rms[channel] > OVERSTATED {
                least_p = least_p.min(p);
            }
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

/// Bartlett's test: the largest distance of the normalized cumulative periodogram from that of white noise, and its p-value
/// (Kolmogorov's distribution).
///
/// The mean is included as the lowest frequency, since a constant innovation is not noise either.
fn cumulative_periodogram(series: &[f64]) -> (f64, f64) {
    let mut spectrum: Vec<Complex<f64>> = series.iter().map(|&x| Complex::new(x, 0.0)).collect();
    FftPlanner::new().plan_fft_forward(spectrum.len()).process(&mut spectrum);
    let power: Vec<f64> = spectrum[..spectrum.len() / 2].iter().map(Complex::norm_sqr).collect();
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

    /// A filter with overstated noise colors its innovations: small innovations are not a misfit because of their color,
    /// those of nearly the stated size are.
    #[test]
    fn colour_of_innovations_that_are_too_small_is_no_misfit() {
        for (size, verdict) in [(0.5, Verdict::NoiseOverstated), (0.9, Verdict::Misfit)] {
            let mut innovations = white(5);
            for (index, innovation) in innovations.iter_mut().enumerate() {
                // A spectral line of unit power.
                innovation[4] = size * std::f64::consts::SQRT_2 * (0.02 * index as f64).sin();
            }
            let consistency = Consistency::of(&innovations).unwrap();
            assert_close!(consistency.channel_rms[4], size, 0.02);
            assert!(consistency.periodogram_distance[4] > 0.9, "{consistency:?}");
            assert_eq!(consistency.verdict(), verdict, "{consistency:?}");
        }
    }

    /// All power is at the `k`th of `n` frequencies: the step of the cumulative periodogram is `k/n` above the line of white
    /// noise or `1 - (k + 1)/n` below it, whichever is larger.
    #[test]
    fn a_single_line_is_as_far_from_white_as_its_frequency_says() {
        const SAMPLES: usize = 64;
        let frequencies = SAMPLES as f64 / 2.0;
        for k in [0, 1, 7, 15, 16, 24, 31] {
            let line = |at: usize| (std::f64::consts::TAU * (k * at) as f64 / SAMPLES as f64).cos();
            let (distance, _) = cumulative_periodogram(&(0..SAMPLES).map(line).collect::<Vec<_>>());
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
