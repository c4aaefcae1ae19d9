//! The contributions of the gyro biases to the three estimates under a schedule.

use rins_imu::TriadSpec;

use crate::parameter::{ParameterKind, Partner};

/// Sums over the samples of a run that determine the contributions of the biases to the estimates.
///
/// Along each axis the gyro error is `x ω_z + b`, with `x` one of `M_xz`, `M_yz`, `S_z`.
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

    /// The bias that contributes to an estimate of 1σ `sigma`, or `None` if its contribution is insignificant under this
    /// schedule.
    ///
    /// The filter has no bias states: under any schedule a bias contributes to the estimate by the regression of a constant
    /// on the spin rate, `Σω / Σω²`. This is `1/(ω + ω_ie,z)` for a constant rate, and zero after a symmetric reversal. The
    /// bias is reported if one of the data sheet's size changes the estimate by more than its sigma.
    pub(crate) fn partner(&self, spec: &TriadSpec, sigma: f64, id: &str) -> Option<Partner> {
        let share = self.rate / self.square;
        (share.abs() * spec.bias_sigma > sigma).then_some(Partner {
            id: id.into(),
            share,
            kind: ParameterKind::GyroBias,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_frames::units::{ARCSEC, DEG_PER_HOUR, DEG_PER_SECOND};
    use rins_testing::assert_close;

    const SPEC: TriadSpec = TriadSpec::white(0.02 * DEG_PER_HOUR, 0.1 * DEG_PER_HOUR, 5e-4, 5e-4);

    const SIGMA: f64 = 0.006 * ARCSEC;

    fn sums(profile: &[(f64, f64)]) -> SpinRateSums {
        let mut sums = SpinRateSums::default();
        for (rate, duration) in profile {
            sums.add(rate * DEG_PER_SECOND, *duration);
        }
        sums
    }

    #[test]
    fn one_rate_holds_the_bias_and_an_even_reversal_does_not() {
        let partner = sums(&[(10.0, 360.0)]).partner(&SPEC, SIGMA, "gyro.bias.x").unwrap();
        assert_close!(partner.share, 1.0 / (10.0 * DEG_PER_SECOND), 1e-12);
        let reversed = sums(&[(10.0, 360.0), (-10.0, 360.0)]);
        assert_eq!(reversed.partner(&SPEC, SIGMA, "gyro.bias.x"), None);
    }

    #[test]
    fn schedules_that_could_separate_but_whose_filter_does_not_are_told() {
        let dwell = [(10.0, 300.0), (0.0, 60.0)];
        let two_rates = [(10.0, 300.0), (30.0, 300.0)];
        let uneven_reversal = [(10.0, 400.0), (-10.0, 100.0)];
        for profile in [&dwell, &two_rates, &uneven_reversal] {
            assert!(sums(profile).partner(&SPEC, SIGMA, "gyro.bias.x").is_some(), "{profile:?}");
        }
    }

    /// The bias of the data sheet changes the estimate by a little more than its sigma, or by a little less.
    #[test]
    fn a_bias_is_named_from_one_sigma_of_the_estimate_on() {
        let sums = sums(&[(10.0, 360.0)]);
        let moved = SPEC.bias_sigma / (10.0 * DEG_PER_SECOND);
        let partner = |sigma| sums.partner(&SPEC, sigma, "gyro.bias.x");
        assert!(partner(0.95 * moved).is_some());
        assert!(partner(1.05 * moved).is_none());
    }

    #[test]
    fn a_gyro_known_to_have_no_bias_holds_none() {
        let known = TriadSpec { bias_sigma: 1e-6 * DEG_PER_HOUR, ..SPEC };
        assert_eq!(sums(&[(10.0, 360.0)]).partner(&known, SIGMA, "gyro.bias.x"), None);
    }
}
