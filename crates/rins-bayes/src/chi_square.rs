//! Tails of the chi-square distribution, as logarithms that do not underflow.

use statrs::distribution::{ChiSquared, ContinuousCDF};
use statrs::function::gamma::ln_gamma;

/// Beyond it the tail is a series: statrs' own underflows at twice this.
const FAR: f64 = 600.0;

/// The logarithm of the probability that a chi-square of `dof` degrees exceeds `value`.
pub fn ln_tail(value: f64, dof: usize) -> f64 {
    let half = 0.5 * dof as f64;
    if value < FAR {
        return ChiSquared::new(dof as f64).map_or(0.0, |chi| chi.sf(value).ln());
    }
    // Γ(a, x) = x^(a-1) e^(-x) (1 + (a-1)/x + (a-1)(a-2)/x² + ...), DLMF 8.11.2.
    let x = 0.5 * value;
    let series = 1.0 + (half - 1.0) / x * (1.0 + (half - 2.0) / x);
    -x + (half - 1.0) * x.ln() - ln_gamma(half) + series.ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_takes_over_without_a_step() {
        for dof in [1, 2, 3, 6, 12] {
            let (before, after) = (ln_tail(FAR - 1e-9, dof), ln_tail(FAR, dof));
            assert!((before - after).abs() < 1e-5, "{dof}: {before} {after}");
        }
        // Two degrees: exp(-x/2).
        assert!((ln_tail(5000.0, 2) + 2500.0).abs() < 1e-9);
    }
}
