//! The causes of the best hypothesis, each with its alternatives.

use rins_bayes::{Block, log_sum};
use rins_estimation::{Estimate, Fit, Indefinite};
use rins_terms::{Model, Term};

use crate::case::Case;
use crate::evidence::{Family, Screen};
use crate::generic::is_generic;
use crate::hypothesis::{Departure, Effect, Hypothesis, Process, SOMETHING};
use crate::proposal::candidates::Candidate;
use crate::search::{Round, State, Tried};
use crate::verdict::cause::{Cause, Rival};

/// The probability of a credible set.
const CREDIBLE: f64 = 0.98;

/// The family-wise p-value is at most the reciprocal of the Bayes factor of anything against nothing (Markov's inequality); over
/// simulated runs it is this part of it.
const CALIBRATED: f64 = 0.02;

/// What fits worse than a cause by no more than this, in nats, is not distinguished from it, however improbable it is beforehand: twice
/// this is the difference of Akaike's criterion below which Burnham and Anderson (2002, section 2.6) call support considerable.
const ALIKE: f64 = 2.0;

/// An amplitude is not plausible if it is so many times the largest typical magnitude.
const PLAUSIBLE: f64 = 30.0;

/// The odds of what fits as well are not smaller, as a logarithm: one in a thousand. By more than that no plausible prior differs from
/// another; a fit was worse than the linear pass promised.
const LEAST_ODDS: f64 = -6.9;

/// Something in place of a cause.
struct Alternative {
    term: &'static Term,
    settings: Vec<f64>,
    /// The logarithm of its odds: against the cause once that is known, before against nothing.
    odds: f64,
    /// How well it fits, if that is known and its amplitude is plausible.
    likeness: Option<f64>,
}

impl Alternative {
    fn of(family: Family, list: &[Candidate]) -> Self {
        let best = family.best;
        Self {
            term: family.term,
            settings: list[best.candidate].chosen.settings.clone(),
            odds: family.score,
            likeness: (best.amplitude < PLAUSIBLE).then(|| likeness(&best.block)),
        }
    }
}

/// By how much a block of amplitudes raises the logarithm of the likelihood, less one for each of them (Akaike 1974).
fn likeness(block: &Block) -> f64 {
    0.5 * block.statistic - block.dof as f64
}

