//! The question put to some runs, and how an answer is tried.

use nalgebra::DMatrix;
use rins_estimation::{
    Fit, FitError, Indefinite, Noise, NoiseKnowledge, NoiseParameters, Run, fit, fit_approximately,
    fit_near,
};
use rins_imu::ImuSpec;
use rins_terms::{Model, Role, TermInstance};

use crate::candidates::{Candidate, duration};
use crate::dead_zone;
use crate::probability::ln_tail;
use crate::rounding::Rounding;
use crate::score::USUAL;
use crate::survey::{RunNoise, Survey};
use crate::trial::{Context, Trial, trials};

/// How many events, and such of at least this part of the best one's evidence, are searched for their time.
const REFINED: (usize, f64) = (3, 0.4);

/// What an event may lose whose time is one of a few, in e-folds of p and of its odds: between two such times a step in what
/// wanders loses half of its statistic.
const COARSE: f64 = 4.0;

/// How finely the time of an event is searched, in parts of the step between candidates.
const FINER: [f64; 3] = [0.125, 0.03, 0.0075];

/// What the noise that was found with an effect still to be named may have swallowed of it, in e-folds of p.
const SWALLOWED: f64 = 4.0;

/// Weaker flicker that is tried, as parts of what was found.
const WEAKER: [f64; 3] = [1.0, 0.25, 0.02];

/// A term of at most so many parameters is estimated whole: what the others of them are is not known to be nothing.
const WHOLE: usize = 6;

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

    /// The most likely of the effects that are significant, or may be with their own noise; events where they
    /// fit best.
    pub(crate) fn best(
        &self,
        present: &Fit,
        list: &[Candidate],
        tried: &[Trial],
        threshold: f64,
    ) -> Result<Option<(Candidate, Trial)>, Indefinite> {
        let likely = self.knowledge.is_estimated();
        let threshold = if likely { threshold + SWALLOWED } else { threshold };
        let is_significant = |trial: &Trial| trial.ln_p < threshold && trial.is_likely();
        let mut best = tried
            .iter()
            .find(|trial| is_significant(trial))
            .map(|first| (list[first.candidate].clone(), first.clone()));
        let worth = best.as_ref().map_or(f64::NEG_INFINITY, |(_, first)| {
            (REFINED.1 * first.evidence).min(first.evidence)
        });
        let events = tried.iter().filter(|trial| {
            let is_event = list[trial.candidate].step.is_some();
            let in_reach = trial.ln_p < threshold + COARSE && trial.odds() > -COARSE;
            is_event && in_reach && trial.evidence >= worth
        });
        for event in events.take(REFINED.0) {
            let refined = self.refined(present, &list[event.candidate], event)?;
            let is_better = |(_, best): &(_, Trial)| refined.1.evidence > best.evidence;
            if is_significant(&refined.1) && best.as_ref().is_none_or(is_better) {
                best = Some(refined);
            }
        }
        let Some(mut best) = best else { return Ok(None) };
        if dead_zone::is_of_widths(&best.0.chosen) {
            best = self.with_further_gyros(present, best)?;
        }
        Ok(Some(best))
    }

    /// An event when it fits best, and what settles as slowly as fits best.
    fn refined(
        &self,
        present: &Fit,
        candidate: &Candidate,
        trial: &Trial,
    ) -> Result<(Candidate, Trial), Indefinite> {
        let mut best = (candidate.clone(), trial.clone());
        let noises = self.noises(present);
        for part in FINER {
            let list = best.0.neighbours(part);
            let survey = self.survey(present, &list, &noises)?;
            let Some(context) = Context::of(&survey, &[], &[]) else { break };
            for found in trials(&survey, &context, &list) {
                if found.evidence > best.1.evidence {
                    best = (list[found.candidate].clone(), found);
                }
            }
        }
        Ok(best)
    }

    /// A dead zone with those of further gyros, each as wide as fits best.
    fn with_further_gyros(
        &self,
        present: &Fit,
        mut best: (Candidate, Trial),
    ) -> Result<(Candidate, Trial), Indefinite> {
        let noises = self.noises(present);
        loop {
            let zone = dead_zone::of_shape(&best.0.chosen, &best.1.parameters);
            let list = dead_zone::with_another(&zone);
            let survey = self.survey(present, &list, &noises)?;
            let Some(context) = Context::of(&survey, &[], &[]) else { return Ok(best) };
            match trials(&survey, &context, &list).into_iter().next() {
                Some(found) if found.parameters.len() > best.1.parameters.len() => {
                    best = (list[found.candidate].clone(), found);
                }
                _ => return Ok(best),
            }
        }
    }

    /// The logarithm of the chance of a trial, once its effect has been fitted with its own noise: the last term
    /// of `after`.
    pub(crate) fn ln_p(&self, before: &Fit, after: &Fit, trial: &Trial) -> f64 {
        if let NoiseKnowledge::Given(_) = self.knowledge {
            return trial.ln_p;
        }
        let last = after.model().terms.len() - 1;
        let (gained, own) = gained(before, after, last);
        // Where all of an effect was estimated, nothing of it was chosen.
        let is_whole = after.model().terms[last].values.len() <= WHOLE;
        let (dof, looks) = if is_whole && own > trial.dof {
            (own, trial.looks - trial.choices)
        } else {
            (trial.dof, trial.looks)
        };
        (ln_tail(gained, dof) + looks).min(trial.ln_p)
    }
}

impl Candidate {
    /// The term to be estimated, its amplitudes expected within what the trial found them to need.
    pub(crate) fn expecting(&self, trial: &Trial, imu: &ImuSpec) -> TermInstance {
        if dead_zone::is_of_widths(&self.chosen) {
            let mut zone = dead_zone::of_shape(&self.chosen, &trial.parameters);
            for &gyro in &trial.parameters {
                let usual = zone.term.parameters[gyro].sigma(imu);
                zone.roles[gyro] = Role::Within(USUAL * usual * trial.amplitude.max(1.0));
            }
            return zone;
        }
        let mut chosen = self.chosen.clone();
        let n = chosen.values.len();
        for parameter in 0..n {
            let usual = chosen.term.parameters[parameter].sigma(imu);
            if n <= WHOLE || trial.parameters.contains(&parameter) {
                chosen.roles[parameter] = Role::Within(USUAL * usual * trial.amplitude.max(1.0));
            } else {
                chosen.roles[parameter] = Role::Held;
            }
        }
        chosen
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
