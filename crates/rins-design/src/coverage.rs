//! The coverage factor of an expanded uncertainty.

use statrs::function::erf::erfc;

/// The probability of an expanded uncertainty.
pub const COVERAGE: f64 = 0.95;

/// So many halvings of an interval find a factor to the last digit.
const HALVINGS: usize = 60;

/// No factor is larger: that of a normal distribution is 1.96.
const MOST: f64 = 4.0;

/// By how much the combined standard uncertainty is multiplied for an interval of 95 %: that of a sum of a normal distribution with
/// this standard deviation and of rectangular distributions with these (JCGM 101:2008, section 5.9).
///
/// The largest rectangular distribution is taken as it is, the others as normal ones: their sum is nearly normal unless it is negligible.
/// A factor of zero uncertainty is that of a normal distribution.
pub fn coverage_factor(normal: f64, rectangular: &[f64]) -> f64 {
    let largest = rectangular.iter().copied().fold(0.0, f64::max);
    let all: f64 = rectangular.iter().map(|one| one * one).sum();
    let rest = (normal * normal + all - largest * largest).max(0.0).sqrt();
    let combined = rest.hypot(largest);
    let half_width = 3.0_f64.sqrt() * largest;
    let within = |factor: f64| {
        if combined <= 0.0 || half_width < 1e-3 * rest {
            return 1.0 - erfc(factor / std::f64::consts::SQRT_2);
        }
        let limit = factor * combined;
        if rest < 1e-3 * half_width {
            return (limit / half_width).min(1.0);
        }
        // The integral of the distribution function over the width, at either end.
        let integral = |x: f64| rest * antiderivative(x / rest);
        let below =
            |x: f64| (integral(x + half_width) - integral(x - half_width)) / (2.0 * half_width);
        below(limit) - below(-limit)
    };
    let (mut low, mut high) = (0.0, MOST);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if within(middle) < COVERAGE {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// The integral of the normal distribution function up to `x`.
fn antiderivative(x: f64) -> f64 {
    let density = (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
    x * 0.5 * erfc(-x / std::f64::consts::SQRT_2) + density
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64;
    use rins_testing::assert_close;

    use super::*;

    #[test]
    fn factors_of_pure_distributions_are_those_of_tables() {
        assert_close!(coverage_factor(1.0, &[]), 1.959_964, 1e-5);
        // JCGM 100:2008, G.1.3: 1.65 for a rectangular distribution.
        assert_close!(coverage_factor(0.0, &[1.0]), 0.95 * 3.0_f64.sqrt(), 1e-9);
        assert_close!(coverage_factor(0.0, &[]), 1.959_964, 1e-5);
    }

    /// The Monte Carlo method of JCGM 101.
    #[test]
    fn interval_holds_a_sum_of_errors_in_95_percent_of_laboratories() {
        let mut random = Pcg64::seed_from_u64(8);
        for (normal, rectangular) in
            [(1.0, vec![0.3, 2.0]), (0.2, vec![1.0, 0.9]), (1.0, vec![1.0]), (0.1, vec![1.0])]
        {
            let factor = coverage_factor(normal, &rectangular);
            let square = normal * normal + rectangular.iter().map(|one| one * one).sum::<f64>();
            let limit = factor * f64::sqrt(square);
            let draws = 200_000;
            let mut inside = 0;
            for _ in 0..draws {
                let deviate: f64 = StandardNormal.sample(&mut random);
                let width = 3.0_f64.sqrt();
                let others: f64 =
                    rectangular.iter().map(|one| one * random.random_range(-width..width)).sum();
                inside += usize::from((normal * deviate + others).abs() < limit);
            }
            // 1σ of the share is 0.05 %; two rectangular distributions of one size come to 94.6 %.
            let share = f64::from(u32::try_from(inside).unwrap_or(0)) / f64::from(draws);
            assert!((share - COVERAGE).abs() < 0.006, "{normal} {rectangular:?}: {share}");
        }
    }
}
