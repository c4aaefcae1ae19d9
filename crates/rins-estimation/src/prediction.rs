//! What is foretold of epochs that played no part in an estimate, by one that knows how well it knows its parameters.

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector, SMatrix, SVector};

use crate::evidence::{Indefinite, pass};
use crate::linear::Linear;
use crate::noise_parameters::Noise;
use crate::step::SHOWN;

/// What an epoch shows, against what was foretold of it.
#[derive(Clone, Debug, PartialEq)]
pub struct EpochPrediction {
    /// The samples of the epoch.
    pub samples: Range<usize>,
    /// The whitened innovation, N(0, I) if the model is right.
    pub innovation: SVector<f64, SHOWN>,
    /// The logarithm of the probability density of what was shown \[nats\].
    pub log_density: f64,
}

/// What is known of parameters, and learnt of them from every epoch that is foretold.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterPosterior {
    /// How far they are expected from where runs are linear, in SI units.
    offset: DVector<f64>,
    covariance: DMatrix<f64>,
}

impl ParameterPosterior {
    /// Parameters that are expected so far from where runs are linear, with this covariance, both in SI units.
    ///
    /// # Panics
    /// If there are not as many of both.
    pub fn new(offset: DVector<f64>, covariance: DMatrix<f64>) -> Self {
        assert_eq!(
            covariance.shape(),
            (offset.len(), offset.len()),
            "a variance for each parameter"
        );
        Self { offset, covariance }
    }

    /// How well those epochs of a linear run were foretold of which the samples are `asked` for, each from the run's noise and all
    /// that it showed before, and from what was known of the parameters, which it then adds to; `places` says which of
    /// these each one of the run is.
    ///
    /// One after the other, the densities make that of them all, the parameters integrated out.
    ///
    /// # Errors
    /// [`Indefinite`] if the noise makes no covariance.
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

    /// Takes what an epoch shows of the columns, whitened, a row a figure; the innovation, whitened with what is not
    /// known of the parameters, and half the logarithm of the determinant that this adds.
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
