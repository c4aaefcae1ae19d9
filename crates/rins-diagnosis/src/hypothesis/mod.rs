//! A hypothesis: which effects act beyond the given model, with their settings.

mod magnitude;
mod process;
mod support;

pub(crate) use magnitude::{magnitudes, magnitudes_of_departure};
pub(crate) use process::Process;
pub(crate) use support::{ABOUT_AXIS, Support, supports};

use rins_imu::ImuSpec;
use rins_terms::{Model, Role, Term, TermInstance};

use crate::proposal::candidates::Candidate;

/// Beside a prior that is not a mixture of scales, an amplitude may be so many times the largest typical magnitude (1σ).
pub(crate) const USUAL: f64 = 3.0;

/// The logarithm of the prior odds of any effect against none.
pub(crate) const SOMETHING: f64 = -1.0;

/// What a departure from a stated prior pays beyond an effect, in e-folds: what is stated holds as a rule.
pub(crate) const DEPARTURE: f64 = 2.0;

/// An effect of a hypothesis.
#[derive(Clone, Debug)]
pub(crate) struct Effect {
    /// The term, its settings, and which of its parameters are estimated.
    pub(crate) instance: TermInstance,
    /// The logarithm of the prior probability of its settings, to within what the runs resolve.
    pub(crate) ln_settings: f64,
}

impl Effect {
    /// Whether two effects are one: the same term with the same settings and the same parameters.
    pub(crate) fn is(&self, other: &Self) -> bool {
        self.instance.term.is(other.instance.term)
            && self.instance.settings == other.instance.settings
            && free(&self.instance) == free(&other.instance)
    }

    /// Its supports: where some of its parameters were left out already, all others together.
    pub(crate) fn supports(&self) -> Vec<Support> {
        let free = free(&self.instance);
        let mut all = supports(self.instance.term);
        all.retain(|one| free.len() == self.instance.values.len() || one.parameters == free);
        all
    }
}

/// The parameters of a term that are estimated.
pub(crate) fn free(instance: &TermInstance) -> Vec<usize> {
    let roles = instance.roles.iter().enumerate();
    roles.filter(|(_, role)| **role != Role::Held).map(|(parameter, _)| parameter).collect()
}

/// The places of each parameter of a term, given those of the ones that are estimated.
pub(crate) fn by_parameter(instance: &TermInstance, places: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut all = vec![Vec::new(); instance.values.len()];
    for (parameter, places) in free(instance).into_iter().zip(places) {
        all[parameter].clone_from(places);
    }
    all
}

/// Which effects and which noise processes act beyond the given model.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hypothesis {
    /// The effects.
    pub(crate) effects: Vec<Effect>,
    /// The noise processes.
    pub(crate) open: Vec<Process>,
    /// The stated priors that are too narrow.
    pub(crate) departures: Vec<Departure>,
}

/// A stated prior that is too narrow.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Departure {
    /// Which term of the given model.
    pub(crate) term: usize,
    /// Which of its parameters.
    pub(crate) parameters: Vec<usize>,
    /// How many times the stated 1σ the parameters spread.
    pub(crate) scale: f64,
    /// The logarithm of the prior probability of that.
    pub(crate) ln_prior: f64,
}

impl Hypothesis {
    /// Whether two hypotheses are one.
    pub(crate) fn is(&self, other: &Self) -> bool {
        self.lacks(other).next().is_none()
            && other.lacks(self).next().is_none()
            && self.open.len() == other.open.len()
            && self.open.iter().all(|one| other.open.contains(one))
            && self.departures.len() == other.departures.len()
            && self.departures.iter().all(|one| other.departs(one))
    }

    /// Whether it has this departure, of whatever size.
    pub(crate) fn departs(&self, departure: &Departure) -> bool {
        let is_same =
            |own: &Departure| own.term == departure.term && own.parameters == departure.parameters;
        self.departures.iter().any(is_same)
    }

    /// The given model with the priors that it has instead.
    pub(crate) fn given(&self, given: &Model, imu: &ImuSpec) -> Model {
        let mut model = given.clone();
        for Departure { term, parameters, scale, .. } in &self.departures {
            let chosen = &mut model.terms[*term];
            for &parameter in parameters {
                let stated = match chosen.roles[parameter] {
                    Role::Within(sigma) => sigma,
                    _ => chosen.term.parameters[parameter].sigma(imu),
                };
                chosen.roles[parameter] = Role::Within(stated * scale);
            }
        }
        model
    }

    /// The hypotheses that lack one of its effects, processes or departures.
    pub(crate) fn without_one(&self) -> impl Iterator<Item = Self> {
        let effects = (0..self.effects.len()).map(|place| {
            let mut other = self.clone();
            other.effects.remove(place);
            other
        });
        let processes = (0..self.open.len()).map(|place| {
            let mut other = self.clone();
            other.open.remove(place);
            other
        });
        let departures = (0..self.departures.len()).map(|place| {
            let mut other = self.clone();
            other.departures.remove(place);
            other
        });
        effects.chain(processes).chain(departures)
    }

    /// The effects of another hypothesis that this one does not have.
    pub(crate) fn lacks<'a>(&'a self, other: &'a Self) -> impl Iterator<Item = &'a Effect> {
        other.effects.iter().filter(|one| !self.effects.iter().any(|own| own.is(one)))
    }

    /// The logarithm of its prior probability relative to that of no effect and no process, among so many terms.
    pub(crate) fn ln_prior(&self, terms: usize) -> f64 {
        let of_effect =
            |one: &Effect| SOMETHING + ln_prior(one.instance.term, terms) + one.ln_settings;
        let of_process = |one: &Process| SOMETHING + ln_prior(one.term(), terms);
        let effects: f64 = self.effects.iter().map(of_effect).sum();
        let departures: f64 = self.departures.iter().map(|one| SOMETHING + one.ln_prior).sum();
        effects + self.open.iter().map(of_process).sum::<f64>() + departures
    }
}

/// The logarithm of the prior probability of a term among so many, if something is there.
pub(crate) fn ln_prior(term: &Term, terms: usize) -> f64 {
    term.prevalence.ln_odds() - (terms as f64).ln()
}

/// The logarithm of the prior probability of a candidate's settings.
pub(crate) fn ln_settings(candidate: &Candidate) -> f64 {
    -candidate.looks.ln()
}
