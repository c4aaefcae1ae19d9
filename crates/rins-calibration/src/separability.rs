//! Which of the three spin-axis errors a schedule tells from the gyro biases.

use rins_imu::TriadSpec;

use crate::parameter::{ParameterKind, Partner};

/// A parameter is told from its partner if not knowing the partner costs less than this factor in sigma.
const LARGEST_COST: f64 = 3.0;

/// Sums over the samples of a run from which separability follows.
///
/// Along each axis the gyro error is `x ω_z + b`, with `x` one of `M_xz`, `M_yz`, `S_z`. The
/// information on `(x, b)` is then the Gram matrix of `ω_z` and 1, whatever the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SpinRateSums {
    duration: f64,
    rate: f64,
    square: f64,
}

impl SpinRateSums {
    /// Adds a sample whose spin rate was `rate` \[rad/s\] over `interval` \[s\].
    pub(crate) fn add(&mut self, rate: f64, interval: f64) {
        self.duration += interval;
        self.rate += rate * interval;
        self.square += rate * rate * interval;
    }

    /// The root mean square of the spin rate \[rad/s\].
    pub(crate) fn root_mean_square(&self) -> f64 {
        if self.duration > 0.0 { (self.square / self.duration).sqrt() } else { 0.0 }
    }

    /// The bias that hides in the estimate, or `None` if the schedule separates them.
    ///
    /// The share is the regression of a constant on the spin rate, `Σω / Σω²`, which for one
    /// constant rate is `1/(ω + ω_ie,z)`.
    pub(crate) fn partner(&self, spec: &TriadSpec, id: &'static str) -> Option<Partner> {
        let noise = spec.noise_density * spec.noise_density;
        let bias_prior = noise / (spec.bias_sigma * spec.bias_sigma);
        // Sigma without and with the bias unknown: 1/a against c/(a c - b²).
        let cost =
            1.0 / (1.0 - self.rate * self.rate / (self.square * (self.duration + bias_prior)));
        (cost.sqrt() > LARGEST_COST).then(|| Partner {
            id,
            share: self.rate / self.square,
            kind: ParameterKind::GyroBias,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_frames::units::{DEG_PER_HOUR, DEG_PER_SECOND};
    use rins_testing::assert_close;

    const SPEC: TriadSpec = TriadSpec {
        noise_density: 0.02 * DEG_PER_HOUR,
        bias_sigma: 0.1 * DEG_PER_HOUR,
        scale_sigma: 5e-4,
        misalignment_sigma: 5e-4,
        bias_instability: None,
        random_walk: None,
        range: None,
        resolution: None,
    };

    #[test]
    fn one_rate_hides_the_bias_and_a_reversal_shows_it() {
        let rate = 10.0 * DEG_PER_SECOND;
        let mut sums = SpinRateSums::default();
        sums.add(rate, 360.0);
        let partner = sums.partner(&SPEC, "gyro.bias.x").unwrap();
        assert_close!(partner.share, 1.0 / rate, 1e-12);
        sums.add(-rate, 360.0);
        assert_eq!(sums.partner(&SPEC, "gyro.bias.x"), None);
    }

    #[test]
    fn a_gyro_known_to_have_no_bias_hides_none() {
        let mut sums = SpinRateSums::default();
        sums.add(10.0 * DEG_PER_SECOND, 360.0);
        let known = TriadSpec { bias_sigma: 1e-6 * DEG_PER_HOUR, ..SPEC };
        assert_eq!(sums.partner(&known, "gyro.bias.x"), None);
    }
}
