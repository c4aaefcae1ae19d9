//! The search: moves on the current hypothesis, scored in the linear pass, the best of them fitted.

mod alternatives;
mod given;
mod moves;
mod refine;
pub(crate) mod sought;
mod state;

use rins_estimation::{Fit, Indefinite, NoiseKnowledge, NoiseParameters};
use rins_terms::SettingKind;

use crate::case::Case;
use crate::diagnosis::DiagnosisError;
use crate::evidence::survey::{RunNoise, Survey};
use crate::evidence::{Family, Screen};
use crate::hypothesis::{Hypothesis, Process, SOMETHING, USUAL};
use crate::proposal::candidates::{Candidate, candidates, has_frequency, number_of_terms};
use crate::proposal::dead_zone;
use crate::proposal::suggested::at_frequency;

pub(crate) use self::state::{State, Tried};

/// The most effects of a hypothesis: more of them stand for what the catalogue does not have.
pub(crate) const MOST_EFFECTS: usize = 8;

/// The most moves that are fitted in one round.
const FITTED: usize = 3;

/// A move whose linear score is worse than the current one by this many e-folds is not fitted: so much may be missing because
/// the noise is estimated again only in the fit. Over 60 blind trials a fit exceeded a linear score below zero by 1.2 at most.
const MARGIN: f64 = 2.0;

/// Nor is one whose linear score is worse than what was found by a fit by this and ...
const NEAR: f64 = 4.0;

/// ... this part of that gain.
const NEAR_PART: f64 = 0.15;

/// An effect without which the linear score falls by more is not dropped by a fit, ...
const NEEDED: f64 = 50.0;

/// ... but replaced by others that are worth at least this part of it in the linear pass: far from zero amplitudes that is wrong by
/// a part of so much. A latency of 60 ms on a ramp from rest came to 0.54 of an equivalent one.
const ALIKE: f64 = 0.5;

/// The most other effects that are fitted in its place.
const REPLACED: usize = 2;

/// A hypothesis is better if its score is larger by this.
const BETTER: f64 = 0.3;

/// A hypothesis whose score is larger by less is compared with the current one fitted anew.
const WEAK: f64 = 15.0;

/// The part of the prior of a bias instability for which each of the noises stands that are tried beside the estimated one.
const OTHER_WIDTH: f64 = 0.3;

/// The time of an event that was found is refined within half so many epochs.
const REACH: f64 = 4.0;

/// The most rounds.
const ROUNDS: usize = 20;

/// What one round of the search looks at.
pub(crate) struct Round {
    pub(crate) list: Vec<Candidate>,
    pub(crate) survey: Survey,
    /// The noises of the survey.
    pub(crate) noises: Vec<RunNoise>,
    /// The logarithms of the priors of the survey's noises.
    pub(crate) ln_priors: Vec<f64>,
    /// How many terms there are to choose from.
    pub(crate) terms: usize,
}

impl Round {
    /// The terms of which the runs show nothing: no direction of their parameters is known better from the runs than from its
    /// typical range.
    pub(crate) fn not_testable(&self) -> Vec<&'static str> {
        let Some(left) = self.survey.left(0, &[], &[]) else { return Vec::new() };
        let (mut seen, mut unseen): (Vec<&str>, Vec<&str>) = (Vec::new(), Vec::new());
        for (index, candidate) in self.list.iter().enumerate() {
            let id = candidate.chosen.term.id;
            if candidate.departs.is_some() || seen.contains(&id) {
                continue;
            }
            let (information, _) = left.block(&self.survey.of_candidate(index).concat());
            let is_seen = information.symmetric_eigenvalues().max() * USUAL * USUAL > 1.0;
            let ids = if is_seen { &mut seen } else { &mut unseen };
            if !ids.contains(&id) {
                ids.push(id);
            }
        }
        unseen.retain(|id| !seen.contains(id));
        unseen
    }
}

