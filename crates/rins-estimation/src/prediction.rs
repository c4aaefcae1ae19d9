//! One-step prediction of held-out epochs, including the uncertainty of the parameters.

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector, SMatrix, SVector};

use crate::evidence::{Indefinite, pass};
use crate::linear::Linear;
use crate::noise_parameters::Noise;
use crate::step::SHOWN;

/// The measurement of an epoch compared with its prediction.
#[derive(Clone, Debug, PartialEq)]
pub struct EpochPrediction {
    /// The samples of the epoch.
    pub samples: Range<usize>,
    /// The whitened innovation: N(0, I) if the model is correct.
    pub innovation: SVector<f64, SHOWN>,
    /// The log-density of the measurement (log score) \[nats\].
    pub log_density: f64,
}

/// The posterior of the parameters, updated with every predicted epoch.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterPosterior {
    /// The mean of the parameters relative to the point of linearization, in SI units.
    offset: DVector<f64>,
    covariance: DMatrix<f64>,
}

impl ParameterPosterior {
    /// A distribution of the parameters with this mean relative to the point of linearization and this covariance, in SI
    /// units.
    ///
    /// # Panics
    /// If the dimensions differ.
    pub fn new(offset: DVector<f64>, covariance: DMatrix<f64>) -> Self {
        assert_eq!(
            covariance.shape(),
            (offset.len(), offset.len()),
            "a variance for each parameter"
        );
        Self { offset, covariance }
    }

    /// Predicts the epochs of a linearized run whose samples are `asked` for. Each prediction uses all earlier measurements
    /// of the run and the current distribution of the parameters, which the measurement of the epoch then updates. `places`
    /// gives the place of each of the run's parameters.
    ///
    /// By the chain rule the sum of the log-densities is the joint log-density, with the parameters integrated out.
    ///
    /// # Errors
    /// [`Indefinite`] if the covariance of an innovation is not positive definite.
    ///
    /// # Panics
    /// If there is not a place for each parameter of the run.
    pub fn predict(
        &mut self,
        linear: &Linear,
        noise: &Noise,
        places: &[usize],
        asked: impl Fn(&Range<usize>) -> bool,
    ) -> Result<Vec<EpochPrediction>, Indefinite> {
        assert_eq!(places.len(), linear.parameters, "a place for each parameter of the run");
        let constant = 0.5 * linear.shown() as f64 * std::f64::consts::TAU.ln();
        let mut all = Vec::new();
        pass(linear, noise, None, |epoch, filter, log_determinant| {
            let samples = epoch.samples.0..epoch.samples.1;
            if asked(&samples) {
                let (innovation, further) = self.learn(filter.whitened(), places)?;
                let log_density =
                    -0.5 * innovation.norm_squared() - log_determinant - further - constant;
                all.push(EpochPrediction { samples, innovation, log_density });
            }
            Some(())
        })?;
        Ok(all)
    }

    /// Updates the parameters with the whitened columns of an epoch, a row for each measurement. The result is the
    /// innovation, whitened with the uncertainty of the parameters included, and the resulting increase of half the
    /// log-determinant.
    fn learn(&mut self, whitened: &[f64], places: &[usize]) -> Option<(SVector<f64, SHOWN>, f64)> {
        let width = whitened.len() / SHOWN;
        let mut by_parameters = DMatrix::zeros(SHOWN, self.offset.len());
        for (part, row) in whitened.chunks_exact(width).enumerate() {
            for (&place, derivative) in places.iter().zip(&row[1..]) {
                by_parameters[(part, place)] += derivative;
            }
        }
        let residual = SVector::<f64, SHOWN>::from_fn(|part, _| whitened[part * width]);
        let mut innovation = -(&by_parameters * &self.offset) - residual;
        let mut across = &by_parameters * &self.covariance;
        let spread = &across * by_parameters.transpose();
        let spread = SMatrix::<f64, SHOWN, SHOWN>::from_iterator(spread.iter().copied());
        let both = SMatrix::identity() + (spread + spread.transpose()) * 0.5;
        let factor = Cholesky::new(both)?.unpack();
        factor.solve_lower_triangular_mut(&mut innovation);
        factor.solve_lower_triangular_mut(&mut across);
        self.offset += across.tr_mul(&innovation);
        self.covariance -= across.tr_mul(&across);
        let log_determinant = factor.diagonal().iter().map(|x| x.ln()).sum();
        Some((SVector::from_iterator(innovation.iter().copied()), log_determinant))
    }
}
