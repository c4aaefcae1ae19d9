//! The search for the most probable hypothesis.

use rayon::prelude::*;
use rins_bayes::{Block, Component, log_sum};

use crate::hypothesis::{Catalogue, Effect, Scored};
use crate::information::{Information, Solution};
use crate::variation::Variation;

/// A hypothesis is better if its score is larger by this.
const BETTER: f64 = 0.3;

/// The most moves that are scored in one round, beside what they would gain if all scales stayed.
const SCORED: usize = 4;

/// The most rounds.
const ROUNDS: usize = 30;

/// An effect beside a hypothesis, and what it gains if the scales of the others stay.
#[derive(Clone, Debug)]
pub(crate) struct Addition<'a> {
    pub(crate) effect: &'a Effect,
    /// The logarithm of its posterior odds.
    pub(crate) ln_odds: f64,
    /// The most probable scale.
    pub(crate) scale: f64,
}

/// All effects that a hypothesis does not exclude, the most probable first.
///
/// Where the parameter of an effect has random amplitudes in the hypothesis, their scale is integrated with the effect: it is smaller
/// where the effect is there.
pub(crate) fn additions<'a>(
    information: &Information,
    catalogue: &'a Catalogue,
    beside: &Scored,
) -> Option<Vec<Addition<'a>>> {
    let solved = beside.gram.solved(&beside.scales)?;
    let quantities = catalogue.mixtures.len();
    let spreads: Vec<Option<Vec<Spread<'_>>>> = (0..quantities)
        .map(|quantity| {
            let random = beside.effects.iter().rposition(|one| {
                one.quantity == quantity && one.variation.is_none_or(Variation::is_random)
            });
            random.and_then(|place| spreads(catalogue, beside, place))
        })
        .collect();
    let may = |effect: &&Effect| !beside.effects.iter().any(|own| own.excludes(effect));
    let of = |effect: &'a Effect| {
        let mixture = &catalogue.mixtures[effect.quantity];
        let block = |others: &Solution<'_>| {
            let (own, score) = information.beside(&effect.amplitudes(), others);
            Block::of(own, &score, mixture)
        };
        let (ln_factor, scale) = match &spreads[effect.quantity] {
            None => {
                let block = block(&solved);
                (block.ln_factor, block.scale)
            }
            Some(spreads) => {
                let each = spreads.iter().map(|spread| {
                    let block = block(&spread.solution);
                    (spread.ln_weight + block.ln_factor, block.scale)
                });
                let each: Vec<(f64, f64)> = each.collect();
                let best = each.iter().max_by(|a, b| a.0.total_cmp(&b.0));
                (log_sum(each.iter().map(|one| one.0)), best.map_or(1.0, |one| one.1))
            }
        };
        Addition { effect, ln_odds: ln_factor + effect.ln_prior, scale }
    };
    let mut all: Vec<Addition<'a>> = catalogue.effects.par_iter().filter(may).map(of).collect();
    all.sort_by(|a, b| b.ln_odds.total_cmp(&a.ln_odds));
    Some(all)
}

/// A hypothesis with another scale of its random amplitudes of one parameter.
struct Spread<'a> {
    /// The logarithm of the posterior probability of the scale.
    ln_weight: f64,
    solution: Solution<'a>,
}

/// One of so many neighboring scales of random amplitudes stands for all.
const COARSE: usize = 2;

/// The scales of the random amplitudes of one effect of a hypothesis.
fn spreads<'a>(catalogue: &Catalogue, of: &'a Scored, place: usize) -> Option<Vec<Spread<'a>>> {
    let scales: Vec<Component> =
        of.scales_of(catalogue, place)?.into_iter().step_by(COARSE).collect();
    let total = log_sum(scales.iter().map(|one| one.ln_weight));
    let spread = |one: &Component| {
        let mut scales = of.scales.clone();
        scales[place] = one.scale;
        let solution = of.gram.solved(&scales)?;
        Some(Spread { ln_weight: one.ln_weight - total, solution })
    };
    scales.iter().map(spread).collect()
}

/// The hypothesis of the largest score.
///
/// `None` if the information on no parameter is finite.
pub(crate) fn search(information: &Information, catalogue: &Catalogue) -> Option<Scored> {
    let mut current = Scored::of(information, catalogue, catalogue.always.clone())?;
    for _ in 0..ROUNDS {
        let Some(better) = best_move(information, catalogue, &current) else { break };
        current = better;
    }
    Some(current)
}

/// The best hypothesis with one effect more, one less, or another in its place, if it is better.
fn best_move(information: &Information, catalogue: &Catalogue, current: &Scored) -> Option<Scored> {
    let fixed = catalogue.always.len();
    // What each hypothesis is expected to score, with its effects.
    let mut moves: Vec<(f64, Vec<Effect>)> = Vec::new();
    let with_one = |base: &Scored| -> Vec<(f64, Vec<Effect>)> {
        let all = additions(information, catalogue, base).unwrap_or_default();
        let with = |one: &Addition<'_>| {
            let effects = base.effects.iter().cloned().chain([one.effect.clone()]).collect();
            (base.score + one.ln_odds, effects)
        };
        all.iter().take(SCORED).map(with).collect()
    };
    moves.extend(with_one(current));
    for place in fixed..current.effects.len() {
        let mut effects = current.effects.clone();
        effects.remove(place);
        let Some(without) = Scored::of(information, catalogue, effects) else { continue };
        moves.extend(with_one(&without));
        moves.push((without.score, without.effects));
    }
    moves.sort_by(|a, b| b.0.total_cmp(&a.0));
    let is_new = |effects: &Vec<Effect>| {
        effects.len() != current.effects.len()
            || !effects.iter().all(|one| current.effects.iter().any(|own| own.is(one)))
    };
    let scored = moves
        .into_iter()
        .map(|(_, effects)| effects)
        .filter(is_new)
        .take(SCORED)
        .filter_map(|effects| Scored::of(information, catalogue, effects));
    let best = scored.max_by(|a, b| a.score.total_cmp(&b.score))?;
    (best.score > current.score + BETTER).then_some(best)
}
