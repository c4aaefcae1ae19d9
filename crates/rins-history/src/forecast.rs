//! What a parameter will be in a run that was not measured: a mixture of normal distributions.

use statrs::function::erf::erfc;

/// The predictive distribution of a parameter: a mixture of normal distributions, one for each hypothesis and scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Forecast {
    /// The weight, the mean and the 1σ of each; the weights sum to one.
    pub components: Vec<(f64, f64, f64)>,
}

/// So many halvings of an interval find a quantile to the last digit.
const HALVINGS: usize = 200;

/// Beyond so many sigmas from every mean there is nothing.
const FAR: f64 = 40.0;

impl Forecast {
    /// The mean.
    pub fn mean(&self) -> f64 {
        self.components.iter().map(|(weight, mean, _)| weight * mean).sum()
    }

    /// The standard deviation.
    pub fn sigma(&self) -> f64 {
        let mean = self.mean();
        let square = |(weight, own, sigma): &(f64, f64, f64)| {
            weight * (sigma * sigma + (own - mean).powi(2))
        };
        self.components.iter().map(square).sum::<f64>().sqrt()
    }

    /// The forecast of an estimate with this 1σ of its own.
    #[must_use]
    pub fn estimated_within(&self, sigma: f64) -> Self {
        let wider = |&(weight, mean, own): &(f64, f64, f64)| (weight, mean, f64::hypot(own, sigma));
        Self { components: self.components.iter().map(wider).collect() }
    }

    /// The probability that it is below `x`.
    pub fn below(&self, x: f64) -> f64 {
        let of = |&(weight, mean, sigma): &(f64, f64, f64)| {
            weight * 0.5 * erfc((mean - x) / (sigma * std::f64::consts::SQRT_2))
        };
        self.components.iter().map(of).sum()
    }

    /// The value below which it is with this probability.
    pub fn quantile(&self, probability: f64) -> f64 {
        let reach = |sign: f64| {
            let ends = self.components.iter().map(|(_, mean, sigma)| mean + sign * FAR * sigma);
            ends.fold(-sign * f64::INFINITY, |a, b| if sign > 0.0 { a.max(b) } else { a.min(b) })
        };
        let (mut low, mut high) = (reach(-1.0), reach(1.0));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if self.below(middle) < probability {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    /// The interval that contains it with this probability, as probable to be exceeded as to be missed.
    pub fn interval(&self, probability: f64) -> (f64, f64) {
        (self.quantile(0.5 - 0.5 * probability), self.quantile(0.5 + 0.5 * probability))
    }

    /// The probability that it is further than `tolerance` from `value`.
    pub fn outside(&self, value: f64, tolerance: f64) -> f64 {
        (1.0 - self.below(value + tolerance) + self.below(value - tolerance)).clamp(0.0, 1.0)
    }

    /// The continuous ranked probability score of an outcome `x`: the smaller the better, in the unit of the parameter
    /// (Grimit et al. 2006, eq. (5)).
    pub fn crps(&self, x: f64) -> f64 {
        let far =
            |(weight, mean, sigma): &(f64, f64, f64)| weight * mean_distance(x - mean, *sigma);
        let one: f64 = self.components.iter().map(far).sum();
        let pair = |a: &(f64, f64, f64)| -> f64 {
            let with = |b: &(f64, f64, f64)| a.0 * b.0 * mean_distance(a.1 - b.1, a.2.hypot(b.2));
            self.components.iter().map(with).sum()
        };
        one - 0.5 * self.components.iter().map(pair).sum::<f64>()
    }
}

/// The mean of the absolute value of a normal number with this mean and 1σ.
fn mean_distance(mean: f64, sigma: f64) -> f64 {
    if sigma <= 0.0 {
        return mean.abs();
    }
    let x = mean / sigma;
    let density = (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
    let cumulative = 0.5 * erfc(-x / std::f64::consts::SQRT_2);
    2.0 * sigma * density + mean * (2.0 * cumulative - 1.0)
}

#[cfg(test)]
mod tests {
    use rins_testing::assert_close;

    use super::*;

    #[test]
    fn quantiles_are_those_of_a_normal_distribution() {
        let one = Forecast { components: vec![(1.0, 3.0, 2.0)] };
        let (low, high) = one.interval(0.95);
        assert_close!(low, 3.0 - 2.0 * 1.959964, 1e-5);
        assert_close!(high, 3.0 + 2.0 * 1.959964, 1e-5);
        assert_close!(one.outside(3.0, 2.0 * 1.959964), 0.05, 1e-6);
        // Gneiting & Raftery (2007), eq. (21), at the mean: sigma (2 phi(0) - 1/sqrt(pi)).
        let root = std::f64::consts::PI.sqrt().recip();
        assert_close!(one.crps(3.0), 2.0 * (std::f64::consts::SQRT_2 * root - root), 1e-12);
    }

    /// The score is the integral of the squared distance of the distribution from that of the outcome.
    #[test]
    fn crps_is_the_integral_that_defines_it() {
        let mixture = Forecast { components: vec![(0.3, -1.0, 0.5), (0.7, 2.0, 1.5)] };
        for x in [-3.0, 0.2, 4.0] {
            let step = 1e-3;
            let square = |place: i32| {
                let at = f64::from(place) * step;
                let outcome = if at >= x { 1.0 } else { 0.0 };
                (mixture.below(at) - outcome).powi(2) * step
            };
            let integral: f64 = (-20_000..20_000).map(square).sum();
            assert_close!(mixture.crps(x), integral, 2e-3);
        }
    }
}
