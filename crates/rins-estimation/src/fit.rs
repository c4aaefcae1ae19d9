//! The batch solution: iterated least squares over one run or several.

mod curvature;
mod drift;
mod information;
mod priors;

use nalgebra::DMatrix;
use rins_frames::{Dcm, Table};
use rins_imu::ImuSpec;
use rins_terms::{FreeParameter, Model};

use self::drift::Sequence;
use crate::estimate::{Estimate, Fit, Iteration};
use crate::fit_error::FitError;
use crate::layout::{Joined, Layout, attitude_of};
use crate::likely::likely_noise;
use crate::linear::{Linear, Pieces, linearised};
use crate::noise_parameters::{Noise, NoiseKnowledge};
use crate::posterior::{Evidence, Posterior};
use crate::run::Run;
use crate::stride::{Bottom, Damping, Place, Stride, Until, leaves_little};
use crate::turn::{self, LinearTurn, Turning};

/// The largest number of linearizations of a run.
const MOST_ITERATIONS: usize = 20;

/// A step below this many sigmas is close enough to estimate the noise, and to calculate derivatives for every sample.
const NEAR: f64 = 1.0;

/// After a step of less than this many sigmas an approximate estimate has been reached: what is left is of its square.
const CLOSE: f64 = 0.1;

/// After a step of this many sigmas or more, the noise is estimated again: coarse derivatives led away from the estimate.
const FAR: f64 = 10.0;

/// The largest number of noise estimations.
const MOST_JUDGED: usize = 3;

/// Estimates the free parameters of `model` from `runs` of one IMU.
///
/// The model, and the ids of all parameters, are along the axes of the first run. Parameters of the sensors are shared;
/// parameters of a run are estimated for each run, or jointly for runs without a power cycle in between. The values in the
/// model are the means of the priors, and the sigmas are those of the parameters. `progress` is called after each iteration.
///
/// # Errors
/// [`FitError`] if there is nothing to estimate, or the iteration does not converge.
pub fn fit(
    runs: &[Run],
    model: &Model,
    imu: &ImuSpec,
    knowledge: NoiseKnowledge,
    progress: impl FnMut(&Iteration),
) -> Result<Fit, FitError> {
    fitted((runs, None), (model, Until::Converged), imu, knowledge, progress)
}

/// The same fit, started from the estimate `near` of a similar model from all or most of these runs, which saves iterations.
///
/// # Errors
/// [`FitError`] if there is nothing to estimate, or the iteration does not converge.
pub fn fit_near(
    near: &Fit,
    runs: &[Run],
    model: &Model,
    imu: &ImuSpec,
    knowledge: NoiseKnowledge,
) -> Result<Fit, FitError> {
    fitted((runs, Some(near)), (model, Until::Converged), imu, knowledge, |_| ())
}

/// The same fit to within a few percent of each sigma, for the comparison of models: with the coarse derivatives of
/// [`linearise_coarsely`](crate::linearise_coarsely), and a covariance to first order at the estimated noise.
///
/// # Errors
/// [`FitError`] if there is nothing to estimate, or the iteration does not converge.
pub fn fit_approximately(
    near: &Fit,
    runs: &[Run],
    model: &Model,
    imu: &ImuSpec,
    knowledge: NoiseKnowledge,
) -> Result<Fit, FitError> {
    fitted((runs, Some(near)), (model, Until::Approximate), imu, knowledge, |_| ())
}

fn fitted(
    (runs, near): (&[Run], Option<&Fit>),
    (model, until): (&Model, Until),
    imu: &ImuSpec,
    knowledge: NoiseKnowledge,
    mut progress: impl FnMut(&Iteration),
) -> Result<Fit, FitError> {
    if runs.is_empty() {
        return Err(FitError::NoRun);
    }
    let joined = Joined::of(model, &runs[0].axes, imu, runs);
    joined.refuse_number()?;
    let strengths = knowledge.sheet();
    let (find_noise, open) = (knowledge.is_estimated(), knowledge.open());
    let mut problem = Problem::new((runs, near), joined);
    let sheet: Vec<Noise> = runs.iter().map(|run| Noise::on(&run.rig, &strengths)).collect();
    let mut noise = sheet.clone();
    let mut iterations = Vec::new();
    let (mut around, mut inverse_curvature, mut ln_width) = (Vec::new(), None, 0.0);
    if find_noise {
        let inverse = near.and_then(|near| near.inverse_curvature.as_ref());
        if let (Some(near), Some(_)) = (near, inverse) {
            noise.clone_from(&near.noise);
        }
        inverse_curvature = inverse.cloned();
        problem.settle(Until::NearEnough, &mut noise, &mut iterations, &mut progress)?;
    }
    let mut judged = 0;
    let said = loop {
        if find_noise {
            let log_likelihood = |noise: &[Noise]| problem.log_likelihood(noise);
            let likely = likely_noise(
                &problem.linear,
                (&sheet, &open),
                &noise,
                inverse_curvature.as_ref(),
                log_likelihood,
            );
            (noise, around, ln_width) = (likely.noise, likely.around, likely.ln_width);
            inverse_curvature = Some(likely.inverse_curvature);
            judged += 1;
        }
        let earlier = iterations.len();
        problem.settle(until, &mut noise, &mut iterations, &mut progress)?;
        let said = problem.posterior(&problem.linear, &noise, iterations.len())?;
        // Noise estimated far from the final estimate may include what the parameters explain there.
        let was_near = iterations[earlier..].iter().all(|iteration| iteration.step < FAR);
        if !find_noise || judged == MOST_JUDGED || was_near && problem.fits(&said.0) {
            break said;
        }
    };
    let added = match until {
        Until::Converged => problem.beyond_first_order(&said.1, &noise, &around)?,
        _ => DMatrix::zeros(problem.values.len(), problem.values.len()),
    };
    let fit = problem.finish(said, added, noise, iterations)?;
    Ok(Fit { inverse_curvature, ln_width, ..fit })
}

