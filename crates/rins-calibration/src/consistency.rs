//! Whether the innovations are what the model says: white, and of unit variance.

use nalgebra::SVector;
use rustfft::{FftPlanner, num_complex::Complex};
use statrs::function::erf::erfc;

use crate::filter::MEASUREMENTS;

/// What the whitened innovations say of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Consistency {
    /// The mean normalised innovation squared.
    pub nis_mean: f64,
    /// What it should be: the number of channels, on average where some epochs have fewer.
    pub nis_dof: f64,
    /// How probable a mean so far off is, if the model is right (two-sided).
    pub nis_p: f64,
    /// How probable innovations so far from white are, if the model is right; channels for which too
    /// much noise was claimed are left out.
    pub whiteness_p: f64,
    /// For each channel the RMS of its whitened innovation; 1 if the model is right.
    pub channel_rms: [f64; MEASUREMENTS],
    /// For each channel the largest distance of its cumulative periodogram from a straight line.
    pub periodogram_distance: [f64; MEASUREMENTS],
}

/// What the two tests say together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The innovations are what the model says they should be.
    Fits,
    /// They are smaller: more noise was claimed than there is, and the sigmas are too large.
    NoiseOverstated,
    /// They are larger or coloured: there is more in the data than in the model, and the sigmas are too small.
    Misfit,
}

/// A channel whose innovations are smaller than this share of what was claimed is not tested for
/// whiteness: a filter that is told of too much noise colours them itself.
const OVERSTATED: f64 = 0.8;

impl Consistency {
    /// The significance below which a test says no.
    pub const SIGNIFICANCE: f64 = 0.005;

    /// The consistency of whitened innovations in order of time; `None` if there are fewer than 8.
    ///
    /// A channel that is zero is one that this epoch does not have, and counts for nothing.
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
        // The sum is chi-squared with so many degrees of freedom that it is normal.
        let off = (sum - count * dof) / (2.0 * count * dof).sqrt();
        let mut channel_rms = [0.0; MEASUREMENTS];
        let mut distance = [0.0; MEASUREMENTS];
        let mut least_p = 1.0_f64;
        for (channel, series) in series.iter().enumerate() {
            // One of a few epochs only tells nothing of its colour.
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

    /// What the tests say together.
    pub fn verdict(&self) -> Verdict {
        let size_is_off = self.nis_p < Self::SIGNIFICANCE;
        let too_large = self.nis_mean > self.nis_dof;
        if self.whiteness_p < Self::SIGNIFICANCE || (size_is_off && too_large) {
            Verdict::Misfit
        } else if size_is_off {
            Verdict::NoiseOverstated
        } else {
            Verdict::Fits
        }
    }
}

/// Bartlett's test: the largest distance of the normalised cumulative periodogram from that of
/// white noise, and the probability of a larger one (Kolmogorov's distribution).
///
/// The mean is left in as the lowest frequency, since a constant innovation is no noise either.
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

    /// How many of 400 innovation sequences a test at 5 % calls inconsistent.
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

    /// A filter whose noise was overstated colours its innovations itself: small ones are not held against the model for
    /// their colour, those of nearly the size that was claimed are.
    #[test]
    fn colour_of_innovations_that_are_too_small_is_no_misfit() {
        for (size, verdict) in [(0.5, Verdict::NoiseOverstated), (0.9, Verdict::Misfit)] {
            let mut innovations = white(5);
            for (index, innovation) in innovations.iter_mut().enumerate() {
                // A line of unit power.
                innovation[4] = size * std::f64::consts::SQRT_2 * (0.02 * index as f64).sin();
            }
            let consistency = Consistency::of(&innovations).unwrap();
            assert_close!(consistency.channel_rms[4], size, 0.02);
            assert!(consistency.periodogram_distance[4] > 0.9, "{consistency:?}");
            assert_eq!(consistency.verdict(), verdict, "{consistency:?}");
        }
    }

    /// All power at one of `n` frequencies, the `k`th: the step of the cumulative periodogram is `k/n` above the line of white
    /// noise or `1 - (k + 1)/n` below it, whichever is more.
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
        // Two kinds of runs, one after the other.
        innovations.extend(white(6));
        let consistency = Consistency::of(&innovations).unwrap();
        assert_eq!((consistency.nis_dof, consistency.verdict()), (5.5, Verdict::Fits));
    }

    #[test]
    fn too_few_innovations_say_nothing() {
        assert_eq!(Consistency::of(&white(1)[..7]), None);
    }
}
