//! The question put to some runs, and how an answer is tried.

use nalgebra::DMatrix;
use rins_estimation::{
    Fit, FitError, Indefinite, Noise, NoiseKnowledge, NoiseParameters, Run, fit, fit_approximately,
    fit_near,
};
use rins_imu::ImuSpec;
use rins_terms::{Model, TermInstance};

use crate::criticism::rounding::Rounding;
use crate::evidence::survey::{RunNoise, Survey};
use crate::proposal::candidates::{Candidate, duration};

/// Weaker flicker that is tried, as parts of what was found.
const WEAKER: [f64; 3] = [1.0, 0.25, 0.02];

/// What stays the same from one effect to the next.
#[derive(Clone, Copy)]
pub(crate) struct Case<'a> {
    pub(crate) runs: &'a [Run],
    pub(crate) given: &'a Model,
    pub(crate) imu: &'a ImuSpec,
    pub(crate) knowledge: NoiseKnowledge,
    /// What the sheet says of the noise; `knowledge` may ask for more.
    pub(crate) sheet: NoiseParameters,
    /// In how coarse steps the sensors read.
    pub(crate) rounding: &'a Rounding,
    pub(crate) fits: Fits,
}

/// How exact fits are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fits {
    /// As a result is.
    Exact,
    /// As the comparison of hypotheses needs.
    Approximate,
}

impl<'a> Case<'a> {
    pub(crate) fn new(
        runs: &'a [Run],
        given: &'a Model,
        imu: &'a ImuSpec,
        knowledge: NoiseKnowledge,
        rounding: &'a Rounding,
    ) -> Self {
        let sheet = knowledge.sheet();
        Self { runs, given, imu, knowledge, sheet, rounding, fits: Fits::Exact }
    }
}

impl Case<'_> {
    /// The given model, fitted.
    pub(crate) fn fit(&self) -> Result<Fit, FitError> {
        fit(self.runs, self.given, self.imu, self.knowledge, |_| ())
    }

    /// The given model with causes, fitted where much the same has been; priors are about what was expected, not about
    /// what was found.
    pub(crate) fn fit_near(&self, near: &Fit, causes: &[TermInstance]) -> Result<Fit, FitError> {
        let mut model = self.given.clone();
        model.terms.extend(causes.iter().cloned());
        let fit = match self.fits {
            Fits::Exact => fit_near,
            Fits::Approximate => fit_approximately,
        };
        fit(near, self.runs, &model, self.imu, self.knowledge)
    }

    /// The same case with approximate fits.
    pub(crate) fn approximate(&self) -> Self {
        Self { fits: Fits::Approximate, ..*self }
    }

    /// The terms of a fit beyond the given ones.
    pub(crate) fn causes_in<'fit>(&self, fit: &'fit Fit) -> &'fit [TermInstance] {
        &fit.model().terms[self.given.terms.len()..]
    }

    /// How long the longest run is \[s\].
    pub(crate) fn duration(&self) -> f64 {
        duration(self.runs)
    }

    /// The noise that was found, and weaker flicker, which a further effect might have passed for.
    pub(crate) fn noises(&self, present: &Fit) -> Vec<RunNoise> {
        if !self.knowledge.is_estimated() {
            return vec![present.noise.clone()];
        }
        let ends = self.runs.iter().map(|run| &run.recording.times);
        let duration: f64 = ends.map(|times| times[times.len() - 1] - times[0]).sum();
        // Whether flicker is seen over white noise at the lowest frequency that the runs show.
        let shown = |flicker: f64, white: f64| {
            flicker * flicker * duration > 0.1 * std::f64::consts::TAU * white * white
        };
        let factors = |shown: bool| if shown { &WEAKER[1..] } else { &[] };
        let imu = present.noise[0].imu;
        let mut noises = vec![present.noise.clone()];
        let mut add = |of_gyro: f64, of_accel: f64| {
            let mut weaker = present.noise.clone();
            for noise in &mut weaker {
                noise.imu.gyro.flicker *= of_gyro;
                noise.imu.accel.flicker *= of_accel;
            }
            noises.push(weaker);
        };
        // One kind of sensor at a time: what passes for flicker of both is looked for in either.
        for &weaker in factors(shown(imu.gyro.flicker, imu.gyro.white)) {
            add(weaker, 1.0);
        }
        for &weaker in factors(shown(imu.accel.flicker, imu.accel.white)) {
            add(1.0, weaker);
        }
        noises
    }

    /// The noise found with all causes and with none, and that between them: what explains less leaves more to noise.
    pub(crate) fn between(&self, before: &Fit, after: &Fit) -> Vec<RunNoise> {
        let mut noises = vec![after.noise.clone()];
        if self.knowledge.is_estimated() && before.noise != after.noise {
            for part in [0.25, 0.5, 1.0] {
                let each = before.noise.iter().zip(&after.noise);
                noises.push(each.map(|(before, after)| mixed(after, before, part)).collect());
            }
        }
        noises
    }

    /// What the runs say of the estimates in a fit and of some candidates, for each of `noises`.
    pub(crate) fn survey(
        &self,
        fit: &Fit,
        list: &[Candidate],
        noises: &[RunNoise],
    ) -> Result<Survey, Indefinite> {
        let mut survey = Survey::of(self.runs, fit, self.imu, list, noises)?;
        survey.least_tilt = self.rounding.angle();
        Ok(survey)
    }
}

/// By how much the squares fell by the terms of a fit from `first` on, each fit with its own noise, and how many parameters these
/// have.
///
/// It is what the likelihood gained at its best, before what the prior takes from it: the logarithm of how much less is left
/// open.
pub(crate) fn gained(before: &Fit, after: &Fit, first: usize) -> (f64, usize) {
    let own: Vec<usize> = (0..after.parameters.len())
        .filter(|&place| after.parameters[place].parameter.term >= first)
        .collect();
    let known: f64 = own.iter().map(|&p| after.parameters[p].parameter.sigma.ln()).sum();
    let block = DMatrix::from_fn(own.len(), own.len(), |r, c| after.covariance[(own[r], own[c])]);
    let left: f64 = block.cholesky().map_or(known, |f| f.l_dirty().diagonal().map(f64::ln).sum());
    let gained = 2.0 * (after.log_likelihood - before.log_likelihood + known - left);
    (gained.max(0.0), own.len())
}

/// A noise between two, in logarithms.
fn mixed(one: &Noise, other: &Noise, part: f64) -> Noise {
    let mix = |a: f64, b: f64| if a > 0.0 && b > 0.0 { a * (b / a).powf(part) } else { a };
    let mut mixed = *one;
    for (to, from) in
        [(&mut mixed.imu.gyro, &other.imu.gyro), (&mut mixed.imu.accel, &other.imu.accel)]
    {
        to.white = mix(to.white, from.white);
        to.flicker = mix(to.flicker, from.flicker);
        to.walk = mix(to.walk, from.walk);
    }
    mixed.imu.jitter = mix(one.imu.jitter, other.imu.jitter);
    mixed.wobble = mix(one.wobble, other.wobble);
    mixed.encoder = mix(one.encoder, other.encoder);
    mixed.velocity = mix(one.velocity, other.velocity);
    mixed.turn = mix(one.turn, other.turn);
    for (to, from) in mixed.sway.iter_mut().zip(other.sway) {
        *to = mix(*to, from);
    }
    mixed
}