/// What the linear pass says of a part of a hypothesis, and of all that may stand in its place.
#[derive(Default)]
struct Linear {
    /// The logarithm of the odds of the part against nothing.
    own: f64,
    block: Option<Block>,
    others: Vec<Alternative>,
}

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
    /// The causes of a hypothesis: its effects in their order, then its processes, then its departures.
    pub(crate) fn causes_of(
        &self,
        before: &Fit,
        state: &State,
        round: &Round,
        tried: &[Tried],
    ) -> Result<Vec<Cause>, Indefinite> {
        let given = self.given.terms.len();
        let hypothesis = &state.hypothesis;
        let of_state = (self.given, state, tried);
        let mut causes = Vec::new();
        for (index, effect) in hypothesis.effects.iter().enumerate() {
            let parameters = state.fit.parameters.iter();
            let of = |one: &&Estimate| one.parameter.term == given + index;
            let linear = self.beside_effect(state, round, index);
            let mut cause = cause(Part::Effect(effect), of_state, linear);
            cause.parameters = parameters.filter(of).cloned().collect();
            causes.push(cause);
        }
        for &process in &hypothesis.open {
            let mut cause = cause(Part::Process(process), of_state, Linear::default());
            cause.parameters = vec![self.strength(&state.fit, process)?];
            causes.push(cause);
        }
        for (index, one) in hypothesis.departures.iter().enumerate() {
            let term = self.given.terms[one.term].term;
            let linear = self.beside_departure((before, state), round.terms, index)?;
            let mut cause = cause(Part::Departure(term, one), of_state, linear);
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

    /// What the linear pass says of an effect of a hypothesis, and of all other terms in its place.
    fn beside_effect(&self, state: &State, round: &Round, index: usize) -> Linear {
        let dropped = self.places(round, &[index]);
        let of = (&round.survey, self.imu, round.terms);
        let Some(screen) = Screen::of(of, &round.ln_priors, &dropped, &[]) else {
            return Linear::default();
        };
        let Some((own, block)) = self.own(state, round, index, &screen) else {
            return Linear::default();
        };
        Linear { own, block: Some(block), others: others(&screen, round, &state.hypothesis) }
    }

    /// What the linear pass without a departure says of it, and of all other terms in its place.
    fn beside_departure(
        &self,
        (before, state): (&Fit, &State),
        terms: usize,
        index: usize,
    ) -> Result<Linear, Indefinite> {
        let mut without = state.hypothesis.clone();
        let Departure { term, .. } = without.departures.remove(index);
        let Some(without) = self.fitted((before, state), without, terms, f64::INFINITY) else {
            return Ok(Linear::default());
        };
        let round = self.round(before, &without, terms)?;
        let of = (&round.survey, self.imu, terms);
        let Some(screen) = Screen::of(of, &round.ln_priors, &[], &[]) else {
            return Ok(Linear::default());
        };
        let own = round.list.iter().position(|one| one.departs == Some(term));
        let own = own.and_then(|place| screen.candidate(place, &round.list[place]));
        let Some(own) = own else { return Ok(Linear::default()) };
        let others = others(&screen, &round, &state.hypothesis);
        Ok(Linear { own: own.score, block: Some(own.block), others })
    }
}

/// All terms that a hypothesis does not have, where a part of it was dropped.
fn others(screen: &Screen<'_>, round: &Round, hypothesis: &Hypothesis) -> Vec<Alternative> {
    let families = screen.families(&round.list, |one| {
        let is_new = match one.departs {
            Some(term) => hypothesis.departures.iter().all(|own| own.term != term),
            None => hypothesis.effects.iter().all(|own| !own.instance.term.is(one.chosen.term)),
        };
        is_new && !is_generic(one.chosen.term)
    });
    families.into_iter().map(|family| Alternative::of(family, &round.list)).collect()
}

/// A part of a hypothesis as a cause; where a hypothesis was fitted, its score counts and not that of the linear pass.
fn cause(
    part: Part<'_>,
    (given, state, tried): (&Model, &State, &[Tried]),
    Linear { own, block, others: linear }: Linear,
) -> Cause {
    let hypothesis = &state.hypothesis;
    let mut without = None;
    let mut all: Vec<Alternative> = Vec::new();
    for other in tried.iter().filter(|other| !part.is_in(&other.hypothesis)) {
        let odds = other.score - state.score;
        // The same effect with another setting is no other part.
        let is_of = |one: &Part<'_>, hypothesis: &Hypothesis| {
            one.is_in(hypothesis)
                || hypothesis.parts(given).any(|own| own.term().is(one.term()) && !part.is(own))
        };
        let new: Vec<Part<'_>> =
            other.hypothesis.parts(given).filter(|one| !is_of(one, hypothesis)).collect();
        let lost = hypothesis.parts(given).filter(|one| !is_of(one, &other.hypothesis)).count();
        match &new[..] {
            [] if lost == 1 => without = Some(without.map_or(odds, |most: f64| most.max(odds))),
            // Several may stand in its place together.
            [_, ..] if new.len() <= 2 => {
                for one in new.into_iter().filter(|one| !one.term().is(part.term())) {
                    let (term, settings) = (one.term(), one.settings());
                    let fitted = Alternative { term, settings, odds, likeness: None };
                    match all.iter_mut().find(|known| known.term.is(term)) {
                        Some(known) if known.odds < odds => *known = fitted,
                        Some(_) => {}
                        None => all.push(fitted),
                    }
                }
            }
            _ => {}
        }
    }
    for one in linear {
        match all.iter_mut().find(|known| known.term.is(one.term)) {
            Some(known) => known.likeness = one.likeness,
            None => all.push(Alternative { odds: one.odds - own, ..one }),
        }
    }
    // Against nothing.
    let own = without.map_or(own, |odds| -odds - SOMETHING);
    all.sort_by(|a, b| b.odds.total_cmp(&a.odds));
    // Those that are more probable than a supposed effect are no evidence for it.
    let at_most = log_sum(all.iter().map(|one| one.odds.min(0.0)).chain([0.0]));
    Cause {
        term: part.term(),
        settings: part.settings(),
        sought: None,
        parameters: Vec::new(),
        ln_p: (CALIBRATED.ln() - own - at_most).min(0.0),
        dof: block.as_ref().map_or(1, |block| block.dof),
        gain: block.as_ref().map_or(own, |block| 0.5 * block.statistic),
        rivals: credible(all, block.as_ref().map(likeness)),
    }
}

/// Those of the alternatives, best first, that make up a credible set together with the cause, and those that fit no worse than it.
fn credible(all: Vec<Alternative>, own: Option<f64>) -> Vec<Rival> {
    let total = log_sum(all.iter().map(|one| one.odds).chain([0.0]));
    let mut mass = (-total).exp();
    let mut rivals = Vec::new();
    for Alternative { term, settings, odds, likeness } in all {
        let fits = likeness.zip(own).is_some_and(|(other, own)| other > own - ALIKE);
        let is_alike = fits && odds > LEAST_ODDS;
        if mass < CREDIBLE || is_alike {
            rivals.push(Rival { term, settings, odds });
        }
        mass += (odds - total).exp();
    }
    rivals
}
