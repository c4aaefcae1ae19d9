//! The moves on a hypothesis, scored in the linear pass.

use rins_bayes::Block;
use rins_estimation::{Fit, Indefinite, Linear};
use rins_terms::Term;

use crate::case::Case;
use crate::evidence::survey::RunNoise;
use crate::evidence::{Family, Scored, Screen};
use crate::generic::is_generic;
use crate::hypothesis::{
    DEPARTURE, Departure, Effect, Hypothesis, Process, SOMETHING, by_parameter, ln_prior,
};
use crate::proposal::candidates::{Candidate, has_frequency, has_room};
use crate::search::{MARGIN, Round, State};

/// How many terms are tried as the first of two.
const FIRSTS: usize = 6;

/// How many of the best terms of each kind of move are looked at.
const EACH: usize = 8;

/// A term of which the linear score is worse than this is not refined.
const PROMISING: f64 = -8.0;

/// How many terms with an event time are refined.
const REFINED: usize = 3;

/// The most lines and structures without a physical cause: what takes more of them is none of them, such as an effect that comes and
/// goes, and is described by what remains.
const MOST_PERIODIC: usize = 4;

/// What the choice of the parameters that depart from their stated prior, and of by how much, costs, in e-folds: one of seven
/// supports, and one of six scales.
const SUPPORT_AND_SCALE: f64 = 3.7;

/// The part of the prior of a process's density, and of the noise beside it, for which each noise stands that is tried with it.
const PROCESS_WIDTH: f64 = 0.06;

/// A change of a hypothesis.
#[derive(Clone, Debug, Default)]
pub(crate) struct Move {
    /// The effects that are dropped.
    pub(crate) dropped: Vec<usize>,
    /// The effects that are added.
    pub(crate) added: Vec<Effect>,
    /// The process that is added, or dropped if the hypothesis has it.
    pub(crate) toggled: Option<Process>,
    /// The stated prior that is too narrow.
    pub(crate) departs: Option<Departure>,
    /// The departure that is taken back.
    pub(crate) returns: Option<usize>,
    /// By how much the linear score rises.
    pub(crate) gain: f64,
}

impl Move {
    /// The hypothesis after the move.
    pub(crate) fn applied(&self, to: &Hypothesis) -> Hypothesis {
        let kept = to.effects.iter().enumerate().filter(|(index, _)| !self.dropped.contains(index));
        let kept = kept.map(|(_, effect)| effect.clone());
        let mut open = to.open.clone();
        match self.toggled {
            Some(process) if open.contains(&process) => open.retain(|one| *one != process),
            Some(process) => open.push(process),
            None => {}
        }
        let mut departures = to.departures.clone();
        if let Some(index) = self.returns {
            departures.remove(index);
        }
        departures.extend(self.departs.clone());
        Hypothesis { effects: kept.chain(self.added.iter().cloned()).collect(), open, departures }
    }
}

