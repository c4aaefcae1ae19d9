//! The errors of one parameter or combination over the runs, compared with their sigmas.

use statrs::distribution::{ContinuousCDF, Normal};

use super::ecdf::{EcdfBand, POINTS, differences};
use super::interval::{clopper_pearson, mean_square_bounds};

/// The probabilities of the central intervals whose coverage is counted.
pub const COVERAGES: [f64; 3] = [0.68, 0.95, 0.997];

/// Half the widths of these intervals, in sigmas.
const WITHIN: [f64; 3] = [0.994457883, 1.959963985, 2.967737925];

/// The level of confidence intervals.
const CONFIDENCE: f64 = 0.95;

/// The coverage of a central interval of the posteriors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coverage {
    /// The nominal coverage: the probability of the interval.
    pub nominal: f64,
    /// The fraction of the intervals that contain the true value.
    pub fraction: f64,
    /// The 95 % Clopper-Pearson interval of the fraction.
    pub interval_95: [f64; 2],
}

/// The errors of one quantity over the runs.
#[derive(Clone, Debug, PartialEq)]
pub struct QuantityStatistics {
    /// The mean of the true values.
    pub mean_truth: f64,
    /// The bias: the mean of estimate minus truth.
    pub mean_error: f64,
    /// The standard error of the bias.
    pub mean_error_sigma: f64,
    /// The standard deviation of the errors.
    pub error_std: f64,
    /// The root mean square of the posterior sigmas.
    pub sigma_rms: f64,
    /// The root mean square of the prior sigmas.
    pub prior_sigma_rms: f64,
    /// The root mean square of error over sigma: 1 if the posteriors are calibrated.
    pub rms_ratio: f64,
    /// Its 95 % interval: the values that the runs do not reject.
    pub rms_ratio_interval_95: [f64; 2],
    /// The coverage of the intervals of [`COVERAGES`].
    pub coverage: [Coverage; 3],
    /// The empirical distribution function of the ranks minus the uniform one, at [`EcdfBand::points`].
    pub ecdf_difference: Vec<f64>,
    /// The p-value of uniform ranks.
    pub p_value: f64,
}

/// The sums over the errors of one quantity.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct QuantityTally {
    count: u64,
    truth: f64,
    mean: f64,
    /// The sum of squared differences from the mean (‹welford1962›).
    squares: f64,
    variances: f64,
    prior_variances: f64,
    normalized: f64,
    covered: [u64; 3],
    /// The number of ranks in each interval.
    ranks: Vec<u64>,
}

/// A true value with its estimate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Comparison {
    pub(super) truth: f64,
    /// Estimate minus truth.
    pub(super) error: f64,
    pub(super) sigma: f64,
    pub(super) prior_sigma: f64,
}

impl Comparison {
    /// The rank of the truth in the posterior, from 0 to 1: the probability integral transform (‹talts2018›).
    fn rank(&self) -> f64 {
        Normal::standard().cdf(-self.error / self.sigma)
    }
}

impl QuantityTally {
    pub(super) fn new() -> Self {
        Self {
            count: 0,
            truth: 0.0,
            mean: 0.0,
            squares: 0.0,
            variances: 0.0,
            prior_variances: 0.0,
            normalized: 0.0,
            covered: [0; 3],
            ranks: vec![0; POINTS],
        }
    }

    pub(super) fn add(&mut self, one: &Comparison) {
        self.count += 1;
        let count = self.count as f64;
        self.truth += (one.truth - self.truth) / count;
        let from_old_mean = one.error - self.mean;
        self.mean += from_old_mean / count;
        self.squares += from_old_mean * (one.error - self.mean);
        self.variances += one.sigma.powi(2);
        self.prior_variances += one.prior_sigma.powi(2);
        let normalized = (one.error / one.sigma).abs();
        self.normalized += normalized.powi(2);
        for (covered, within) in self.covered.iter_mut().zip(WITHIN) {
            *covered += u64::from(normalized < within);
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from zero to the number of points"
        )]
        let interval = (one.rank() * POINTS as f64) as usize;
        self.ranks[interval.min(POINTS - 1)] += 1;
    }

    /// The statistics; `None` if there are fewer than two errors.
    pub(super) fn statistics(&self) -> Option<QuantityStatistics> {
        if self.count < 2 {
            return None;
        }
        let count = self.count as f64;
        let [low, high] = mean_square_bounds(count, 1.0 - CONFIDENCE)?;
        let error_std = (self.squares / (count - 1.0)).sqrt();
        let rms_ratio = (self.normalized / count).sqrt();
        let coverage = |place: usize| Coverage {
            nominal: COVERAGES[place],
            fraction: self.covered[place] as f64 / count,
            interval_95: clopper_pearson(self.covered[place], self.count, CONFIDENCE),
        };
        let below: Vec<u64> = self
            .ranks
            .iter()
            .take(POINTS - 1)
            .scan(0, |sum, ranks| {
                *sum += ranks;
                Some(*sum)
            })
            .collect();
        Some(QuantityStatistics {
            mean_truth: self.truth,
            mean_error: self.mean,
            mean_error_sigma: error_std / count.sqrt(),
            error_std,
            sigma_rms: (self.variances / count).sqrt(),
            prior_sigma_rms: (self.prior_variances / count).sqrt(),
            rms_ratio,
            rms_ratio_interval_95: [rms_ratio / high.sqrt(), rms_ratio / low.sqrt()],
            coverage: [0, 1, 2].map(coverage),
            ecdf_difference: differences(&below, self.count),
            p_value: EcdfBand::p_value(&below, self.count),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_widths_are_quantiles_of_the_normal_distribution() {
        for (within, nominal) in WITHIN.into_iter().zip(COVERAGES) {
            let quantile = Normal::standard().inverse_cdf(0.5 + 0.5 * nominal);
            // The digits of the constants.
            assert!((within - quantile).abs() < 1e-8, "{within} {quantile}");
        }
    }

    #[test]
    fn a_truth_above_the_estimate_has_a_rank_above_one_half() {
        let error = Comparison { truth: 3.0, error: -2.0, sigma: 2.0, prior_sigma: 9.0 };
        assert!((error.rank() - 0.841344746).abs() < 1e-9);
    }
}