/// Increases the noise to the level of the residuals if these are larger: an inadequate model would otherwise vary the
/// parameters over the full range of the priors.
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

/// Runs, a model for each, and the places of their parameters in the joint vector.
struct Problem<'a> {
    runs: &'a [Run],
    models: Vec<Model>,
    /// For each run, the free parameters of its model.
    free: Vec<Vec<(usize, usize)>>,
    layout: Layout,
    expected: Vec<f64>,
    values: Vec<f64>,
    /// Each run, linearized at these values, and the resolution of the derivatives.
    linear: Vec<Linear>,
    pieces: Pieces,
    /// The rotations between runs, linearized at these values.
    turns: Vec<LinearTurn>,
    /// The static intervals of each power cycle, between which the biases drift.
    sequences: Vec<Sequence>,
    damping: Damping,
    /// The additional covariance of an estimate that does not converge to one point.
    about: DMatrix<f64>,
}

impl<'a> Problem<'a> {
    fn new((runs, near): (&'a [Run], Option<&Fit>), joined: Joined) -> Self {
        let Joined { models, free, layout } = joined;
        let mut expected = vec![0.0; layout.all.len()];
        for (run, model) in models.iter().enumerate() {
            let places = layout.places[run].iter().zip(&layout.signs[run]);
            for (&(term, parameter), (&place, sign)) in free[run].iter().zip(places) {
                expected[place] = sign * model.terms[term].values[parameter];
            }
        }
        let values = expected.clone();
        let sequences = Sequence::all(runs, &models, &free);
        let about = DMatrix::zeros(values.len(), values.len());
        let mut problem = Self {
            runs,
            models,
            values,
            expected,
            free,
            layout,
            linear: Vec::new(),
            pieces: Pieces::Coarse,
            turns: Vec::new(),
            sequences,
            damping: Damping::none(),
            about,
        };
        if let Some(near) = near {
            problem.start_near(near);
        }
        problem.take_values(Pieces::Coarse);
        problem
    }

    /// Starts at the estimate of another fit, for the parameters that both estimate.
    fn start_near(&mut self, near: &Fit) {
        for (place, (free, run)) in self.layout.all.iter().enumerate() {
            let chosen = &self.models[run.unwrap_or(0)].terms[free.term];
            let same = |found: &&Estimate| {
                let other = &near.model().terms[found.parameter.term];
                found.parameter.id == free.id
                    && found.run == *run
                    && other.settings == chosen.settings
            };
            if let Some(found) = near.parameters.iter().find(same) {
                self.values[place] = found.value;
            }
        }
    }

    /// Sets the values in the models, and linearizes the runs there.
    fn take_values(&mut self, pieces: Pieces) {
        for (run, model) in self.models.iter_mut().enumerate() {
            let places = self.layout.places[run].iter().zip(&self.layout.signs[run]);
            for (&(term, parameter), (&place, sign)) in self.free[run].iter().zip(places) {
                model.terms[term].values[parameter] = sign * self.values[place];
            }
        }
        // Two linearizations of a run of a day exceed the memory.
        self.linear.clear();
        let runs = self.runs.iter().zip(&self.models).zip(&self.free);
        self.linear =
            runs.map(|((run, model), free)| linearised(run, model, free, pieces)).collect();
        self.pieces = pieces;
        let Self { runs, models, free, layout, .. } = self;
        self.turns = Turning { runs, models, free, layout }.linear();
    }

    /// Iterates to the estimate.
    fn settle(
        &mut self,
        until: Until,
        noise: &mut [Noise],
        iterations: &mut Vec<Iteration>,
        progress: &mut impl FnMut(&Iteration),
    ) -> Result<(), FitError> {
        let most = match until {
            Until::NearEnough => MOST_ITERATIONS,
            Until::Approximate | Until::Converged => iterations.len() + MOST_ITERATIONS,
        };
        self.about.fill(0.0);
        let stated = noise.first().map_or(1.0, |noise| noise.imu.accel.white);
        let mut visited = Vec::new();
        loop {
            let (evidence, posterior) = self.posterior(&self.linear, noise, iterations.len())?;
            let from = self.pieces;
            let squares = evidence.square + self.pull();
            visited.push(Place { squares, values: self.values.clone() });
            // The iteration scales all noise alike.
            let scaled = noise.first().map_or(1.0, |noise| noise.imu.accel.white) / stated;
            let misfit = scaled * (evidence.square / evidence.figures as f64).sqrt();
            if until == Until::NearEnough {
                calm(noise, &evidence, &posterior);
                if !iterations.is_empty() {
                    turn::calm(&self.turns, &self.linear, noise);
                }
            }
            let stride = self.advance(&posterior, until);
            let step = stride.to_estimate;
            let iteration = Iteration { step, log_likelihood: posterior.log_likelihood };
            progress(&iteration);
            iterations.push(iteration);
            let arrived = match until {
                Until::NearEnough => stride.is_over() || step < NEAR && iterations.len() > 1,
                Until::Approximate => stride.is_over() || step < CLOSE,
                Until::Converged => stride.is_over() && from == Pieces::Samples,
            };
            if arrived {
                return Ok(());
            }
            let is_last = iterations.len() >= most;
            if is_last
                && until != Until::NearEnough
                && let Some(Bottom { best, about }) = Bottom::of(&visited)
            {
                (self.values, self.about) = (best, about);
                self.take_values(until.pieces());
                return Ok(());
            }
            if is_last
                && until != Until::NearEnough
                && from == until.pieces()
                && let [.., before, last] = &iterations[..]
                && leaves_little([before.step, last.step], MOST_ITERATIONS)
            {
                return Ok(());
            }
            if is_last || !step.is_finite() {
                let (parameter, distance) = self.farthest();
                return Err(FitError::Diverged {
                    parameter,
                    distance,
                    iterations: iterations.len(),
                    step,
                    misfit,
                });
            }
        }
    }

    /// Takes a damped step toward the estimate.
    ///
    /// Derivatives are approximate on the way and exact at the end.
    fn advance(&mut self, posterior: &Posterior, until: Until) -> Stride {
        let before = self.values.clone();
        let sigmas = posterior.covariance.diagonal().map(f64::sqrt);
        let step = posterior.step.component_div(&sigmas);
        let stride = self.damping.stride(step);
        let taken = &posterior.step * stride.part;
        for (value, step) in self.values.iter_mut().zip(&taken) {
            *value += step;
        }
        for (free, places) in self.free.iter().zip(&self.layout.places) {
            // The derivative by an attitude refers to a rotation after that attitude.
            if let Some(attitude) = attitude_of(&self.models[0], free, places) {
                let turn = |of: &[f64]| {
                    Dcm::<Table, Table>::from_rotation_vector(
                        &attitude.map(|place| of[place]).into(),
                    )
                };
                let turned = (turn(&before) * turn(taken.as_slice())).rotation_vector();
                for (place, value) in attitude.into_iter().zip(&turned) {
                    self.values[place] = *value;
                }
            }
        }
        // Exact derivatives are kept: if coarse ones differ, as for an event within an epoch, it would alternate.
        let last = until == Until::Converged
            && (stride.to_estimate < NEAR || self.pieces == Pieces::Samples);
        self.take_values(if last { Pieces::Samples } else { Pieces::Coarse });
        stride
    }

    fn finish(
        self,
        (evidence, posterior): (Evidence, Posterior),
        added: DMatrix<f64>,
        noise: Vec<Noise>,
        iterations: Vec<Iteration>,
    ) -> Result<Fit, FitError> {
        let covariance = &posterior.covariance + &self.about + added;
        let moved = self.moved(&noise)?;
        let estimate = |(place, (free, run)): (usize, &(FreeParameter, Option<usize>))| Estimate {
            parameter: free.clone(),
            run: *run,
            expected: self.expected[place],
            value: self.values[place],
            sigma: covariance[(place, place)].sqrt(),
        };
        Ok(Fit {
            parameters: self.layout.all.iter().enumerate().map(estimate).collect(),
            covariance,
            evidence,
            log_likelihood: posterior.log_likelihood,
            models: self.models,
            axes: self.runs[0].axes,
            run_axes: self.runs.iter().map(|run| run.axes).collect(),
            noise,
            linear: self.linear,
            moved,
            iterations,
            inverse_curvature: None,
            ln_width: 0.0,
        })
    }
}
