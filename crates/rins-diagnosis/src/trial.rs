//! Candidates against each other: the best shape and choice of parameters of every effect.

use nalgebra::DVector;
use rayon::prelude::*;
use rins_terms::{Term, TermInstance, catalogue};

use crate::candidates::Candidate;
use crate::dead_zone;
use crate::disturbance;
use crate::probability::ln_tail;
use crate::score::{ABOUT_AXIS, Choice, Score, choices, scored};
use crate::survey::{Left, Survey};
use crate::timing::has_frequency;

/// A step that tilts the base by less than this part of what it turns it about the table's axis is a slip of the encoder.
const LEAST_ACROSS: f64 = 0.3;

/// By how many e-folds of odds the unknown has to be better than what is known.
pub(crate) const UNKNOWN: f64 = 10.0;

/// The same of an effect of any frequency: lines explain a little of all that is no line.
const OF_ANY_FREQUENCY: f64 = 3.0;

/// A shape of an effect with those of its parameters that are there.
#[derive(Clone, Debug)]
pub(crate) struct Trial {
    /// Which candidate.
    pub(crate) candidate: usize,
    /// Which of its parameters.
    pub(crate) parameters: Vec<usize>,
    /// The largest of their amplitudes, in units of what is usual.
    pub(crate) amplitude: f64,
    /// By how much the squares fall.
    pub(crate) statistic: f64,
    /// How many directions are shown.
    pub(crate) dof: usize,
    /// The logarithm of the number of shapes and choices among which it was found.
    pub(crate) looks: f64,
    /// The same of the choices of parameters alone.
    pub(crate) choices: f64,
    /// The logarithm of the odds for it, its shape and choice unknown.
    pub(crate) evidence: f64,
    /// What of these it lost by being smaller than what is looked for.
    pub(crate) slight: f64,
    /// What of these it lost by being able to follow much.
    pub(crate) pliable: f64,
    /// The logarithm of the probability of so large a statistic by chance, over all shapes and choices of the effect.
    pub(crate) ln_p: f64,
}

impl Trial {
    /// The logarithm of its odds against nothing, were it alone: what is small of its kind, or could follow much else, gives way
    /// to other effects by that and not to chance, which is asked for its significance.
    pub(crate) fn odds(&self) -> f64 {
        self.evidence + self.slight + self.pliable
    }

    /// Whether it is likelier than nothing.
    pub(crate) fn is_likely(&self) -> bool {
        self.odds() > 0.0
    }
}

/// What is left to say, for each strength of the noise, and the most likely of these.
pub(crate) struct Context<'a> {
    survey: &'a Survey,
    left: Vec<Left<'a>>,
    most: f64,
}

impl<'a> Context<'a> {
    /// With these of the model's parameters dropped, and these of the candidates' taken into it.
    pub(crate) fn of(survey: &'a Survey, dropped: &[usize], taken: &[usize]) -> Option<Self> {
        let left: Vec<Left<'_>> = (0..survey.noises())
            .into_par_iter()
            .map(|noise| survey.left(noise, dropped, taken))
            .collect::<Option<_>>()?;
        let most = left.iter().map(|left| left.log_likelihood).fold(f64::NEG_INFINITY, f64::max);
        Some(Self { survey, left, most })
    }

    /// Of one strength of the noise.
    pub(crate) fn drawn(survey: &'a Survey, left: Left<'a>) -> Self {
        Self { survey, most: left.log_likelihood, left: vec![left] }
    }

    /// The best choice of a candidate's parameters; `own` lists the places of each of them.
    ///
    /// None if the runs show nothing of it.
    pub(crate) fn trial(
        &self,
        candidate: usize,
        shape: &Candidate,
        own: &[Vec<usize>],
    ) -> Option<Trial> {
        let choices = choices(shape.chosen.term);
        let of_choices = (choices.len() as f64).ln();
        let looks = shape.looks.ln() + of_choices;
        let Prior { unlikely, pliable } = Prior::of(shape.chosen.term);
        let mut best: Option<Trial> = None;
        let mut least_ln_p = 0.0_f64;
        for Choice { parameters, unlikely: of_choice } in choices {
            let places: Vec<usize> = parameters.iter().flat_map(|&p| own[p].clone()).collect();
            let Some((score, statistic)) = self.scored(&places) else { continue };
            let sigmas = self.survey.sigmas(&places);
            let amplitudes = score.estimate.component_mul(&sigmas);
            let possible = self.survey.allows(&shape.chosen, &parameters, &amplitudes);
            let evidence = if possible {
                score.evidence - looks - unlikely - pliable - of_choice
            } else {
                f64::NEG_INFINITY
            };
            if possible {
                least_ln_p = least_ln_p.min(ln_tail(statistic, score.dof) + looks);
            }
            if best.as_ref().is_none_or(|best| evidence > best.evidence) {
                let Score { dof, amplitude, slight, .. } = score;
                best = Some(Trial {
                    candidate,
                    parameters,
                    amplitude,
                    statistic,
                    dof,
                    looks,
                    choices: of_choices,
                    evidence,
                    slight,
                    pliable,
                    ln_p: 0.0,
                });
            }
        }
        best.map(|best| Trial { ln_p: least_ln_p, ..best })
    }

