//! Random bias processes, discretized exactly over an interval of any length.

/// A first-order Gauss-Markov process with the autocovariance σ² exp(-|t|/T).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussMarkov {
    /// Its standard deviation σ \[rate\].
    pub sigma: f64,
    /// The correlation time T, in which the correlation decreases by a factor e \[s\].
    pub correlation_time: f64,
}

/// A random bias process of one sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BiasProcess {
    /// The integral of white noise.
    Walk {
        /// The root density of the white noise \[rate/√s\].
        density: f64,
    },
    /// A Gauss-Markov process.
    Relaxing(GaussMarkov),
}

/// The transition of a bias `x` over one interval, and its integral:
/// `x₁ = decay x₀ + spread w` and `∫x dt = weight (x₀ + x₁) + √residual v`, with w and v
/// independent and standard normal.
///
/// Given both of its ends, the integral of such a process has the mean `weight (x₀ + x₁)`, by the
/// time-reversal symmetry of a bridge. The remainder is independent of everything else, so that the
/// remainders of many processes can be drawn as one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BiasStep {
    /// The part of the bias that is left.
    pub decay: f64,
    /// The standard deviation of what is added to it \[rate\].
    pub spread: f64,
    /// The weight of the ends in the integral \[s\].
    pub weight: f64,
    /// The variance of the integral given both ends \[rate² s²\].
    pub residual: f64,
}

impl BiasProcess {
    /// The standard deviation of the bias at the start.
    pub fn initial_sigma(&self) -> f64 {
        match self {
            Self::Walk { .. } => 0.0,
            Self::Relaxing(process) => process.sigma,
        }
    }

    /// Its discretization over an interval \[s\].
    pub fn step(&self, interval: f64) -> BiasStep {
        match *self {
            Self::Walk { density } => BiasStep {
                decay: 1.0,
                spread: density * interval.sqrt(),
                weight: interval / 2.0,
                residual: density * density * interval * interval * interval / 12.0,
            },
            Self::Relaxing(GaussMarkov { sigma, correlation_time }) => {
                let h = interval / correlation_time;
                let span = sigma * correlation_time;
                BiasStep {
                    decay: libm::exp(-h),
                    spread: sigma * (-libm::expm1(-2.0 * h)).sqrt(),
                    weight: correlation_time * libm::tanh(h / 2.0),
                    residual: 2.0 * span * span * bridge(h),
                }
            }
        }
    }
}

/// The function `h - 2 tanh(h/2)`, which is of third order in h.
fn bridge(h: f64) -> f64 {
    // Where the difference would cancel, the series is used: the first omitted term is below 10⁻¹⁵ of it.
    if h < 0.1 {
        const SERIES: [f64; 5] =
            [691.0 / 79833600.0, -31.0 / 362880.0, 17.0 / 20160.0, -1.0 / 120.0, 1.0 / 12.0];
        let square = h * h;
        h * square * SERIES.iter().fold(0.0, |sum, c| sum * square + c)
    } else {
        h - 2.0 * libm::tanh(h / 2.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The covariance of (end, integral) if the start has the variance `start`.
    fn covariance(step: &BiasStep, start: f64) -> [f64; 3] {
        let BiasStep { decay, spread, weight, residual } = *step;
        let noise = spread * spread;
        let end = decay * decay * start + noise;
        let cross = weight * ((1.0 + decay) * decay * start + noise);
        let integral = weight * weight * ((1.0 + decay).powi(2) * start + noise) + residual;
        [end, cross, integral]
    }

    /// The gain from start to integral, `∫ E[x | x₀] dt / x₀`.
    fn drift(step: &BiasStep) -> f64 {
        step.weight * (1.0 + step.decay)
    }

    fn any_process() -> impl Strategy<Value = BiasProcess> {
        prop_oneof![
            (0.1..10.0_f64).prop_map(|density| BiasProcess::Walk { density }),
            (0.1..10.0_f64, -3.0..3.0_f64).prop_map(|(sigma, exponent)| {
                let correlation_time = 10.0_f64.powf(exponent);
                BiasProcess::Relaxing(GaussMarkov { sigma, correlation_time })
            }),
        ]
    }

    fn close(got: f64, want: f64) -> bool {
        // `bridge` loses three digits of sixteen near h = 0.1, and the sums a little.
        (got - want).abs() <= 1e-12 * want.abs()
    }

    proptest! {
        /// A property of the exact discretization only: two intervals are equivalent to one.
        #[test]
        fn consecutive_steps_compose(process in any_process(), a in 0.01..2.0_f64, b in 0.01..2.0_f64) {
            let (first, second, whole) = (process.step(a), process.step(b), process.step(a + b));
            prop_assert!(close(first.decay * second.decay, whole.decay));
            prop_assert!(close(drift(&first) + first.decay * drift(&second), drift(&whole)));

            let [end, cross, integral] = covariance(&first, 0.0);
            let [own_end, own_cross, own_integral] = covariance(&second, 0.0);
            let gain = drift(&second);
            let decay = second.decay;
            let composed = [
                decay * decay * end + own_end,
                decay * (cross + gain * end) + own_cross,
                integral + 2.0 * gain * cross + gain * gain * end + own_integral,
            ];
            for (got, want) in composed.into_iter().zip(covariance(&whole, 0.0)) {
                prop_assert!(close(got, want), "{} is not {}", got, want);
            }
        }

        #[test]
        fn stationary_process_stays_so(sigma in 0.1..10.0_f64, h in 1e-6..50.0_f64) {
            let step = BiasProcess::Relaxing(GaussMarkov { sigma, correlation_time: 1.0 }).step(h);
            prop_assert!(close(covariance(&step, sigma * sigma)[0], sigma * sigma));
        }
    }

    #[test]
    fn slow_process_integrates_to_its_bias_and_a_fast_one_to_white_noise() {
        let slow =
            BiasProcess::Relaxing(GaussMarkov { sigma: 2.0, correlation_time: 1e9 }).step(1.0);
        assert!(close(covariance(&slow, 4.0)[2] / 4.0, 1.0 - 1e-9 / 3.0));
        // Density 2 σ² T, minus the effect of the ends: (1 - T) of it over one second.
        let fast =
            BiasProcess::Relaxing(GaussMarkov { sigma: 2.0, correlation_time: 1e-4 }).step(1.0);
        assert!(close(covariance(&fast, 4.0)[2], 8e-4 * (1.0 - 1e-4)));
    }
}
