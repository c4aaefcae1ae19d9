//! The causes of the best hypothesis, each with its alternatives.

use rins_bayes::{Block, log_sum};
use rins_estimation::{Estimate, Indefinite};
use rins_terms::{Model, Term};

use crate::case::Case;
use crate::evidence::Screen;
use crate::generic::is_generic;
use crate::hypothesis::{Departure, Effect, Hypothesis, Process, SOMETHING};
use crate::search::{Round, State, Tried};
use crate::verdict::cause::{Cause, Rival};

/// The probability of a credible set.
const CREDIBLE: f64 = 0.98;

/// The family-wise p-value is at most the reciprocal of the Bayes factor of anything against nothing (Markov's inequality); over
/// simulated runs it is this part of it.
const CALIBRATED: f64 = 0.02;

/// Something in place of a cause: the term, the logarithm of its odds against nothing, and its settings.
type Alternative = (&'static Term, f64, Vec<f64>);

/// A part of a hypothesis.
#[derive(Clone, Copy)]
enum Part<'a> {
    Effect(&'a Effect),
    Process(Process),
    Departure(&'static Term, &'a Departure),
}

impl Part<'_> {
    fn term(self) -> &'static Term {
        match self {
            Self::Effect(effect) => effect.instance.term,
            Self::Process(process) => process.term(),
            Self::Departure(term, _) => term,
        }
    }

    fn settings(self) -> Vec<f64> {
        match self {
            Self::Effect(effect) => effect.instance.settings.clone(),
            Self::Process(_) | Self::Departure(..) => Vec::new(),
        }
    }

    /// Whether two parts are one.
    fn is(self, other: Self) -> bool {
        self.term().is(other.term()) && self.settings() == other.settings()
    }

    fn is_in(self, hypothesis: &Hypothesis) -> bool {
        match self {
            Self::Effect(effect) => hypothesis.effects.iter().any(|own| own.is(effect)),
            Self::Process(process) => hypothesis.open.contains(&process),
            Self::Departure(_, departure) => hypothesis.departs(departure),
        }
    }
}

impl Hypothesis {
    fn parts<'a>(&'a self, given: &'a Model) -> impl Iterator<Item = Part<'a>> {
        let processes = self.open.iter().map(|process| Part::Process(*process));
        let departures =
            self.departures.iter().map(|one| Part::Departure(given.terms[one.term].term, one));
        self.effects.iter().map(Part::Effect).chain(processes).chain(departures)
    }
}

impl Case<'_> {
    /// The causes of a hypothesis: its effects in their order, then its processes.
    pub(crate) fn causes_of(
        &self,
        state: &State,
        round: &Round,
        tried: &[Tried],
    ) -> Result<Vec<Cause>, Indefinite> {
        let given = self.given.terms.len();
        let hypothesis = &state.hypothesis;
        let of_state = (self.given, state, tried);
        let mut causes = Vec::new();
        for (index, effect) in hypothesis.effects.iter().enumerate() {
            let (own, block, linear) = self.linear_alternatives(state, round, index);
            let parameters = state.fit.parameters.iter();
            let of = |one: &&Estimate| one.parameter.term == given + index;
            let mut cause = cause(Part::Effect(effect), of_state, own, linear);
            cause.parameters = parameters.filter(of).cloned().collect();
            if let Some(block) = block {
                (cause.dof, cause.gain) = (block.dof, 0.5 * block.statistic);
            }
            causes.push(cause);
        }
        for &process in &hypothesis.open {
            let mut cause = cause(Part::Process(process), of_state, 0.0, Vec::new());
            cause.parameters = vec![self.strength(&state.fit, process)?];
            causes.push(cause);
        }
        for one in &hypothesis.departures {
            let term = self.given.terms[one.term].term;
            let part = Part::Departure(term, one);
            let mut cause = cause(part, of_state, 0.0, Vec::new());
            let of = |estimate: &&Estimate| {
                let own = &estimate.parameter;
                own.term == one.term && one.parameters.contains(&own.parameter)
            };
            cause.parameters = state.fit.parameters.iter().filter(of).cloned().collect();
            cause.dof = one.parameters.len();
            causes.push(cause);
        }
        Ok(causes)
    }

    /// The score of an effect of a hypothesis in the linear pass, its block, and the scores of all other terms in its place.
    fn linear_alternatives(
        &self,
        state: &State,
        round: &Round,
        index: usize,
    ) -> (f64, Option<Block>, Vec<Alternative>) {
        let dropped = self.places(round, &[index]);
        let of = (&round.survey, self.imu, round.terms);
        let Some(screen) = Screen::of(of, &round.ln_priors, &dropped, &[]) else {
            return (0.0, None, Vec::new());
        };
        let Some((own, block)) = self.own(state, round, index, &screen) else {
            return (0.0, None, Vec::new());
        };
        let families = screen.families(&round.list, |one| {
            let others = &state.hypothesis.effects;
            others.iter().all(|effect| !effect.instance.term.is(one.chosen.term))
                && !is_generic(one.chosen.term)
        });
        let others = families.into_iter().map(|family| {
            let settings = round.list[family.best.candidate].chosen.settings.clone();
            (family.term, family.score, settings)
        });
        (own, Some(block), others.collect())
    }
}

