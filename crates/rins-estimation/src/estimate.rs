//! A finished estimate and its queries.

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
    /// The parameter.
    pub parameter: FreeParameter,
    /// The run that it belongs to, counted from zero: the first of several that share it; `None` if all share it or there is
    /// only one run.
    pub run: Option<usize>,
    /// The mean of its prior.
    pub expected: f64,
    /// The estimate.
    pub value: f64,
    /// Its 1σ.
    pub sigma: f64,
}

/// One step of the iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// The largest component of the step, in sigmas.
    pub step: f64,
    /// The log marginal likelihood (parameters integrated out), up to a constant.
    pub log_likelihood: f64,
}

/// A finished estimate.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The parameters in the order of the model: those of the IMU first, then those of each run. [`Estimate::parameter`] holds
    /// the place in the model of the run that it belongs to, or of the first run that has it.
    pub parameters: Vec<Estimate>,
    /// Their covariance, in SI units. It includes the uncertainty of estimated noise parameters.
    pub covariance: DMatrix<f64>,
    /// The information of the data without the priors, linearized at the estimate.
    pub evidence: Evidence,
    /// The log marginal likelihood (parameters integrated out), up to a constant.
    pub log_likelihood: f64,
    /// The model of each run with the estimates as values, along the run's axes.
    pub models: Vec<Model>,
    /// The axes along which the parameters are named, relative to the sensors' own axes: those of the first run, unless
    /// [`Fit::along`] changed them.
    pub axes: SignedAxes,
    /// The axes of each run, relative to the sensors' own axes.
    pub run_axes: Vec<SignedAxes>,
    /// The noise of each run.
    pub noise: Vec<Noise>,
    /// Each run, linearized at the estimate.
    pub linear: Vec<Linear>,
    /// For each run, the deviations of its biases from the estimated ones, as additions to its parameters.
    pub(crate) moved: Vec<Vec<f64>>,
    /// The iterations.
    pub iterations: Vec<Iteration>,
    /// The approximate inverse Hessian at the estimated noise parameters, if they were estimated.
    pub(crate) inverse_curvature: Option<DMatrix<f64>>,
    /// The logarithm of the posterior widths of the bias instabilities relative to those of their priors, if they were
    /// estimated: what Laplace's approximation of the integral over them adds to the logarithm of their likelihood.
    pub ln_width: f64,
}

impl Fit {
    /// The parameter of this id, of the IMU or of the first run that has it.
    pub fn parameter(&self, id: &str) -> Option<&Estimate> {
        self.parameters.iter().find(|estimate| estimate.parameter.id == id)
    }

    /// The evidence on the parameters at these places about the estimate, with the others integrated out with their priors.
    ///
    /// `None` if the information is not finite.
    pub fn marginal_evidence(&self, kept: &[usize]) -> Option<Evidence> {
        let others = (0..self.parameters.len()).filter(|place| !kept.contains(place));
        let prior = |place: usize| {
            let Estimate { parameter, expected, value, .. } = &self.parameters[place];
            (place, parameter.sigma, expected - value)
        };
        self.evidence.marginal(kept, &others.map(prior).collect::<Vec<_>>())
    }

    /// The same fit with the other parameters marginalized: integrated out with their priors.
    ///
    /// The models and the linearized runs keep them.
    #[must_use]
    pub fn marginal(mut self, keep: impl Fn(&Estimate) -> bool) -> Self {
        let kept: Vec<usize> =
            (0..self.parameters.len()).filter(|&place| keep(&self.parameters[place])).collect();
        if kept.len() == self.parameters.len() {
            return self;
        }
        // The estimate was calculated with the same information.
        let Some(evidence) = self.marginal_evidence(&kept) else { return self };
        self.evidence = evidence;
        self.covariance = DMatrix::from_fn(kept.len(), kept.len(), |row, column| {
            self.covariance[(kept[row], kept[column])]
        });
        self.parameters = kept.iter().map(|&place| self.parameters[place].clone()).collect();
        self
    }

    /// A copy without the linearized runs, which of a log of a day are too large for one.
    #[must_use]
    pub fn without_linear(&self) -> Self {
        Self {
            parameters: self.parameters.clone(),
            covariance: self.covariance.clone(),
            evidence: self.evidence.clone(),
            models: self.models.clone(),
            run_axes: self.run_axes.clone(),
            noise: self.noise.clone(),
            linear: Vec::new(),
            moved: self.moved.clone(),
            iterations: self.iterations.clone(),
            inverse_curvature: self.inverse_curvature.clone(),
            ..*self
        }
    }

    /// The same fit with an additional unknown effect that changes the parameters by `moves` \[SI\] at its 1σ.
    ///
    /// # Panics
    /// If there is not one change for each parameter.
    #[must_use]
    pub fn with_unknown(mut self, moves: &DVector<f64>) -> Self {
        self.covariance += moves * moves.transpose();
        for (place, estimate) in self.parameters.iter_mut().enumerate() {
            estimate.sigma = self.covariance[(place, place)].sqrt();
        }
        self
    }

    /// The observability of the parameters with the noise of the fit.
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

    /// The whitened innovations of a run: each is N(0, I) if the model is correct.
    ///
    /// # Panics
    /// If there is no such run.
    pub fn innovations(&self, run: usize) -> Vec<SVector<f64, 6>> {
        innovations(&self.linear[run], &self.noise[run], &self.moved[run])
            .expect("the same filter has been run to find the estimate")
    }

    /// The model of the first run, with the estimates.
    pub fn model(&self) -> &Model {
        &self.models[0]
    }
}
