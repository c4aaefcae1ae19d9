//! Confidence intervals of fractions and of root mean squares.

use statrs::distribution::{Beta, ChiSquared, ContinuousCDF};

/// The Clopper-Pearson interval of a binomial fraction, of which `successes` of `trials` were counted (‹clopper1934›).
///
/// It contains the fraction with a probability of at least `level`.
///
/// # Panics
/// If there are no trials, or fewer than successes.
///
/// ```
/// let [low, high] = rins_campaign::clopper_pearson(5, 10, 0.95);
/// assert!((low - 0.18709).abs() < 1e-5 && (high - 0.81291).abs() < 1e-5);
/// ```
pub fn clopper_pearson(successes: u64, trials: u64, level: f64) -> [f64; 2] {
    assert!(trials > 0 && successes <= trials, "{successes} of {trials}");
    let tail = 0.5 * (1.0 - level);
    let (k, n) = (successes as f64, trials as f64);
    let quantile = |a: f64, b: f64, probability: f64| {
        Beta::new(a, b).expect("positive shapes").inverse_cdf(probability)
    };
    let low = if successes == 0 { 0.0 } else { quantile(k, n - k + 1.0, tail) };
    let high = if successes == trials { 1.0 } else { quantile(k + 1.0, n - k, 1.0 - tail) };
    [low, high]
}

/// The bounds of a mean of squares of `count` standard normal numbers that lie outside with probability `outside`.
///
/// `None` if there are none.
pub(super) fn mean_square_bounds(count: f64, outside: f64) -> Option<[f64; 2]> {
    let squares = ChiSquared::new(count).ok()?;
    let bound = |probability: f64| squares.inverse_cdf(probability) / count;
    Some([bound(0.5 * outside), bound(1.0 - 0.5 * outside)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published values: Clopper and Pearson (1934); the rule of three for no success.
    #[test]
    fn intervals_of_fractions_are_those_of_tables() {
        for (successes, trials, low, high) in
            [(0, 10, 0.0, 0.30850), (10, 10, 0.69150, 1.0), (1, 100, 0.00025, 0.05446)]
        {
            let got = clopper_pearson(successes, trials, 0.95);
            // The digits of the table.
            assert!((got[0] - low).abs() < 6e-6 && (got[1] - high).abs() < 6e-6, "{got:?}");
        }
    }

    #[test]
    fn an_interval_of_many_trials_is_that_of_the_normal_distribution() {
        let [low, high] = clopper_pearson(68_000, 100_000, 0.95);
        let sigma = (0.68_f64 * 0.32 / 1e5).sqrt();
        assert!(((high - low) / (2.0 * 1.96 * sigma) - 1.0).abs() < 0.01, "{low} {high}");
    }
}