impl Case<'_> {
    /// All moves, best first.
    pub(crate) fn moves(
        &self,
        before: &Fit,
        state: &State,
        round: &Round,
    ) -> Result<Vec<Move>, Indefinite> {
        let mut moves = Vec::new();
        let count = state.hypothesis.effects.len();
        let mut sets: Vec<Vec<usize>> = vec![Vec::new()];
        sets.extend((0..count).map(|index| vec![index]));
        for one in 0..count {
            sets.extend((one + 1..count).map(|other| vec![one, other]));
        }
        for dropped in sets {
            self.moves_without(state, round, &dropped, &mut moves)?;
        }
        self.moves_of_processes(before, state, round, &mut moves)?;
        moves.extend(state.moves_of_departures());
        moves.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        Ok(moves)
    }

    /// The moves that drop these effects.
    fn moves_without(
        &self,
        state: &State,
        round: &Round,
        dropped: &[usize],
        moves: &mut Vec<Move>,
    ) -> Result<(), Indefinite> {
        let Round { list, survey, ln_priors, terms, .. } = round;
        let effects = &state.hypothesis.effects;
        let places = self.places(round, dropped);
        let of = (survey, self.imu, *terms);
        let Some(screen) = Screen::of(of, ln_priors, &places, &[]) else { return Ok(()) };
        let worth = self.worth(state, round, dropped);
        let drop = Move { dropped: dropped.to_vec(), ..Move::default() };
        if !dropped.is_empty() {
            moves.push(Move { gain: -worth, ..drop.clone() });
        }
        let mut model = self.given.clone();
        let kept = effects.iter().enumerate().filter(|(index, _)| !dropped.contains(index));
        model.terms.extend(kept.map(|(_, effect)| effect.instance.clone()));
        let duration = self.duration();
        let departures = &state.hypothesis.departures;
        let beyond = &model.terms[self.given.terms.len()..];
        let periodic = beyond.iter().filter(|one| is_periodic(one.term)).count();
        let admits = |one: &Candidate| match one.departs {
            Some(term) => departures.iter().all(|own| own.term != term),
            None => {
                has_room(&model, &one.chosen, duration)
                    && (periodic < MOST_PERIODIC || !is_periodic(one.chosen.term))
            }
        };
        let families = screen.families(list, admits);
        let is_new = |family: &&Family| {
            dropped.iter().all(|&index| !effects[index].instance.term.is(family.term))
        };
        let mut refined = 0;
        for family in families.iter().take(EACH) {
            let candidate = &list[family.best.candidate];
            // A setting between two that were tried may explain twice as much.
            let potential = family.score + 0.5 * family.best.block.statistic;
            let most = moves.iter().map(|one| one.gain).fold(-MARGIN, f64::max);
            let (candidate, scored, score) = if candidate.step.is_some()
                && refined < REFINED
                && potential + SOMETHING - worth > most
                && dropped.len() < 2
            {
                refined += 1;
                self.with_best_setting((state, round), &places, candidate, family)?
            } else {
                (candidate.clone(), family.best.clone(), family.score)
            };
            let gain = score + SOMETHING - worth;
            if let Some(term) = candidate.departs {
                let departs = Some(Departure {
                    term,
                    ln_prior: ln_prior(candidate.chosen.term, *terms)
                        - SUPPORT_AND_SCALE
                        - DEPARTURE,
                    scale: scored.block.scale,
                    parameters: scored.parameters,
                });
                moves.push(Move { departs, gain, ..drop.clone() });
                continue;
            }
            let mut effect = candidate.effect(&scored, self.imu);
            if candidate.step.is_some() {
                effect.ln_settings += score - scored.score;
            }
            moves.push(Move { added: vec![effect], gain, ..drop.clone() });
        }
        if dropped.len() > 1 {
            return Ok(());
        }
        // Two in place of one, or of none: neither may show alone.
        let of_effect = |family: &&Family| list[family.best.candidate].departs.is_none();
        for first in families.iter().filter(is_new).filter(of_effect).take(FIRSTS) {
            if first.score < PROMISING {
                break;
            }
            let taken = survey.of_candidate(first.best.candidate).concat();
            let Some(beside) = Screen::of(of, ln_priors, &places, &taken) else { continue };
            let admits = |one: &Candidate| {
                one.departs.is_none() && admits(one) && !one.chosen.term.is(first.term)
            };
            let seconds = beside.families(list, admits);
            let Some(second) = seconds.iter().find(|family| is_new(family)) else { continue };
            // The first is worth as much beside the second.
            let of_second = survey.of_candidate(second.best.candidate).concat();
            let Some(again) = Screen::of(of, ln_priors, &places, &of_second) else { continue };
            let index = first.best.candidate;
            let Some(scored) = again.candidate(index, &list[index]) else { continue };
            let together =
                (first.score + second.score).max(alone(&screen, list, second) + scored.score);
            let gain = together + 2.0 * SOMETHING - worth;
            let effect = |scored: &Scored| list[scored.candidate].effect(scored, self.imu);
            let added = vec![effect(&scored), effect(&second.best)];
            moves.push(Move { added, gain, ..drop.clone() });
        }
        Ok(())
    }

    /// The moves that add or drop a noise process, and with it effects that are not needed then.
    fn moves_of_processes(
        &self,
        before: &Fit,
        state: &State,
        round: &Round,
        moves: &mut Vec<Move>,
    ) -> Result<(), Indefinite> {
        if !self.knowledge.is_estimated() {
            return Ok(());
        }
        let own = &state.hypothesis;
        let Some(current) =
            Screen::of((&round.survey, self.imu, round.terms), &round.ln_priors, &[], &[])
        else {
            return Ok(());
        };
        let motion = state.fit.linear.iter().flat_map(Linear::motion);
        let fastest = motion.fold(0.0_f64, |most, (_, rate)| most.max(rate.abs()));
        let processes: Vec<Process> = Process::available(self.runs, &self.sheet)
            .into_iter()
            .filter(|one| *one != Process::Jitter || fastest > 0.0)
            .collect();
        let noises: Vec<Vec<RunNoise>> = processes
            .iter()
            .map(|process| {
                if own.open.contains(process) {
                    let mut all = process.closed(&state.fit.noise, self.duration(), fastest);
                    all.push(before.noise.clone());
                    all
                } else {
                    process.opened(&state.fit.noise, self.duration(), fastest)
                }
            })
            .collect();
        let mut survey = self.survey(&state.fit, &[], &noises.concat())?;
        for (process, noises) in processes.into_iter().zip(noises) {
            let of_process = survey.split_off(noises.len());
            let is_open = own.open.contains(&process);
            let toggled = Move { toggled: Some(process), ..Move::default() };
            let hypothesis = toggled.applied(own);
            let knowledge = self.with_processes(&hypothesis.open).knowledge;
            let of_noise = |noise: &RunNoise| {
                state.fit.log_prior_of_noise(self.runs, knowledge, noise) + PROCESS_WIDTH.ln()
            };
            let sign = if is_open { -1.0 } else { 1.0 };
            let prior = sign * (SOMETHING + ln_prior(process.term(), round.terms));
            let other = Round {
                list: Vec::new(),
                survey: of_process,
                ln_priors: noises.iter().map(of_noise).collect(),
                noises,
                terms: round.terms,
            };
            let of = (&other.survey, self.imu, round.terms);
            let Some(screen) = Screen::of(of, &other.ln_priors, &[], &[]) else { continue };
            let mut gain = screen.base - current.base + prior;
            let mut dropped: Vec<usize> = Vec::new();
            moves.push(Move { gain, ..toggled.clone() });
            // What the process explains as well goes, the least valuable first.
            loop {
                let rest = (0..own.effects.len()).filter(|index| !dropped.contains(index));
                let least = rest
                    .map(|index| {
                        let with = [&dropped[..], &[index]].concat();
                        (index, self.worth(state, &other, &with))
                    })
                    .min_by(|a, b| a.1.total_cmp(&b.1));
                let Some((index, worth)) = least else { break };
                let without = screen.base - current.base + prior - worth;
                if without < gain {
                    break;
                }
                gain = without;
                dropped.push(index);
                moves.push(Move { gain, dropped: dropped.clone(), ..toggled.clone() });
            }
        }
        Ok(())
    }

    /// What some effects of a hypothesis are worth, one beside the others: the logarithm of their odds against nothing.
    pub(crate) fn worth(&self, state: &State, round: &Round, dropped: &[usize]) -> f64 {
        let of = (&round.survey, self.imu, round.terms);
        let mut worth = 0.0;
        for (place, &index) in dropped.iter().enumerate() {
            let places = self.places(round, &dropped[place..]);
            let screen = Screen::of(of, &round.ln_priors, &places, &[]);
            let own = screen.and_then(|screen| self.own(state, round, index, &screen));
            // An effect of which nothing is seen costs its prior.
            let nothing = ln_prior(state.hypothesis.effects[index].instance.term, round.terms);
            worth += own.map_or(nothing, |(own, _)| own) + SOMETHING;
        }
        worth
    }

    /// The places of the parameters of some effects.
    pub(crate) fn places(&self, round: &Round, effects: &[usize]) -> Vec<usize> {
        let given = self.given.terms.len();
        effects.iter().flat_map(|index| round.survey.of_term(given + index).concat()).collect()
    }

    /// The score of an effect of a hypothesis once it has been dropped, and its block.
    pub(crate) fn own(
        &self,
        state: &State,
        round: &Round,
        index: usize,
        screen: &Screen<'_>,
    ) -> Option<(f64, Block)> {
        let effect = &state.hypothesis.effects[index];
        let places = round.survey.of_term(self.given.terms.len() + index);
        let own = by_parameter(&effect.instance, places);
        let shape = (&effect.instance, false);
        let scored = screen.scored(shape, &own, effect.ln_settings, &effect.supports());
        scored.map(|(score, _, block)| (score, block))
    }
}

