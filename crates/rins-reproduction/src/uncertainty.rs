//! The uncertainty of Table 5's estimates by JCGM 100: contributions, combined and expanded.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use rins_frames::units::DEG_PER_HOUR;

use crate::convergence::{information_bound, spin_rate};
use crate::experiment::Experiment;
use crate::monte_carlo::UNITS;
use crate::printed;
use crate::real_test::rate_accuracy;

/// The assumed distribution of a quantity, and the meaning of its size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Distribution {
    /// The size is the standard uncertainty.
    Normal,
    /// The size is the half-width: only bounds are stated (JCGM 100, 4.3.7).
    Rectangular,
}

impl Distribution {
    /// The standard uncertainty of a quantity of this size.
    pub(crate) fn standard_uncertainty(self, size: f64) -> f64 {
        match self {
            Self::Normal => size,
            Self::Rectangular => size / 3.0_f64.sqrt(),
        }
    }
}

/// A contribution to the uncertainty of an estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Contribution {
    /// Its name.
    pub(crate) name: &'static str,
    /// Its assumed distribution.
    pub(crate) distribution: Distribution,
    /// Its size: a standard uncertainty or a half-width, depending on its distribution.
    pub(crate) size: f64,
    /// The derivative of the estimate with respect to it.
    pub(crate) sensitivity: f64,
}

impl Contribution {
    /// Its contribution to the standard uncertainty of the estimate.
    pub(crate) fn standard_uncertainty(&self) -> f64 {
        self.distribution.standard_uncertainty(self.size) * self.sensitivity.abs()
    }
}

/// An estimate with its contributions, in one unit.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Budget {
    /// The estimate.
    pub(crate) value: f64,
    /// The contributions, independent of each other.
    pub(crate) contributions: Vec<Contribution>,
}

