//! A finished estimate, and what is asked of it.

use nalgebra::{DMatrix, DVector, SVector};
use rins_frames::SignedAxes;
use rins_terms::{FreeParameter, Model};

use crate::evidence::innovations;
use crate::identifiability::{Alias, Identifiability, Unknown};
use crate::linear::Linear;
use crate::noise_parameters::Noise;
use crate::posterior::Evidence;

/// An estimated parameter, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// What it is.
    pub parameter: FreeParameter,
    /// The run that it belongs to, counted from zero, the first of several that share it; none if all do, or there is
    /// one only.
    pub run: Option<usize>,
    /// What it was expected to be.
    pub expected: f64,
    /// The estimate.
    pub value: f64,
    /// Its 1σ.
    pub sigma: f64,
}

/// One step of the iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// The largest of the steps, in sigmas.
    pub step: f64,
    /// The logarithm of the probability of the data, but for a constant.
    pub log_likelihood: f64,
}

/// A finished estimate.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The parameters, in the order of the model, those of the IMU first, then those of each run; [`Estimate::parameter`] has
    /// the place in the model of the run that it belongs to, or of the first run that has it.
    pub parameters: Vec<Estimate>,
    /// Their covariance, in SI units; where the noise was found, its own uncertainty is in it.
    pub covariance: DMatrix<f64>,
    /// What the data alone say, made linear about the estimate.
    pub evidence: Evidence,
    /// The logarithm of the probability of the data, the parameters integrated out, but for a constant.
    pub log_likelihood: f64,
    /// Each run's model with the estimates in it, along the run's axes.
    pub models: Vec<Model>,
    /// The axes along which the parameters are named, as they are picked from the sensors' own: the first run's, unless
    /// [`Fit::along`] said otherwise.
    pub axes: SignedAxes,
    /// Each run's axes, as they are picked from the sensors' own.
    pub run_axes: Vec<SignedAxes>,
    /// Each run's noise.
    pub noise: Vec<Noise>,
    /// Each run, made linear about the estimate.
    pub linear: Vec<Linear>,
    /// How the iteration went.
    pub iterations: Vec<Iteration>,
    /// The inverse of about the curvature where the noise was found, if it was looked for.
    pub(crate) inverse_curvature: Option<DMatrix<f64>>,
}

impl Fit {
    /// The parameter of this id, of the IMU or of the first run.
    pub fn parameter(&self, id: &str) -> Option<&Estimate> {
        self.parameters.iter().find(|estimate| estimate.parameter.id == id)
    }

    /// The same with the other parameters marginalized: integrated out with their priors.
    ///
    /// Models, and what is linear, keep them.
    #[must_use]
    pub fn marginal(mut self, keep: impl Fn(&Estimate) -> bool) -> Self {
        let (kept, others): (Vec<usize>, Vec<usize>) =
            (0..self.parameters.len()).partition(|&place| keep(&self.parameters[place]));
        if others.is_empty() {
            return self;
        }
        let prior = |place: usize| {
            let Estimate { parameter, expected, value, .. } = &self.parameters[place];
            (place, parameter.sigma, expected - value)
        };
        let others: Vec<(usize, f64, f64)> = others.into_iter().map(prior).collect();
        // An estimate was found with the same information.
        let Some(evidence) = self.evidence.marginal(&kept, &others) else { return self };
        self.evidence = evidence;
        self.covariance = DMatrix::from_fn(kept.len(), kept.len(), |row, column| {
            self.covariance[(kept[row], kept[column])]
        });
        self.parameters = kept.iter().map(|&place| self.parameters[place].clone()).collect();
        self
    }

    /// The same where something else is unknown that would move the parameters by so much \[SI\] at its 1σ.
    ///
    /// # Panics
    /// If there are not as many as parameters.
    #[must_use]
    pub fn with_unknown(mut self, moves: &DVector<f64>) -> Self {
        self.covariance += moves * moves.transpose();
        for (place, estimate) in self.parameters.iter_mut().enumerate() {
            estimate.sigma = self.covariance[(place, place)].sqrt();
        }
        self
    }

    /// What the data tell of the parameters, the noise being what was found.
    pub fn identifiability(&self) -> Identifiability {
        let unknown = |estimate: &Estimate| Unknown {
            id: estimate.parameter.id.clone(),
            model_id: self.models[0].id(estimate.parameter.term, estimate.parameter.parameter),
            run: estimate.run,
            unit: estimate.parameter.unit,
            sigma: estimate.parameter.sigma,
        };
        let unknowns = self.parameters.iter().map(unknown).collect();
        Identifiability::of(&self.evidence.information, unknowns)
    }

    /// The sum of the parameter at `place` and of others, each times its coefficient: value and 1σ, in SI units.
    pub fn sum(&self, place: usize, others: &[Alias]) -> (f64, f64) {
        let mut weights = DVector::zeros(self.parameters.len());
        weights[place] = 1.0;
        for alias in others {
            weights[alias.unknown] += alias.coefficient;
        }
        let values = self.parameters.iter().map(|estimate| estimate.value);
        let value = values.zip(&weights).map(|(value, weight)| value * weight).sum();
        let variance = (weights.transpose() * &self.covariance * &weights)[(0, 0)];
        (value, variance.max(0.0).sqrt())
    }

    /// The whitened innovations of a run: each N(0, I) if the model is right.
    ///
    /// # Panics
    /// If there is no such run.
    pub fn innovations(&self, run: usize) -> Vec<SVector<f64, 6>> {
        let none = vec![0.0; self.linear[run].parameters];
        innovations(&self.linear[run], &self.noise[run], &none)
            .expect("the same filter has been run to find the estimate")
    }

    /// The model of the IMU: what belongs to the sensors, and for the rest the first run's.
    pub fn model(&self) -> &Model {
        &self.models[0]
    }
}