impl State {
    /// The moves that take back a departure from a stated prior.
    fn moves_of_departures(&self) -> Vec<Move> {
        let mut moves = Vec::new();
        let fit = &self.fit;
        let sigmas: Vec<f64> = fit.parameters.iter().map(|one| one.parameter.sigma).collect();
        let expected: Vec<f64> =
            fit.parameters.iter().map(|one| one.expected - one.value).collect();
        let of = |sigmas: &[f64]| fit.evidence.log_likelihood(sigmas, &expected);
        for (index, one) in self.hypothesis.departures.iter().enumerate() {
            let mut stated = sigmas.clone();
            for (sigma, estimate) in stated.iter_mut().zip(&fit.parameters) {
                let free = &estimate.parameter;
                if free.term == one.term && one.parameters.contains(&free.parameter) {
                    *sigma /= one.scale;
                }
            }
            if let Some((with, without)) = of(&sigmas).zip(of(&stated)) {
                let gain = without - with - SOMETHING - one.ln_prior;
                moves.push(Move { returns: Some(index), gain, ..Move::default() });
            }
        }
        moves
    }
}

/// Whether a term may stand for a part of a structure in time or in the table angle.
fn is_periodic(term: &Term) -> bool {
    has_frequency(term) || is_generic(term)
}

/// The score of the best shape of a term alone.
fn alone(screen: &Screen<'_>, list: &[Candidate], family: &Family) -> f64 {
    let index = family.best.candidate;
    screen.candidate(index, &list[index]).map_or(f64::NEG_INFINITY, |one| one.score)
}
