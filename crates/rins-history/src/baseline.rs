//! The forecasts that need no model: the last value, the mean, a line over the date.

use crate::forecast::Forecast;

/// A value that was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Past {
    /// When, in any unit.
    pub date: f64,
    /// The value.
    pub value: f64,
}

/// The forecasts of the value at `date` by the last value, the mean, and the line over the date, each normal with the standard deviation of
/// its own errors so far, and at least `sigma`, the 1σ of a single value.
///
/// `None` for fewer than three values, or values of one date.
pub fn baselines(past: &[Past], date: f64, sigma: f64) -> Option<[Forecast; 3]> {
    let [.., last] = past else { return None };
    let n = past.len() as f64;
    let normal = |mean: f64, variance: f64| Forecast {
        components: vec![(1.0, mean, variance.sqrt().max(sigma))],
    };
    let steps: f64 = past.windows(2).map(|pair| (pair[1].value - pair[0].value).powi(2)).sum();
    let mean = past.iter().map(|one| one.value).sum::<f64>() / n;
    let square: f64 = past.iter().map(|one| (one.value - mean).powi(2)).sum();
    let middle = past.iter().map(|one| one.date).sum::<f64>() / n;
    let spread: f64 = past.iter().map(|one| (one.date - middle).powi(2)).sum();
    if n < 3.0 || spread <= 0.0 {
        return None;
    }
    let slope: f64 =
        past.iter().map(|one| (one.date - middle) * (one.value - mean)).sum::<f64>() / spread;
    let residual = |one: &Past| (one.value - mean - slope * (one.date - middle)).powi(2);
    let residual: f64 = past.iter().map(residual).sum();
    let beyond = date - middle;
    let leverage = 1.0 + n.recip() + beyond * beyond / spread;
    Some([
        normal(last.value, steps / (n - 1.0)),
        normal(mean, square / (n - 1.0) * (1.0 + n.recip())),
        normal(mean + slope * beyond, residual / (n - 2.0) * leverage),
    ])
}

#[cfg(test)]
mod tests {
    use rins_testing::assert_close;

    use super::*;

    #[test]
    fn line_is_extrapolated_without_residuals() {
        let past: Vec<Past> =
            [0.0, 1.0, 3.0].map(|date| Past { date, value: 2.0 + 5.0 * date }).to_vec();
        let [last, mean, line] = baselines(&past, 10.0, 0.1).expect("three values");
        assert_close!(last.mean(), 17.0, 1e-12);
        assert_close!(mean.mean(), 2.0 + 5.0 * 4.0 / 3.0, 1e-12);
        assert_close!(line.mean(), 52.0, 1e-12);
        assert_close!(line.sigma(), 0.1, 1e-6);
        assert!(baselines(&past[..2], 10.0, 0.1).is_none());
    }
}
