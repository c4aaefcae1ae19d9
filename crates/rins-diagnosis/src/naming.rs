//! From what a model leaves unexplained to the effects that explain it.

use rayon::prelude::*;
use rins_estimation::{Estimate, Fit, FitError, Indefinite, Noise, NoiseKnowledge, Run, fit};
use rins_imu::ImuSpec;
use rins_terms::{Model, Term};

use crate::candidates::{Candidate, candidates};
use crate::probability::ln_tail;
use crate::screening::{Screened, screen};

/// The chance of naming anything where there is nothing, over the whole catalogue.
const FALSE_ALARMS: f64 = 0.01;

/// A rival is kept whose odds are no worse than one to this many e-folds: 1 to 33.
const RIVALS: f64 = 3.5;

/// How many effects are tried with the noise estimated anew beside each.
const TRIED: usize = 5;

/// The most effects that are looked for, one after the other.
const MOST_CAUSES: usize = 5;

/// An effect that might be what is wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Rival {
    /// The effect.
    pub term: &'static str,
    /// Its settings, in SI units.
    pub settings: Vec<f64>,
    /// The logarithm of its odds against the cause that is named first.
    pub odds: f64,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Cause {
    /// The effect that explains it best.
    pub term: &'static Term,
    /// Its settings, in SI units.
    pub settings: Vec<f64>,
    /// Its parameters as the final model has them.
    pub parameters: Vec<Estimate>,
    /// The logarithm of the probability that anything in the catalogue explains as much by chance.
    pub ln_p: f64,
    /// How many of its parameters' directions the run shows.
    pub dof: usize,
    /// By how much the logarithm of the probability of the data rises.
    pub gain: f64,
    /// The other effects that this run cannot tell from it, best first.
    pub rivals: Vec<Rival>,
}

/// A finished diagnosis.
#[derive(Clone, Debug)]
pub struct Diagnosis {
    /// What was found, strongest first; nothing is "adequate".
    pub causes: Vec<Cause>,
    /// The model as it was given.
    pub before: Fit,
    /// The model with the causes in it.
    pub after: Fit,
    /// The effects of which this run would show nothing.
    pub not_testable: Vec<&'static str>,
}

/// Why a run could not be diagnosed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DiagnosisError {
    /// The given model cannot be fitted.
    #[error("the model cannot be fitted to the run")]
    Fit(#[from] FitError),
    /// The candidates cannot be tried.
    #[error("the effects of the catalogue cannot be tried on the run")]
    Screening(#[from] Indefinite),
}

/// What stays the same from one effect to the next.
#[derive(Clone, Copy)]
struct Case<'a> {
    run: &'a Run,
    imu: &'a ImuSpec,
    knowledge: NoiseKnowledge,
}

/// A candidate as far as it has been tried.
struct Trial {
    candidate: Candidate,
    fit: Option<Fit>,
    dof: usize,
    ln_p: f64,
    gain: f64,
    evidence: f64,
}

