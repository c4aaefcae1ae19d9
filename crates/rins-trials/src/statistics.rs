//! Shares with their bounds, and what theory says of detection.

use statrs::distribution::{Beta, ChiSquared, ContinuousCDF, Discrete, Poisson};

/// So many out of so many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Share {
    pub(crate) of: u64,
    pub(crate) hits: u64,
}

impl Share {
    pub(crate) fn count(all: impl Iterator<Item = bool>) -> Self {
        all.fold(Self::default(), |sum, hit| Self {
            of: sum.of + 1,
            hits: sum.hits + u64::from(hit),
        })
    }

    pub(crate) fn part(&self) -> f64 {
        self.hits as f64 / self.of as f64
    }

    /// The bounds of Clopper and Pearson at 95 %.
    pub(crate) fn bounds(&self) -> (f64, f64) {
        let (hits, of) = (self.hits as f64, self.of as f64);
        let quantile = |a: f64, b: f64, at: f64| Beta::new(a, b).map(|beta| beta.inverse_cdf(at));
        let low = if self.hits == 0 {
            0.0
        } else {
            quantile(hits, of - hits + 1.0, 0.025).unwrap_or(0.0)
        };
        let high = if self.hits == self.of {
            1.0
        } else {
            quantile(hits + 1.0, of - hits, 0.975).unwrap_or(1.0)
        };
        (low, high)
    }

    /// As in `97.1 % (34 of 35; 85.1 – 99.9)`.
    pub(crate) fn text(&self) -> String {
        if self.of == 0 {
            return "no such trial".into();
        }
        let (low, high) = self.bounds();
        format!(
            "{:.1} % ({} of {}; {:.1} – {:.1})",
            100.0 * self.part(),
            self.hits,
            self.of,
            100.0 * low,
            100.0 * high
        )
    }
}

/// The probability that chi-square of `dof` degrees, off centre by the square of `strength`, exceeds `threshold`.
pub(crate) fn power(strength: f64, dof: usize, threshold: f64) -> f64 {
    let half = 0.5 * strength * strength;
    let tail = |extra: u64| {
        let degrees = dof as f64 + 2.0 * extra as f64;
        ChiSquared::new(degrees).map_or(0.0, |chi| chi.sf(threshold))
    };
    let Ok(mixing) = Poisson::new(half) else { return tail(0) };
    // Ten of its standard deviations hold all of the mixing distribution.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "positive and small"
    )]
    let [first, last] = [-10.0, 10.0].map(|n| (half + n * half.sqrt() + n).max(0.0) as u64);
    (first..=last).map(|extra| mixing.pmf(extra) * tail(extra)).sum()
}

/// What chi-square of `dof` degrees exceeds with this probability.
pub(crate) fn threshold(probability: f64, dof: usize) -> f64 {
    ChiSquared::new(dof as f64).map_or(f64::INFINITY, |chi| chi.inverse_cdf(1.0 - probability))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Clopper and Pearson's bounds of 0 and of 3 in 20, as in any table of them.
    #[test]
    fn bounds_are_those_of_the_tables() {
        let (low, high) = Share { of: 20, hits: 0 }.bounds();
        assert!(low == 0.0 && (high - 0.1684).abs() < 1e-4, "{high}");
        let (low, high) = Share { of: 20, hits: 3 }.bounds();
        assert!((low - 0.0321).abs() < 1e-4 && (high - 0.3789).abs() < 1e-4, "{low} {high}");
    }

    /// One degree off centre is a normal number that is off zero.
    #[test]
    fn power_is_that_of_a_normal_number() {
        let limit = threshold(0.05, 1);
        assert!((limit - 3.8415).abs() < 1e-4, "{limit}");
        // P(|z + 3| > 1.96) = Φ(1.04) + Φ(-4.96).
        assert!((power(3.0, 1, limit) - 0.8508).abs() < 1e-4);
        assert!((power(0.0, 4, threshold(0.01, 4)) - 0.01).abs() < 1e-6);
        assert!((power(100.0, 2, 30.0) - 1.0).abs() < 1e-9);
    }
}