impl Case<'_> {
    /// The hypothesis of the largest score, the last round, and all hypotheses that were fitted.
    pub(crate) fn search(
        &self,
        before: &Fit,
        progress: &mut impl FnMut(&'static str),
    ) -> Result<(State, Round, Vec<Tried>), DiagnosisError> {
        let terms = self.families();
        let mut current = self.state(before.clone(), Hypothesis::default(), terms);
        let mut tried = vec![Tried::of(&current)];
        let mut rounds = 0;
        loop {
            let round = self.round(before, &current, terms)?;
            rounds += 1;
            let better = if rounds > ROUNDS {
                None
            } else {
                let better = self.best_move(before, (&current, &round), &mut tried)?;
                better.or_else(|| self.without_one(before, (&current, &round), &mut tried))
            };
            let Some(better) = better else { return Ok((current, round, tried)) };
            if better.score < current.score + WEAK
                && let Some(again) = self.again((before, &better), &current, terms)
            {
                tried.push(Tried::of(&again));
                current = again;
                if better.score <= current.score + BETTER {
                    continue;
                }
            }
            for effect in current.hypothesis.lacks(&better.hypothesis) {
                progress(effect.instance.term.id);
            }
            current = better;
        }
    }

    /// A hypothesis, fitted anew near a slightly better one, if that has a larger score: its noise may have been estimated from a
    /// worse start, so that any effect would gain.
    fn again(&self, near: (&Fit, &State), current: &State, terms: usize) -> Option<State> {
        let hypothesis = current.hypothesis.clone();
        let again = self.fitted(near, hypothesis, terms, f64::INFINITY)?;
        (again.score > current.score + BETTER).then_some(again)
    }

    /// The best of the moves on a hypothesis, fitted, if it is better.
    fn best_move(
        &self,
        before: &Fit,
        (current, round): (&State, &Round),
        tried: &mut Vec<Tried>,
    ) -> Result<Option<State>, DiagnosisError> {
        let moves = self.moves(before, current, round)?;
        // A single change first: two effects that nearly cancel promise in the linear pass what no fit keeps.
        let single = moves.iter().position(|one| one.added.len() < 2);
        let order =
            single.into_iter().chain((0..moves.len()).filter(|place| Some(*place) != single));
        let mut best: Option<State> = None;
        let mut promised = 0.0;
        let mut fitted = 0;
        for one in order.map(|place| &moves[place]) {
            // What was found counts; if it is more than the linear pass promised, others may be as well.
            let found = best.as_ref().map_or(0.0, |best| best.score - current.score);
            let found = found.min(promised).max(0.0);
            let least = (found - NEAR - NEAR_PART * found).max(-MARGIN);
            if fitted >= FITTED || one.gain < least {
                break;
            }
            let hypothesis = one.applied(&current.hypothesis);
            let is_known = tried.iter().any(|other| other.hypothesis.is(&hypothesis));
            if hypothesis.effects.len() > MOST_EFFECTS || is_known {
                continue;
            }
            fitted += 1;
            let least = best.as_ref().map_or(f64::NEG_INFINITY, |best| best.score - NEAR);
            let near = (before, current);
            let Some(state) = self.fitted(near, hypothesis, round.terms, least) else { continue };
            tried.push(Tried::of(&state));
            if best.as_ref().is_none_or(|other| state.score > other.score) {
                best = Some(state);
                promised = one.gain;
            }
        }
        Ok(best.filter(|state| state.score > current.score + BETTER))
    }

    /// The best hypothesis with one effect, process or departure less, or with another effect in place of a strong one, fitted, if it is
    /// better: far from zero amplitudes the linear pass may be wrong about what the data lose without an effect.
    fn without_one(
        &self,
        before: &Fit,
        (current, round): (&State, &Round),
        tried: &mut Vec<Tried>,
    ) -> Option<State> {
        let mut best: Option<State> = None;
        let effects = current.hypothesis.effects.len();
        let worth: Vec<f64> =
            (0..effects).map(|index| self.worth(current, round, &[index])).collect();
        let is_needed = |place: usize| worth.get(place).is_some_and(|worth| *worth > NEEDED);
        let without = current.hypothesis.without_one().enumerate();
        let mut others: Vec<Hypothesis> =
            without.filter(|(place, _)| !is_needed(*place)).map(|(_, other)| other).collect();
        for place in (0..effects).filter(|place| is_needed(*place)) {
            others.extend(self.replaced(current, round, (place, worth[place])));
        }
        for hypothesis in others {
            if tried.iter().any(|other| other.hypothesis.is(&hypothesis)) {
                continue;
            }
            let near = (before, current);
            let least = current.score - NEAR;
            let Some(state) = self.fitted(near, hypothesis, round.terms, least) else { continue };
            tried.push(Tried::of(&state));
            if best.as_ref().is_none_or(|other| state.score > other.score) {
                best = Some(state);
            }
        }
        best.filter(|state| state.score > current.score + BETTER)
    }

    /// The hypotheses with another effect in place of one that is worth this much.
    fn replaced(
        &self,
        current: &State,
        round: &Round,
        (place, worth): (usize, f64),
    ) -> Vec<Hypothesis> {
        let Hypothesis { effects, .. } = &current.hypothesis;
        let dropped = self.places(round, &[place]);
        let of = (&round.survey, self.imu, round.terms);
        let Some(screen) = Screen::of(of, &round.ln_priors, &dropped, &[]) else {
            return Vec::new();
        };
        let is_other = |one: &Candidate| {
            one.departs.is_none()
                && effects.iter().all(|effect| !effect.instance.term.is(one.chosen.term))
        };
        let families = screen.families(&round.list, is_other).into_iter();
        let alike =
            families.take_while(|family| family.score + SOMETHING > ALIKE * worth).take(REPLACED);
        let with = |family: Family| {
            let mut other = current.hypothesis.clone();
            let candidate = &round.list[family.best.candidate];
            other.effects[place] = candidate.effect(&family.best, self.imu);
            other
        };
        alike.map(with).collect()
    }

    /// The number of terms to choose from.
    fn families(&self) -> usize {
        number_of_terms(&candidates(self.runs, self.given))
    }

    /// The same case with these noise processes.
    pub(crate) fn with_processes(&self, processes: &[Process]) -> Self {
        let mut open = NoiseParameters::default();
        for process in processes {
            *process.slot(&mut open) = process.typical(self.imu);
        }
        let knowledge = match self.knowledge {
            NoiseKnowledge::Given(stated) => NoiseKnowledge::Given(stated),
            other if processes.is_empty() => NoiseKnowledge::Likely(other.sheet()),
            other => NoiseKnowledge::Open { stated: other.sheet(), open },
        };
        Self { knowledge, ..*self }
    }

    /// The linear pass about a hypothesis.
    fn round(&self, before: &Fit, current: &State, terms: usize) -> Result<Round, Indefinite> {
        let present = &current.fit;
        let mut list = candidates(self.runs, self.given);
        list.extend(Candidate::departures(self.given));
        let epoch = present.linear[0].mean_epoch();
        let jolts = self.jolts(present);
        list.extend(self.suggested(present, &jolts));
        for (effect, fitted) in current.hypothesis.effects.iter().zip(self.causes_in(present)) {
            let found = &effect.instance;
            let at: Vec<Candidate> =
                list.iter().filter_map(|candidate| candidate.at_the_time_of(found)).collect();
            for mut candidate in at {
                if !list.iter().any(|other| other.chosen == candidate.chosen) {
                    candidate.looks = (-effect.ln_settings).exp();
                    if let Some(place) = found.term.setting(SettingKind::Time) {
                        candidate.step = Some((place, REACH * epoch));
                    }
                    list.push(candidate);
                }
            }
            if dead_zone::is_true(fitted) {
                list.extend(dead_zone::with_another(fitted));
            }
            if has_frequency(found.term) {
                let at = at_frequency(found.settings[0]).into_iter();
                let looks = (-effect.ln_settings).exp();
                list.extend(at.map(|chosen| Candidate {
                    chosen,
                    looks,
                    step: None,
                    departs: None,
                }));
            }
        }
        let noises = self.noises_about(before, current);
        let survey = self.survey(present, &list, &noises)?;
        let ln_priors = self.ln_priors(current, &noises);
        Ok(Round { list, survey, noises, ln_priors, terms })
    }

    /// The noise of a hypothesis, weaker flicker, and what the noise would be if effects were dropped.
    fn noises_about(&self, before: &Fit, current: &State) -> Vec<RunNoise> {
        let mut noises: Vec<RunNoise> = self.noises(&current.fit);
        if !current.hypothesis.effects.is_empty() {
            noises.extend(self.between(before, &current.fit).into_iter().skip(2));
        }
        noises
    }

    /// The logarithms of the prior probabilities of the noises about a hypothesis: its own with the width of its posterior, each
    /// of the others for a part of the range of its bias instability.
    fn ln_priors(&self, current: &State, noises: &[RunNoise]) -> Vec<f64> {
        let knowledge = self.with_processes(&current.hypothesis.open).knowledge;
        let of = |(place, noise): (usize, &RunNoise)| {
            let width = if place == 0 { current.fit.ln_width } else { OTHER_WIDTH.ln() };
            current.fit.log_prior_of_noise(self.runs, knowledge, noise) + width
        };
        noises.iter().enumerate().map(of).collect()
    }
}