impl Budget {
    /// The combined standard uncertainty.
    pub(crate) fn combined(&self) -> f64 {
        let squares = self.contributions.iter().map(|one| one.standard_uncertainty().powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// The expanded uncertainty for a coverage factor.
    pub(crate) fn expanded(&self, coverage_factor: f64) -> f64 {
        coverage_factor * self.combined()
    }

    /// The probability that the error is within `half_width`, with the largest rectangular
    /// contribution treated exactly and the sum of the others as normal.
    pub(crate) fn coverage(&self, half_width: f64) -> f64 {
        let rectangular = self
            .contributions
            .iter()
            .filter(|one| one.distribution == Distribution::Rectangular)
            .map(Contribution::standard_uncertainty)
            .fold(0.0, f64::max);
        let bound = rectangular * 3.0_f64.sqrt();
        let normal = (self.combined().powi(2) - rectangular.powi(2)).max(0.0).sqrt();
        if rectangular < 1e-9 * normal {
            return 1.0 - libm::erfc(half_width / normal * FRAC_1_SQRT_2);
        }
        if normal < 1e-9 * rectangular {
            return (half_width / bound).min(1.0);
        }
        // The mean of the normal distribution function over the rectangle: its integral is z Φ(z) + φ(z).
        let integral = |limit: f64| {
            let z = limit / normal;
            let below = 1.0 - 0.5 * libm::erfc(z * FRAC_1_SQRT_2);
            z * below + libm::exp(-0.5 * z * z) / (2.0 * PI).sqrt()
        };
        let inside = integral(half_width + bound)
            - integral(half_width - bound)
            - integral(bound - half_width)
            + integral(-half_width - bound);
        inside * normal / (2.0 * bound)
    }

    /// The half-width of the interval that contains the value with this probability.
    pub(crate) fn half_width(&self, probability: f64) -> f64 {
        let (mut low, mut high) = (0.0, self.expanded(10.0));
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.coverage(middle) < probability {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    /// The decimals that an expanded uncertainty of two significant digits supports (JCGM 100, 7.2.6).
    pub(crate) fn decimals(&self) -> usize {
        let expanded = self.expanded(2.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count of decimals"
        )]
        let decimals = (1.0 - expanded.log10().floor()).max(0.0) as usize;
        decimals
    }
}

/// The accuracy of the gyros stated in section 5.1 \[rad/s\].
const GYRO_ACCURACY: f64 = 0.1 * DEG_PER_HOUR;

/// The budgets of Table 5's `M_xz`, `M_yz` \[arcsec\] and `S_z` \[ppm\], with the given distribution of the table rate's
/// accuracy.
///
/// The calibration compares the gyros with the commanded rate `ω`. A true rate of `(1 + e) ω` adds `e` to
/// `S_z` and `M e` to a misalignment; a bias `B` adds `B / w` to its own.
pub(crate) fn table_5(experiment: &Experiment, table_rate: Distribution) -> [Budget; 3] {
    let scenario = &experiment.scenario;
    let spin = spin_rate(scenario);
    let noise = experiment.setup.imu.gyro.noise_density;
    let profile = &scenario.profile;
    let turning = profile.angle(profile.duration()) / profile.rate(profile.duration());
    std::array::from_fn(|row| {
        let value = printed::TABLE_5[row];
        let by_rate = if row == 2 { 1.0 / UNITS[2] } else { value };
        let contribution = |name, distribution, size, sensitivity| Contribution {
            name,
            distribution,
            size,
            sensitivity,
        };
        let (normal, rectangular) = (Distribution::Normal, Distribution::Rectangular);
        Budget {
            value,
            contributions: vec![
                contribution(
                    "table rate, 0.0001 °/s",
                    table_rate,
                    rate_accuracy(scenario),
                    by_rate,
                ),
                contribution(
                    "gyro bias, 0.1 °/h",
                    normal,
                    GYRO_ACCURACY,
                    1.0 / (spin * UNITS[row]),
                ),
                contribution(
                    "gyro noise over 900 s",
                    normal,
                    information_bound(noise, spin, f64::INFINITY, turning),
                    1.0 / UNITS[row],
                ),
                contribution("rounding of the print", rectangular, 0.5e-4, 1.0),
            ],
        }
    })
}

/// A budget with one contribution only.
pub(crate) fn alone(budget: &Budget, place: usize) -> Budget {
    Budget { value: budget.value, contributions: vec![budget.contributions[place]] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_testing::assert_close;

    fn budget(sizes: &[(Distribution, f64)]) -> Budget {
        let contributions = sizes
            .iter()
            .map(|&(distribution, size)| Contribution {
                name: "one",
                distribution,
                size,
                sensitivity: -1.0,
            })
            .collect();
        Budget { value: 0.0, contributions }
    }

    #[test]
    fn intervals_are_those_of_each_distribution_alone() {
        let rectangular = budget(&[(Distribution::Rectangular, 10.0)]);
        assert_close!(rectangular.combined(), 10.0 / 3.0_f64.sqrt(), 1e-12);
        assert_close!(rectangular.half_width(0.95), 9.5, 1e-9);
        let normal = budget(&[(Distribution::Normal, 3.0), (Distribution::Normal, 4.0)]);
        assert_close!(normal.combined(), 5.0, 1e-12);
        assert_close!(normal.half_width(0.95), 1.959_963_985 * 5.0, 1e-7);
    }

    /// The second moment of the coverage is the square of the combined uncertainty: `∫ 2c (1 - P) dc`.
    #[test]
    fn coverage_has_the_combined_uncertainty_as_its_deviation() {
        for normal in [0.01, 0.5, 2.8, 40.0] {
            let both = budget(&[(Distribution::Rectangular, 10.0), (Distribution::Normal, normal)]);
            let (end, steps) = (10.0 + 12.0 * normal, 200_000_u32);
            let step = end / f64::from(steps);
            let moment: f64 = (0..steps)
                .map(|index| (f64::from(index) + 0.5) * step)
                .map(|at| 2.0 * at * (1.0 - both.coverage(at)) * step)
                .sum();
            assert_close!(moment.sqrt(), both.combined(), 1e-6 * both.combined());
        }
    }

    #[test]
    fn digits_follow_from_the_uncertainty() {
        for (size, decimals) in
            [(0.005, 3), (0.0234, 3), (0.06, 2), (0.4, 2), (0.57, 1), (5.8, 0), (60.0, 0)]
        {
            assert_eq!(budget(&[(Distribution::Normal, size)]).decimals(), decimals, "{size}");
        }
    }
}
