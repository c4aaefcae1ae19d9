//! Whether a sample is what its model says: χ² for squared errors, Kolmogorov–Smirnov for whitened ones.

use statrs::distribution::{ContinuousCDF, Normal};

/// The normal deviate beyond which lies one value in a thousand, both sides together.
const DEVIATE: f64 = 3.2905;

/// Kolmogorov's distribution leaves one value in a thousand beyond this.
const KOLMOGOROV: f64 = 1.9495;

/// Between which values the mean of `n_samples` independent χ² numbers with `dof` degrees of
/// freedom lies, but for one case in a thousand.
///
/// Their sum is χ² with `n_samples × dof` degrees, taken by Wilson and Hilferty's cube root.
///
/// ```
/// let (low, high) = rins_testing::chi_squared_mean_bounds(3.0, 200);
/// assert!(2.0 < low && low < 3.0 && 3.0 < high && high < 4.0);
/// ```
pub fn chi_squared_mean_bounds(dof: f64, n_samples: usize) -> (f64, f64) {
    let variance = 2.0 / (9.0 * dof * n_samples as f64);
    let at = |deviate: f64| dof * (1.0 - variance + deviate * variance.sqrt()).powi(3);
    (at(-DEVIATE), at(DEVIATE))
}

/// Whether the mean of `samples`, which must be independent, is that of χ² with `dof` degrees of
/// freedom.
///
/// For asserting that a wrong model fails; a right one is for [`assert_chi_squared`].
pub fn is_chi_squared(samples: &[f64], dof: f64) -> bool {
    let (low, high) = chi_squared_mean_bounds(dof, samples.len());
    (low..=high).contains(&mean(samples))
}

/// Asserts that the mean of `samples`, which must be independent, is that of χ² with `dof` degrees
/// of freedom.
pub fn assert_chi_squared(samples: &[f64], dof: f64) {
    assert!(samples.len() >= 30, "{} samples prove nothing", samples.len());
    let (low, high) = chi_squared_mean_bounds(dof, samples.len());
    assert!(is_chi_squared(samples, dof), "mean {} not in {low}..={high}", mean(samples));
}

/// The Kolmogorov–Smirnov distance of `samples` from N(0, 1), times the root of their number,
/// over what it exceeds in one case of a thousand: at most 1 for independent standard normal ones.
pub fn standard_normal_defect(samples: &[f64]) -> f64 {
    let normal = Normal::standard();
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    let distance = sorted
        .iter()
        .enumerate()
        .map(|(below, &x)| {
            let expected = normal.cdf(x);
            (expected - below as f64 / n).abs().max(((below + 1) as f64 / n - expected).abs())
        })
        .fold(0.0, f64::max);
    distance * n.sqrt() / KOLMOGOROV
}

/// Asserts that `samples`, which must be independent, are N(0, 1) in distribution.
pub fn assert_standard_normal(samples: &[f64]) {
    assert!(samples.len() >= 30, "{} samples prove nothing", samples.len());
    let defect = standard_normal_defect(samples);
    assert!(defect <= 1.0, "Kolmogorov-Smirnov distance is {defect} of what is allowed");
}

fn mean(samples: &[f64]) -> f64 {
    samples.iter().sum::<f64>() / samples.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::distribution::ChiSquared;

    #[test]
    fn bounds_are_those_of_the_exact_distribution() {
        for (dof, n_samples) in [(1.0, 30), (2.0, 200), (6.0, 1000)] {
            let (low, high) = chi_squared_mean_bounds(dof, n_samples);
            let total = ChiSquared::new(dof * n_samples as f64).unwrap();
            let exact = |p: f64| total.inverse_cdf(p) / n_samples as f64;
            // The cube root is good to a hundredth of the interval's width.
            crate::assert_close!(low, exact(0.0005), 0.01 * (high - low));
            crate::assert_close!(high, exact(0.9995), 0.01 * (high - low));
        }
    }

    #[test]
    fn quantiles_of_the_normal_pass_and_scaled_or_shifted_ones_fail() {
        let normal = Normal::standard();
        let quantiles: Vec<f64> =
            (0..1000).map(|k| normal.inverse_cdf((f64::from(k) + 0.5) / 1000.0)).collect();
        assert_standard_normal(&quantiles);
        let scaled: Vec<f64> = quantiles.iter().map(|x| x * 1.3).collect();
        let shifted: Vec<f64> = quantiles.iter().map(|x| x + 0.2).collect();
        assert!(standard_normal_defect(&scaled) > 1.0);
        assert!(standard_normal_defect(&shifted) > 1.0);
    }

    #[test]
    fn a_mean_off_by_half_is_no_chi_squared() {
        assert!(is_chi_squared(&[2.0; 200], 2.0));
        assert!(!is_chi_squared(&[3.0; 200], 2.0));
        assert!(!is_chi_squared(&[f64::NAN; 200], 2.0));
    }
}
