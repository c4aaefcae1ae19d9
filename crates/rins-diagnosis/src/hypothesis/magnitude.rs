//! The prior of an effect's amplitude: log-uniform over the typical range of its grade, with heavy tails.
//!
//! Given a scale `s` the amplitudes are N(0, s²); `ln s` is uniform over the typical range, and its density falls by a power of
//! the distance beyond it. An integral over `s` is then a finite mixture of Gaussians.

use rins_imu::ImuSpec;
use rins_terms::Term;

/// The density of `ln s` above the typical range falls by this many e-folds for each e-fold of `s`: an amplitude of ten times
/// the largest typical one is ten times less likely than that.
const ABOVE: f64 = 1.0;

/// The same below the typical range: every effect is small in a good instrument.
const BELOW: f64 = 0.25;

/// The spacing of the scales of the mixture, as a logarithm: half the width of the likelihood of a scale with one amplitude.
const SPACING: f64 = 0.6;

/// The range of scales beyond the typical range, as logarithms: what is smaller or larger is not distinguished from the ends.
const REACH: (f64, f64) = (12.0, 8.0);

/// The prior of the scale of some amplitudes, in units of their largest typical magnitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Magnitudes {
    /// The logarithms of the ends of the typical range.
    typical: (f64, f64),
    /// By how many e-folds the density falls below the typical range for each e-fold.
    below: f64,
    /// The logarithm of the integral of the density.
    ln_total: f64,
}

/// A component of the mixture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Component {
    /// The scale, in units of the largest typical magnitude.
    pub(crate) scale: f64,
    /// The logarithm of its prior probability.
    pub(crate) ln_weight: f64,
}

impl Magnitudes {
    /// The prior of a parameter of a term, for an IMU with this data sheet.
    pub(crate) fn of(term: &Term, parameter: usize, imu: &ImuSpec) -> Self {
        let parameter = &term.parameters[parameter];
        let (low, high) = parameter.range(imu);
        let sigma = parameter.sigma(imu);
        Self::between((low / sigma).ln(), (high / sigma).ln())
    }

    /// The prior of a departure from a stated prior, in units of its 1σ: three to a hundred times as large as stated.
    pub(crate) fn of_departure() -> Self {
        let typical = (3.0_f64.ln(), 100.0_f64.ln());
        Self { typical, below: 1e3, ln_total: (typical.1 - typical.0 + 1.0 / ABOVE).ln() }
    }

    fn between(low: f64, high: f64) -> Self {
        Self {
            typical: (low, high),
            below: BELOW,
            ln_total: (high - low + 1.0 / ABOVE + 1.0 / BELOW).ln(),
        }
    }

    /// The logarithm of the density of the logarithm of the scale.
    fn ln_density(&self, ln_scale: f64) -> f64 {
        let (low, high) = self.typical;
        let beyond = ABOVE * (ln_scale - high).max(0.0) + self.below * (low - ln_scale).max(0.0);
        -beyond - self.ln_total
    }

    /// The components of the mixture.
    pub(crate) fn components(self) -> impl Iterator<Item = Component> {
        let (low, high) = (self.typical.0 - REACH.0, self.typical.1 + REACH.1);
        let each = std::iter::successors(Some(low), move |at| {
            Some(at + SPACING).filter(|next| *next < high)
        });
        each.map(move |at| Component {
            scale: at.exp(),
            ln_weight: self.ln_density(at) + SPACING.ln(),
        })
    }
}

#[cfg(test)]
mod tests {
    use rins_terms::catalogue::CATALOGUE;
    use rins_testing::assert_close;

    use super::*;

    /// The weights of the mixture are probabilities, for every parameter of the catalogue and every grade.
    #[test]
    fn weights_sum_to_one() {
        for grade in rins_imu::GRADES {
            let imu = grade.imu;
            for term in CATALOGUE.iter().filter(|term| term.is_signal()) {
                for parameter in 0..term.parameters.len() {
                    let all = Magnitudes::of(term, parameter, &imu).components();
                    let total: f64 = all.map(|one| one.ln_weight.exp()).sum();
                    assert_close!(total, 1.0, 0.1);
                }
            }
        }
        let total: f64 =
            Magnitudes::of_departure().components().map(|one| one.ln_weight.exp()).sum();
        assert_close!(total, 1.0, 0.35);
    }

    /// Within the typical range every decade is as likely as any; beyond it amplitudes get less likely, faster above than below.
    #[test]
    fn density_is_flat_within_the_typical_range() {
        let prior = Magnitudes::between(0.01_f64.ln(), 1.0_f64.ln());
        let density = |scale: f64| prior.ln_density(scale.ln());
        assert_close!(density(0.02), density(0.9), 1e-12);
        assert_close!(density(0.9) - density(100.0), ABOVE * 100.0_f64.ln(), 1e-12);
        assert_close!(density(0.9) - density(1e-4), BELOW * 100.0_f64.ln(), 1e-12);
    }
}
