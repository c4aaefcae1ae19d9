//! The Bayes factor of a block of amplitudes, in closed form.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::scale_mixture::{Component, ScaleMixture};

/// What data say of a block of amplitudes.
#[derive(Clone, Debug)]
pub struct Block {
    /// The logarithm of the Bayes factor of the block against zero amplitudes.
    pub ln_factor: f64,
    /// The scale of the largest component of the mixture.
    pub scale: f64,
    /// The amplitudes with that scale.
    pub estimate: DVector<f64>,
    /// The sum of the squares of the amplitudes over their sigmas, without a prior.
    pub statistic: f64,
    /// The number of directions that are observed better than they are known beforehand.
    pub dof: usize,
}

impl Block {
    /// The Bayes factor of amplitudes with this information and score, in units of their largest typical magnitudes.
    ///
    /// For one Gaussian of scale `s` it is `Π (1 + s² λ)^-1/2 exp(½ a² s²/(1 + s² λ))` over the eigenvalues `λ` of the
    /// information, `a` being the score along each eigenvector.
    pub fn of(information: DMatrix<f64>, score: &DVector<f64>, magnitudes: &ScaleMixture) -> Self {
        let spectrum = Spectrum::of(information, score);
        let all = spectrum.posterior(magnitudes);
        let first = Component { scale: 1.0, ln_weight: f64::NEG_INFINITY };
        let more = |best: Component, one: &Component| {
            if one.ln_weight > best.ln_weight { *one } else { best }
        };
        let Component { scale, .. } = all.iter().fold(first, more);
        let square = scale * scale;
        let Spectrum { values, along, vectors } = spectrum;
        let shrunk = along.zip_map(&values, |along, value| along * square / (1.0 + square * value));
        let seen = |value: f64| square * value > 1.0;
        let squares = values.iter().zip(along.iter()).filter(|(value, _)| seen(**value));
        Self {
            ln_factor: log_sum(all.iter().map(|one| one.ln_weight)),
            scale,
            estimate: vectors * shrunk,
            statistic: squares.map(|(value, along)| along * along / value).sum(),
            dof: values.iter().filter(|value| seen(**value)).count(),
        }
    }

    /// The components of the mixture, their weights multiplied by the Bayes factor of each: but for the sum, the posterior distribution
    /// of the scale.
    pub fn scales(
        information: DMatrix<f64>,
        score: &DVector<f64>,
        magnitudes: &ScaleMixture,
    ) -> Vec<Component> {
        Spectrum::of(information, score).posterior(magnitudes)
    }
}

/// The eigenvalues of an information matrix, and the score along its eigenvectors.
struct Spectrum {
    values: DVector<f64>,
    along: DVector<f64>,
    vectors: DMatrix<f64>,
}

impl Spectrum {
    fn of(information: DMatrix<f64>, score: &DVector<f64>) -> Self {
        let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(information);
        let along = eigenvectors.tr_mul(score);
        Self { values: eigenvalues.map(|value| value.max(0.0)), along, vectors: eigenvectors }
    }

    fn posterior(&self, magnitudes: &ScaleMixture) -> Vec<Component> {
        let ln_factor = |scale: f64| -> f64 {
            let square = scale * scale;
            let each = self.values.iter().zip(self.along.iter()).map(|(value, along)| {
                let gain = 1.0 + square * value;
                0.5 * (along * along * square / gain - gain.ln())
            });
            each.sum()
        };
        let of = |Component { scale, ln_weight }| Component {
            scale,
            ln_weight: ln_weight + ln_factor(scale),
        };
        magnitudes.components().map(of).collect()
    }
}

/// The logarithm of a sum of exponentials; that of nothing is negative infinity.
pub fn log_sum(all: impl IntoIterator<Item = f64>) -> f64 {
    let (mut most, mut sum) = (f64::NEG_INFINITY, 0.0);
    for one in all {
        if one > most {
            sum = sum * (most - one).exp() + 1.0;
            most = one;
        } else if one > f64::NEG_INFINITY {
            sum += (one - most).exp();
        }
    }
    most + f64::ln(sum)
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64;
    use rins_testing::assert_close;

    use super::*;

    /// The mixture's Bayes factor of one amplitude is the integral of the likelihood ratio over the prior.
    #[test]
    fn factor_of_one_amplitude_is_the_integral_over_its_prior() {
        let magnitudes = ScaleMixture::above(3.0, 100.0);
        for (sigma, estimate) in [(0.1, 0.0), (0.5, 2.0), (2.0, 5.0), (3.0, 40.0)] {
            let information = f64::powi(sigma, -2);
            let density = |amplitude: f64| -> f64 {
                let of = |one: Component| {
                    let square = (amplitude / one.scale).powi(2);
                    (one.ln_weight - 0.5 * square).exp()
                        / (one.scale * std::f64::consts::TAU.sqrt())
                };
                magnitudes.components().map(of).sum()
            };
            let step = 0.01 * sigma;
            let integral: f64 = (-20_000..20_000)
                .map(|place| estimate + step * f64::from(place))
                .map(|amplitude| {
                    let ratio = amplitude * estimate - 0.5 * amplitude * amplitude;
                    density(amplitude) * (ratio * information).exp() * step
                })
                .sum();
            let block = Block::of(
                DMatrix::from_element(1, 1, information),
                &DVector::from_element(1, information * estimate),
                &magnitudes,
            );
            assert_close!(block.ln_factor, integral.ln(), 0.05);
        }
    }

    /// Over data with the effect, drawn from its prior, the mean of the reciprocal factor is one; over data without it, a factor
    /// of `x` is exceeded with a probability of `1/x` at most.
    #[test]
    fn factor_is_a_ratio_of_probabilities() {
        let magnitudes = ScaleMixture::above(3.0, 100.0);
        let all: Vec<_> = magnitudes.components().collect();
        let total: f64 = all.iter().map(|one| one.ln_weight.exp()).sum();
        let information = DMatrix::from_row_slice(2, 2, &[0.8, 0.3, 0.3, 0.2]);
        let root = information.clone().cholesky().expect("positive").unpack();
        let mut random = Pcg64::seed_from_u64(3);
        let mut factor = |scale: f64| {
            let mut white = || DVector::from_fn(2, |_, _| StandardNormal.sample(&mut random));
            let amplitudes: DVector<f64> = white() * scale;
            let score = &information * amplitudes + &root * white();
            Block::of(information.clone(), &score, &magnitudes).ln_factor - total.ln()
        };
        let draws = 4_000;
        let mean: f64 = all
            .iter()
            .map(|one| {
                let reciprocal: f64 = (0..draws).map(|_| (-factor(one.scale)).exp()).sum();
                one.ln_weight.exp() / total * reciprocal / f64::from(draws)
            })
            .sum();
        assert_close!(mean, 1.0, 0.1);
        let exceeding = (0..40_000).filter(|_| factor(0.0) > 10.0_f64.ln()).count();
        assert!(exceeding > 0 && exceeding < 4_000, "{exceeding}");
    }

    #[test]
    fn sum_of_exponentials_does_not_overflow() {
        assert_close!(log_sum([1000.0, 1000.0]), 1000.0 + 2.0_f64.ln(), 1e-12);
        assert_close!(log_sum([f64::NEG_INFINITY, -3.0]), -3.0, 1e-15);
        assert!(log_sum([]).is_infinite());
    }
}
