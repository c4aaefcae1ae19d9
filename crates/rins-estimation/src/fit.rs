//! The batch solution: iterated least squares over one run or several.

use nalgebra::{DMatrix, DVector, SVector};
use rins_imu::ImuSpec;
use rins_terms::{Free, Model};

use crate::evidence::{Indefinite, innovations};
use crate::identifiability::{Alias, Identifiability, Unknown};
use crate::layout::Layout;
use crate::likely::likely_noise;
use crate::linear::{Linear, linearise};
use crate::posterior::{Evidence, Posterior};
use crate::run::Run;
use crate::strengths::{Noise, Strengths};

/// The most times that a run is made linear.
const MOST_ITERATIONS: usize = 20;

/// A step below this part of every sigma ends the iteration.
const CONVERGED: f64 = 1e-3;

/// What is known of the sensors' random errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoiseKnowledge {
    /// They are this strong.
    Given(Strengths),
    /// These strengths are a first guess, and the most likely ones are found from the data, those of
    /// the encoder and of the axis' wobble with them.
    Likely(Strengths),
}

/// Why no estimate was found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// There is no run.
    #[error("there is no run to estimate anything from")]
    NoRun,
    /// The model estimates nothing.
    #[error("the model leaves no parameter to be estimated")]
    NothingFree,
    /// The filter broke off.
    #[error(transparent)]
    Indefinite(#[from] Indefinite),
    /// The information is not finite.
    #[error("the data do not make a finite information matrix at iteration {iteration}")]
    NoInformation {
        /// Which iteration.
        iteration: usize,
    },
    /// The steps did not become small.
    #[error(
        "after {iterations} iterations the last step is still {step} sigma: the model is too far from these data"
    )]
    Diverged {
        /// How many iterations were made.
        iterations: usize,
        /// The largest of the last steps, in sigmas.
        step: f64,
    },
}

/// An estimated parameter, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// What it is.
    pub parameter: Free,
    /// The run that it belongs to, counted from zero; none if to the IMU and so to all, or if there is one only.
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
    /// The parameters, in the order of the model, those of the IMU first, then those of each run.
    pub parameters: Vec<Estimate>,
    /// Their covariance, in SI units; where the noise was found, its own uncertainty is in it.
    pub covariance: DMatrix<f64>,
    /// What the data alone say, made linear about the estimate.
    pub evidence: Evidence,
    /// The logarithm of the probability of the data, the parameters integrated out, but for a constant.
    pub log_likelihood: f64,
    /// Each run's model with the estimates in it.
    pub models: Vec<Model>,
    /// Each run's noise.
    pub noise: Vec<Noise>,
    /// Each run, made linear about the estimate.
    pub linear: Vec<Linear>,
    /// How the iteration went.
    pub iterations: Vec<Iteration>,
}

/// Estimates what `model` leaves free from `runs` of one IMU.
///
/// What belongs to the sensors is shared; what belongs to a run is estimated for each. The
/// values that the model has are what is expected, within the priors' sigmas. `progress` is told of every
/// iteration.
///
/// # Errors
/// [`FitError`] if there is nothing to do, or it does not converge.
pub fn fit(
    runs: &[Run],
    model: &Model,
    imu: &ImuSpec,
    knowledge: NoiseKnowledge,
    mut progress: impl FnMut(&Iteration),
) -> Result<Fit, FitError> {
    if runs.is_empty() {
        return Err(FitError::NoRun);
    }
    let free = model.free(imu);
    if free.is_empty() {
        return Err(FitError::NothingFree);
    }
    let (NoiseKnowledge::Given(strengths) | NoiseKnowledge::Likely(strengths)) = knowledge;
    let find_noise = matches!(knowledge, NoiseKnowledge::Likely(_));
    let mut problem = Problem::new(runs, model, free);
    let mut noise: Vec<Noise> = runs.iter().map(|run| Noise::on(&run.rig, &strengths)).collect();
    let mut iterations = Vec::new();
    let mut around = Vec::new();
    if find_noise {
        let sheet = noise.clone();
        problem.settle(Until::NearEnough, &mut noise, &mut iterations, &mut progress)?;
        let likely = likely_noise(&problem.linear, &sheet, &noise, |linear, noise| {
            let (_, posterior) = problem.posterior(linear, noise, iterations.len()).ok()?;
            Some(posterior.log_likelihood)
        });
        (noise, around) = (likely.noise, likely.around);
    }
    problem.settle(Until::Converged, &mut noise, &mut iterations, &mut progress)?;
    problem.finish(noise, &around, iterations)
}

/// When an iteration ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Until {
    /// The parameters no longer move by much, so that noise can be judged.
    NearEnough,
    /// They do not move.
    Converged,
}

/// Makes all noise as strong as the residuals, if these are stronger: a model that does not fit would chase them
/// from one end of the priors to the other.
fn calm(noise: &mut [Noise], evidence: &Evidence, posterior: &Posterior) {
    let factor = (posterior.square / evidence.figures as f64).sqrt();
    if factor <= 1.5 {
        return;
    }
    for noise in noise {
        let Noise { imu, wobble, encoder, .. } = noise;
        for strength in [&mut imu.gyro.white, &mut imu.accel.white, wobble, encoder] {
            *strength *= factor;
        }
    }
}

/// Runs, a model for each, and where each one's parameters stand among all.
struct Problem<'a> {
    runs: &'a [Run],
    models: Vec<Model>,
    free: Vec<Free>,
    /// All parameters: which of `free`, and of which run.
    all: Vec<(usize, Option<usize>)>,
    /// For each run the place among all of each of `free`.
    places: Vec<Vec<usize>>,
    expected: Vec<f64>,
    values: Vec<f64>,
    /// Each run, linear about these values.
    linear: Vec<Linear>,
}