/// A part of a hypothesis as a cause. `own` is its score in the linear pass, and `linear` are those of what may stand in its
/// place; where a hypothesis was fitted, its score counts.
fn cause(
    part: Part<'_>,
    (given, state, tried): (&Model, &State, &[Tried]),
    own: f64,
    linear: Vec<Alternative>,
) -> Cause {
    let hypothesis = &state.hypothesis;
    let mut without = None;
    let mut fitted: Vec<Alternative> = Vec::new();
    for other in tried.iter().filter(|other| !part.is_in(&other.hypothesis)) {
        let gain = other.score - state.score;
        // The same effect with another setting is no other part.
        let is_of = |one: &Part<'_>, hypothesis: &Hypothesis| {
            one.is_in(hypothesis)
                || hypothesis.parts(given).any(|own| own.term().is(one.term()) && !part.is(own))
        };
        let new: Vec<Part<'_>> =
            other.hypothesis.parts(given).filter(|one| !is_of(one, hypothesis)).collect();
        let lost = hypothesis.parts(given).filter(|one| !is_of(one, &other.hypothesis)).count();
        match &new[..] {
            [] if lost == 1 => without = Some(without.map_or(gain, |most: f64| most.max(gain))),
            // Several may stand in its place together.
            [_, ..] if new.len() <= 2 => {
                for one in new {
                    match fitted.iter_mut().find(|(term, ..)| term.is(one.term())) {
                        Some(known) if known.1 < gain => {
                            *known = (one.term(), gain, one.settings());
                        }
                        Some(_) => {}
                        None => fitted.push((one.term(), gain, one.settings())),
                    }
                }
            }
            _ => {}
        }
    }
    fitted.retain(|(term, ..)| !term.is(part.term()));
    for (term, score, settings) in linear {
        if !fitted.iter().any(|(known, ..)| known.is(term)) {
            fitted.push((term, score - own, settings));
        }
    }
    // Against nothing.
    let own = without.map_or(own, |gain| -gain - SOMETHING);
    fitted.sort_by(|a, b| b.1.total_cmp(&a.1));
    let total = log_sum(fitted.iter().map(|(_, odds, _)| *odds).chain([0.0]));
    // Those that are more probable than a supposed effect are no evidence for it.
    let at_most = log_sum(fitted.iter().map(|(_, odds, _)| odds.min(0.0)).chain([0.0]));
    let mut mass = (-total).exp();
    let mut rivals = Vec::new();
    for (term, odds, settings) in fitted {
        if mass >= CREDIBLE {
            break;
        }
        mass += (odds - total).exp();
        rivals.push(Rival { term, settings, odds });
    }
    Cause {
        term: part.term(),
        settings: part.settings(),
        sought: None,
        parameters: Vec::new(),
        ln_p: (CALIBRATED.ln() - own - at_most).min(0.0),
        dof: 1,
        gain: own,
        rivals,
    }
}
