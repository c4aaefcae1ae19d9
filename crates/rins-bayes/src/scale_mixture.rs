//! The prior of an amplitude: log-uniform over a typical range, with heavy tails.
//!
//! Given a scale `s` the amplitudes are N(0, s²); `ln s` is uniform over the typical range, and its density falls by a power of
//! the distance beyond it. An integral over `s` is then a finite mixture of Gaussians.

/// The density of `ln s` above the typical range falls by this many e-folds for each e-fold of `s`: an amplitude of ten times
/// the largest typical one is ten times less likely than that.
const ABOVE: f64 = 1.0;

/// The same below the typical range: every effect is small in a good instrument.
const BELOW: f64 = 0.25;

/// The same where there is nothing below it.
const NEVER: f64 = 1e3;

/// The spacing of the scales of the mixture, as a logarithm: half the width of the likelihood of a scale with one amplitude.
const SPACING: f64 = 0.6;

/// The range of scales beyond the typical range, as logarithms: what is smaller or larger is not distinguished from the ends.
const REACH: (f64, f64) = (12.0, 8.0);

/// The prior of the scale of some amplitudes, in units of their largest typical magnitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaleMixture {
    /// The logarithms of the ends of the typical range.
    typical: (f64, f64),
    /// By how many e-folds the density falls below the typical range for each e-fold.
    below: f64,
    /// The logarithm of the integral of the density.
    ln_total: f64,
}

/// A component of the mixture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Component {
    /// The scale, in units of the largest typical magnitude.
    pub scale: f64,
    /// The logarithm of its prior probability.
    pub ln_weight: f64,
}

impl ScaleMixture {
    /// The prior whose typical range lies between these scales, both positive, with heavy tails.
    pub fn between(low: f64, high: f64) -> Self {
        let (low, high) = (low.ln(), high.ln());
        let ln_total = (high - low + 1.0 / ABOVE + 1.0 / BELOW).ln();
        Self { typical: (low, high), below: BELOW, ln_total }
    }

    /// The prior whose typical range lies between these scales, both positive, and below which there is nothing.
    pub fn above(low: f64, high: f64) -> Self {
        let of = Self::between(low, high);
        let ln_total = (of.typical.1 - of.typical.0 + 1.0 / ABOVE).ln();
        Self { below: NEVER, ln_total, ..of }
    }

    /// The logarithm of the density of the logarithm of the scale.
    fn ln_density(&self, ln_scale: f64) -> f64 {
        let (low, high) = self.typical;
        let beyond = ABOVE * (ln_scale - high).max(0.0) + self.below * (low - ln_scale).max(0.0);
        -beyond - self.ln_total
    }

    /// The logarithm of the prior probability of a component with this scale.
    pub fn ln_weight(&self, scale: f64) -> f64 {
        self.ln_density(scale.ln()) + SPACING.ln()
    }

    /// The components of the mixture.
    pub fn components(self) -> impl Iterator<Item = Component> {
        let (low, high) = (self.typical.0 - REACH.0, self.typical.1 + REACH.1);
        let each = std::iter::successors(Some(low), move |at| {
            Some(at + SPACING).filter(|next| *next < high)
        });
        each.map(move |at| Component { scale: at.exp(), ln_weight: self.ln_weight(at.exp()) })
    }
}

#[cfg(test)]
mod tests {
    use rins_testing::assert_close;

    use super::*;

    /// The weights of the mixture are probabilities.
    #[test]
    fn weights_sum_to_one() {
        let total = |prior: ScaleMixture| -> f64 {
            prior.components().map(|one| one.ln_weight.exp()).sum()
        };
        for high in [1.0, 3.0, 1e3, 1e6] {
            assert_close!(total(ScaleMixture::between(1.0, high)), 1.0, 0.1);
            // The step at the lower end falls between two scales.
            assert_close!(total(ScaleMixture::above(1.0, high)), 1.0, 0.35);
        }
    }

    /// Within the typical range every decade is as likely as any; beyond it amplitudes get less likely, faster above than below.
    #[test]
    fn density_is_flat_within_the_typical_range() {
        let prior = ScaleMixture::between(0.01, 1.0);
        let density = |scale: f64| prior.ln_density(scale.ln());
        assert_close!(density(0.02), density(0.9), 1e-12);
        assert_close!(density(0.9) - density(100.0), ABOVE * 100.0_f64.ln(), 1e-12);
        assert_close!(density(0.9) - density(1e-4), BELOW * 100.0_f64.ln(), 1e-12);
    }
}