/// Finds what `model` leaves unexplained in `run`, one effect after the other.
///
/// Where the noise is to be found it is found anew beside every effect that is tried: fitted without
/// the effect, it would have swallowed it. `progress` is told of every effect that is accepted.
///
/// # Errors
/// [`DiagnosisError`] if the model as given cannot be fitted.
pub fn diagnose(
    run: &Run,
    model: &Model,
    imu: &ImuSpec,
    knowledge: NoiseKnowledge,
    mut progress: impl FnMut(&'static str),
) -> Result<Diagnosis, DiagnosisError> {
    let case = Case { run, imu, knowledge };
    let before = case.fit(model)?;
    let mut present = before.clone();
    let mut causes: Vec<Cause> = Vec::new();
    let mut not_testable = None;
    while causes.len() < MOST_CAUSES {
        let list = candidates(run, present.model());
        let screened = case.screened_both_ways(&present, &list)?;
        not_testable.get_or_insert_with(|| unseen(&list, &screened));
        let tested = best_of_terms(&list, &screened).len();
        let mut trials = case.trials(&present, &list, &screened);
        for trial in &mut trials {
            trial.ln_p = (trial.ln_p + (tested as f64).ln()).min(0.0);
        }
        trials.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
        let Some(best) = trials.iter().position(|t| t.ln_p < FALSE_ALARMS.ln() && t.evidence > 0.0)
        else {
            break;
        };
        let rivals = rivals(&trials, best);
        let trial = trials.swap_remove(best);
        let Some(fitted) = trial.fit.or_else(|| case.refit(&present, &trial.candidate)) else {
            break;
        };
        progress(trial.candidate.chosen.term.id);
        causes.push(Cause {
            term: trial.candidate.chosen.term,
            settings: trial.candidate.chosen.settings,
            parameters: Vec::new(),
            ln_p: trial.ln_p,
            dof: trial.dof,
            gain: trial.gain,
            rivals,
        });
        present = fitted;
    }
    let given = model.terms.len();
    for (index, cause) in causes.iter_mut().enumerate() {
        let own = present.parameters.iter().filter(|p| p.parameter.term == given + index);
        cause.parameters = own.cloned().collect();
    }
    causes.sort_by(|a, b| a.ln_p.total_cmp(&b.ln_p));
    let not_testable = not_testable.unwrap_or_default();
    Ok(Diagnosis { causes, before, after: present, not_testable })
}

impl Case<'_> {
    fn fit(&self, model: &Model) -> Result<Fit, FitError> {
        fit(std::slice::from_ref(self.run), model, self.imu, self.knowledge, |_| ())
    }

    /// Candidates screened with the noise that was found, and with that of the data sheet.
    fn screened_both_ways(
        &self,
        present: &Fit,
        list: &[Candidate],
    ) -> Result<Vec<Vec<Screened>>, Indefinite> {
        let found = present.noise[0];
        let mut noises = vec![found];
        if let NoiseKnowledge::Likely(sheet) = self.knowledge {
            noises.push(Noise { imu: sheet, ..found });
        }
        noises.par_iter().map(|noise| screen(self.run, present, self.imu, noise, list)).collect()
    }

    /// The most likely effects; where the noise is to be found, each with its own.
    fn trials(&self, present: &Fit, list: &[Candidate], screened: &[Vec<Screened>]) -> Vec<Trial> {
        let looks = |one: &Screened| list[one.candidate].looks.ln();
        if let NoiseKnowledge::Given(_) = self.knowledge {
            let trial = |one: &&Screened| Trial {
                candidate: list[one.candidate].clone(),
                fit: None,
                dof: one.dof,
                ln_p: one.ln_p,
                gain: 0.5 * one.statistic - one.occam,
                evidence: one.evidence,
            };
            return best_of_terms(list, screened).iter().map(trial).collect();
        }
        let mut chosen: Vec<&Screened> = Vec::new();
        for one_way in screened {
            let mut best = best_of_terms(list, std::slice::from_ref(one_way));
            best.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
            for one in best.into_iter().take(TRIED).filter(|one| one.evidence > -1.0) {
                if !chosen.iter().any(|other| other.candidate == one.candidate) {
                    chosen.push(one);
                }
            }
        }
        chosen
            .par_iter()
            .filter_map(|one| {
                let candidate = &list[one.candidate];
                let fit = self.refit(present, candidate)?;
                let gain = fit.log_likelihood - present.log_likelihood;
                // What the likelihood gained at its best, before the prior's part is taken from it.
                let statistic = (2.0 * (gain + one.occam)).max(0.0);
                let ln_p = (ln_tail(statistic, one.dof) + looks(one)).min(0.0);
                let evidence = gain - looks(one);
                let candidate = candidate.clone();
                Some(Trial { candidate, fit: Some(fit), dof: one.dof, ln_p, gain, evidence })
            })
            .collect()
    }

    /// The present model with a candidate in it, fitted; none where that does not converge.
    fn refit(&self, present: &Fit, candidate: &Candidate) -> Option<Fit> {
        let mut model = present.model().clone();
        // Priors are about what was expected, not about what was found.
        for estimate in &present.parameters {
            let at = &estimate.parameter;
            model.terms[at.term].values[at.parameter] = estimate.expected;
        }
        self.fit(&model.with(candidate.chosen.clone())).ok()
    }
}

/// The best shape of every term that the run shows anything of.
fn best_of_terms<'a>(list: &[Candidate], screened: &'a [Vec<Screened>]) -> Vec<&'a Screened> {
    let mut best: Vec<&Screened> = Vec::new();
    for one in screened.iter().flatten().filter(|one| one.dof > 0) {
        let id = list[one.candidate].chosen.term.id;
        match best.iter_mut().find(|other| list[other.candidate].chosen.term.id == id) {
            Some(other) if other.evidence < one.evidence => *other = one,
            Some(_) => {}
            None => best.push(one),
        }
    }
    best
}

/// Terms of which no shape shows.
fn unseen(list: &[Candidate], screened: &[Vec<Screened>]) -> Vec<&'static str> {
    let mut ids = Vec::new();
    let seen =
        |id| screened.iter().flatten().any(|s| s.dof > 0 && list[s.candidate].chosen.term.id == id);
    for candidate in list {
        let id = candidate.chosen.term.id;
        if !ids.contains(&id) && !seen(id) {
            ids.push(id);
        }
    }
    ids
}

fn rivals(trials: &[Trial], best: usize) -> Vec<Rival> {
    let top = trials[best].evidence;
    let mut rivals: Vec<Rival> = trials
        .iter()
        .enumerate()
        .filter(|(place, trial)| *place != best && trial.evidence > top - RIVALS)
        .map(|(_, trial)| Rival {
            term: trial.candidate.chosen.term.id,
            settings: trial.candidate.chosen.settings.clone(),
            odds: trial.evidence - top,
        })
        .collect();
    rivals.sort_by(|a, b| b.odds.total_cmp(&a.odds));
    rivals
}