impl<'a> Problem<'a> {
    fn new(runs: &'a [Run], model: &Model, free: Vec<Free>) -> Self {
        let Layout { all, places } = Layout::of(&free, runs.len());
        let value = |&(index, _): &(usize, Option<usize>)| {
            let Free { term, parameter, .. } = free[index];
            model.terms[term].values[parameter]
        };
        let expected: Vec<f64> = all.iter().map(value).collect();
        let models = vec![model.clone(); runs.len()];
        let values = expected.clone();
        let mut problem =
            Self { runs, models, values, expected, free, all, places, linear: Vec::new() };
        problem.linear = problem.linearised();
        problem
    }

    fn linearised(&self) -> Vec<Linear> {
        let free: Vec<(usize, usize)> =
            self.free.iter().map(|parameter| (parameter.term, parameter.parameter)).collect();
        self.runs
            .iter()
            .zip(&self.models)
            .map(|(run, model)| linearise(run, model, &free))
            .collect()
    }

    fn evidence(&self, linear: &[Linear], noise: &[Noise]) -> Result<Evidence, Indefinite> {
        let mut sum = Evidence::none(self.all.len());
        for ((linear, noise), places) in linear.iter().zip(noise).zip(&self.places) {
            sum.add(&Evidence::of(linear, noise)?, places);
        }
        Ok(sum)
    }

    fn posterior(
        &self,
        linear: &[Linear],
        noise: &[Noise],
        iteration: usize,
    ) -> Result<(Evidence, Posterior), FitError> {
        let evidence = self.evidence(linear, noise)?;
        let sigmas: Vec<f64> = self.all.iter().map(|&(index, _)| self.free[index].sigma).collect();
        let offsets: Vec<f64> = self
            .expected
            .iter()
            .zip(&self.values)
            .map(|(expected, value)| expected - value)
            .collect();
        let posterior = evidence.posterior(&sigmas, &offsets);
        let finite = posterior.filter(|posterior| posterior.log_likelihood.is_finite());
        Ok((evidence, finite.ok_or(FitError::NoInformation { iteration })?))
    }

    /// Goes from estimate to estimate.
    fn settle(
        &mut self,
        until: Until,
        noise: &mut [Noise],
        iterations: &mut Vec<Iteration>,
        progress: &mut impl FnMut(&Iteration),
    ) -> Result<(), FitError> {
        let most = match until {
            Until::NearEnough => MOST_ITERATIONS,
            Until::Converged => iterations.len() + MOST_ITERATIONS,
        };
        loop {
            let (evidence, posterior) = self.posterior(&self.linear, noise, iterations.len())?;
            let step = self.advance(&posterior);
            let iteration = Iteration { step, log_likelihood: posterior.log_likelihood };
            progress(&iteration);
            iterations.push(iteration);
            if until == Until::NearEnough {
                calm(noise, &evidence, &posterior);
                if step < 1.0 && iterations.len() > 1 {
                    return Ok(());
                }
            }
            if step < CONVERGED {
                return Ok(());
            }
            if iterations.len() >= most || !step.is_finite() {
                return Err(FitError::Diverged { iterations: iterations.len(), step });
            }
        }
    }

    /// Goes to the estimate; the largest step in sigmas.
    fn advance(&mut self, posterior: &Posterior) -> f64 {
        let mut largest = 0.0_f64;
        for (place, value) in self.values.iter_mut().enumerate() {
            *value += posterior.step[place];
            largest = largest.max((posterior.step[place] / posterior.sigma(place)).abs());
        }
        for (model, places) in self.models.iter_mut().zip(&self.places) {
            for (parameter, &place) in self.free.iter().zip(places) {
                model.terms[parameter.term].values[parameter.parameter] = self.values[place];
            }
        }
        self.linear = self.linearised();
        largest
    }

    fn finish(
        self,
        noise: Vec<Noise>,
        around: &[[Vec<Noise>; 2]],
        iterations: Vec<Iteration>,
    ) -> Result<Fit, FitError> {
        let (evidence, posterior) = self.posterior(&self.linear, &noise, iterations.len())?;
        // Flicker is shown by few figures: the covariance is the mean over what its strength might be, and
        // where the estimate would then be.
        let mut covariance = posterior.covariance.clone();
        for side in around.iter().flatten() {
            let (_, other) = self.posterior(&self.linear, side, iterations.len())?;
            let moved = &other.step - &posterior.step;
            covariance +=
                (&other.covariance - &posterior.covariance + &moved * moved.transpose()) / 6.0;
        }
        let estimate = |(place, &(index, run)): (usize, &(usize, Option<usize>))| Estimate {
            parameter: self.free[index].clone(),
            run,
            expected: self.expected[place],
            value: self.values[place],
            sigma: covariance[(place, place)].sqrt(),
        };
        Ok(Fit {
            parameters: self.all.iter().enumerate().map(estimate).collect(),
            covariance,
            evidence,
            log_likelihood: posterior.log_likelihood,
            models: self.models,
            noise,
            linear: self.linear,
            iterations,
        })
    }
}

impl Fit {
    /// The parameter of this id, of the IMU or of the first run.
    pub fn parameter(&self, id: &str) -> Option<&Estimate> {
        self.parameters.iter().find(|estimate| estimate.parameter.id == id)
    }

    /// What the data tell of the parameters, the noise being what was found.
    pub fn identifiability(&self) -> Identifiability {
        let unknown = |estimate: &Estimate| Unknown {
            id: estimate.parameter.id.clone(),
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