    /// The score of some places with the noise that is most likely with them, and the statistic with that which
    /// makes it largest. None if nothing of them is shown.
    pub(crate) fn scored(&self, places: &[usize]) -> Option<(Score, f64)> {
        let mut best: Option<Score> = None;
        let mut statistic = 0.0_f64;
        for left in &self.left {
            let behind = left.log_likelihood - self.most;
            let (information, score) = left.block(places);
            let mut scored = scored(&information, &score);
            if scored.dof == 0 {
                continue;
            }
            statistic = statistic.max(scored.statistic + 2.0 * behind);
            scored.evidence += behind;
            if best.as_ref().is_none_or(|best| scored.evidence > best.evidence) {
                best = Some(scored);
            }
        }
        best.map(|best| (best, statistic))
    }
}

/// What the odds for an effect pay beforehand, in e-folds.
struct Prior {
    /// For being nothing that is known.
    unlikely: f64,
    /// For being able to follow much.
    pliable: f64,
}

impl Prior {
    fn of(term: &Term) -> Self {
        let is_known = !disturbance::is_one(term);
        let is_line = has_frequency(term);
        Self {
            unlikely: if is_known { 0.0 } else { UNKNOWN },
            pliable: if is_known && is_line { OF_ANY_FREQUENCY } else { 0.0 },
        }
    }
}

/// Two effects that explain most together, the one of `firsts` and the other of those that `is_second` beside it, in place
/// of what is `dropped`.
pub(crate) fn best_pair<'a>(
    survey: &Survey,
    list: &[Candidate],
    dropped: &[usize],
    firsts: impl Iterator<Item = &'a Trial>,
    is_second: impl Fn(&Trial) -> bool + Sync,
) -> Option<[Trial; 2]> {
    let id = |trial: &Trial| list[trial.candidate].chosen.term.id;
    let firsts: Vec<&Trial> = firsts.collect();
    let seconds: Vec<Option<Trial>> = firsts
        .par_iter()
        .map(|first| {
            let taken = survey.of_candidate(first.candidate).concat();
            let context = Context::of(survey, dropped, &taken)?;
            let other = |trial: &Trial| id(trial) != id(first) && is_second(trial);
            Some(trials(survey, &context, list).into_iter().find(other))
        })
        .collect::<Option<_>>()?;
    let mut best: Option<(f64, [Trial; 2])> = None;
    for (first, second) in firsts.into_iter().zip(seconds) {
        let Some(second) = second else { continue };
        let evidence = first.evidence + second.evidence;
        if best.as_ref().is_none_or(|(most, _)| evidence > *most) {
            best = Some((evidence, [first.clone(), second]));
        }
    }
    best.map(|(_, pair)| pair)
}

impl Survey {
    /// Whether a shape can have these amplitudes, in SI units.
    pub(crate) fn allows(
        &self,
        shape: &TermInstance,
        parameters: &[usize],
        amplitudes: &DVector<f64>,
    ) -> bool {
        let tilts = shape.term.is(&catalogue::BASE_TILT_STEP);
        let is_rounding = tilts && amplitudes.amax() < self.least_tilt;
        // What turns the base about the table's axis tilts it too.
        let across = parameters.iter().zip(amplitudes).filter(|(of, _)| **of != ABOUT_AXIS);
        let tilt = across.fold(0.0_f64, |most, (_, amplitude)| most.max(amplitude.abs()));
        let is_slip = tilts && tilt < LEAST_ACROSS * amplitudes.amax();
        let is_as_deep = !dead_zone::is_of_widths(shape)
            || dead_zone::is_as_deep(shape, parameters, amplitudes.as_slice());
        is_as_deep && !is_rounding && !is_slip
    }
}

/// The best shape of every term that the runs show anything of, most likely first.
pub(crate) fn trials(survey: &Survey, context: &Context<'_>, list: &[Candidate]) -> Vec<Trial> {
    let mut best: Vec<Trial> = Vec::new();
    for (index, candidate) in list.iter().enumerate() {
        let Some(trial) = context.trial(index, candidate, survey.of_candidate(index)) else {
            continue;
        };
        let id = candidate.chosen.term.id;
        match best.iter_mut().find(|other| list[other.candidate].chosen.term.id == id) {
            Some(other) => {
                let ln_p = other.ln_p.min(trial.ln_p);
                if other.evidence < trial.evidence {
                    *other = trial;
                }
                other.ln_p = ln_p;
            }
            None => best.push(trial),
        }
    }
    best.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    best
}
