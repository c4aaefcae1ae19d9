//! What explains the variations between runs: causes with their alternatives, and forecasts.

use rins_bayes::{Block, Component, log_sum};

use crate::conditions::{Conditions, Conduct};
use crate::error::HistoryError;
use crate::forecast::Forecast;
use crate::hypothesis::{Catalogue, Effect, Scored};
use crate::information::{Amplitudes, Gram, Information};
use crate::search::{Addition, additions};
use crate::variation::{Kind, Variation, of_units};

/// The family-wise false alarm rate. The Bayes factor of something against nothing exceeds `x` with a probability of at most `1/x` if
/// nothing is there (Markov's inequality), for each parameter: no calibration is needed.
const FALSE_ALARMS: f64 = 0.01;

/// The posterior probability of a credible set.
const CREDIBLE: f64 = 0.98;

/// A forecast is the mean over the most probable hypotheses and scales of this probability together.
const AVERAGED: f64 = 0.98;

/// The scales of a hypothesis stand for one another where each would be less probable than this.
const DISTINGUISHED: f64 = 0.002;

/// The most effects on one parameter whose scales are integrated together in a forecast.
const TOGETHER: usize = 2;

/// How parameters vary between runs.
#[derive(Clone, Debug)]
pub struct Explanation {
    ids: Vec<String>,
    information: Information,
    conduct: Conduct,
    catalogue: Catalogue,
    best: Option<Scored>,
    causes: Vec<Cause>,
    hypotheses: Vec<Weighted>,
}

/// A parameter that varies between runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Cause {
    /// The parameter.
    pub id: String,
    /// The way in which it varies.
    pub variation: Variation,
    /// Its amplitudes with their 1σ, in the unit of the parameter. Of what is not random, the change over all runs; of a warm-up, its value at power-on; of a polynomial, the
    /// coefficients of its Legendre polynomials; of what is random, the deviation of each group of runs.
    pub amplitudes: Vec<(f64, f64)>,
    /// The 1σ of random amplitudes, or the scale of the prior of the others, in the unit of the parameter.
    pub scale: f64,
    /// The logarithm of the p-value, family-wise over all parameters: the bound by Markov's inequality.
    pub ln_p: f64,
    /// The credible set: the most probable parameters and kinds in its place, with their posterior probabilities, itself among them.
    pub alternatives: Vec<Alternative>,
}

/// What may be there in the place of a cause.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// The parameter.
    pub id: String,
    /// The kind of its variation.
    pub kind: Kind,
    /// The posterior probability, if anything is there.
    pub probability: f64,
}

/// A hypothesis of a forecast: effects with scales, and the logarithm of its weight.
#[derive(Clone, Debug)]
struct Weighted {
    effects: Vec<Effect>,
    scales: Vec<f64>,
    /// The parameter of the effect that it has beside the best hypothesis, or in an effect's place.
    further: Option<usize>,
    ln_weight: f64,
}

/// The best hypothesis, or it without an effect.
struct Base<'a> {
    /// The place of the effect that it lacks.
    lacks: Option<usize>,
    scored: Scored,
    /// What may be added to it, the most probable first.
    additions: Vec<Addition<'a>>,
}

impl Explanation {
    pub(crate) fn of(
        ids: Vec<String>,
        (information, conduct, catalogue): (Information, Conduct, Catalogue),
        best: Option<Scored>,
    ) -> Self {
        let (causes, hypotheses) = (Vec::new(), Vec::new());
        let mut explanation =
            Self { ids, information, conduct, catalogue, best, causes, hypotheses };
        let bases = explanation.bases();
        (explanation.causes, explanation.hypotheses) =
            (explanation.found(&bases), explanation.weighted(&bases));
        explanation
    }

    /// The causes that are significant at 1 % over all parameters, the most significant first.
    pub fn causes(&self) -> &[Cause] {
        &self.causes
    }

    /// The predictive distribution of a parameter in a run under these conditions; `None` if no run observes the parameter.
    ///
    /// It is the mean over all hypotheses, weighted by their posterior probabilities, that nothing varies being one of them.
    ///
    /// # Errors
    /// [`HistoryError::Condition`] if the parameter depends on a condition that is not stated.
    ///
    /// # Panics
    /// If there is no such parameter.
    pub fn forecast(
        &self,
        quantity: usize,
        conditions: Conditions,
    ) -> Result<Option<Forecast>, HistoryError> {
        if !self.information.sees(quantity) {
            return Ok(None);
        }
        let conduct = self.conduct.with(&[conditions]);
        let run = conduct.all.len() - 1;
        let is_of = |one: &&Weighted| one.further.is_none_or(|further| further == quantity);
        let own: Vec<Weighted> = self.hypotheses.iter().filter(is_of).cloned().collect();
        let own = probable(own);
        let total = log_sum(own.iter().map(|one| one.ln_weight));
        let mut components = Vec::new();
        for one in &own {
            let Some(amplitudes) = extended(&one.effects, &conduct) else {
                return Err(self.lacking(quantity, &one.effects, &conduct));
            };
            let gram = self.information.gram(amplitudes.into_iter());
            let weight = (one.ln_weight - total).exp();
            for (part, scales) in self.scaled(quantity, one, (&gram, weight)) {
                let Some(solved) = gram.solved(&scales) else { continue };
                let (mean, variance) = solved.parameter(quantity, run);
                components.push((weight * part, mean, variance.max(0.0).sqrt()));
            }
        }
        let total: f64 = components.iter().map(|(weight, ..)| weight).sum();
        let unit = self.information.units[quantity];
        let about = self.information.about[quantity];
        let components = components
            .into_iter()
            .map(|(weight, mean, sigma)| (weight / total, about + unit * mean, unit * sigma));
        let components: Vec<_> = components.collect();
        Ok((!components.is_empty()).then_some(Forecast { components }))
    }

    /// The best hypothesis, and it without each of its effects, with what may be added to each.
    fn bases(&self) -> Vec<Base<'_>> {
        let Some(best) = &self.best else { return Vec::new() };
        let without = |place: usize| {
            let mut effects = best.effects.clone();
            effects.remove(place);
            Some((Some(place), Scored::of(&self.information, &self.catalogue, effects)?))
        };
        let fixed = self.catalogue.always.len();
        let all = std::iter::once(Some((None, best.clone())))
            .chain((fixed..best.effects.len()).map(without));
        let base = |(lacks, scored): (Option<usize>, Scored)| {
            let additions = additions(&self.information, &self.catalogue, &scored);
            Base { lacks, scored, additions: additions.unwrap_or_default() }
        };
        all.flatten().map(base).collect()
    }

    /// The hypotheses that matter: the best one, it with an effect more or less, and with another in an effect's place.
    fn weighted(&self, bases: &[Base<'_>]) -> Vec<Weighted> {
        let Some(best) = &self.best else { return Vec::new() };
        let mut all = Vec::new();
        for Base { lacks, scored, additions } in bases {
            let Scored { effects, scales, score, .. } = scored;
            let with = |Addition { effect, ln_odds, scale }: &Addition<'_>| Weighted {
                effects: effects.iter().chain([*effect]).cloned().collect(),
                scales: scales.iter().chain([scale]).copied().collect(),
                further: Some(effect.quantity),
                ln_weight: score + ln_odds,
            };
            // With the effect that it lacks it is the best hypothesis again.
            let is_new =
                |one: &&Addition<'_>| lacks.is_none_or(|place| !best.effects[place].is(one.effect));
            all.extend(additions.iter().filter(is_new).map(with));
            all.push(Weighted {
                effects: effects.clone(),
                scales: scales.clone(),
                further: None,
                ln_weight: *score,
            });
        }
        all
    }

    /// The scales of the effects on a parameter in a hypothesis of this weight, with the part of it that each has.
    fn scaled(
        &self,
        quantity: usize,
        one: &Weighted,
        (gram, weight): (&Gram, f64),
    ) -> Vec<(f64, Vec<f64>)> {
        let mut all = vec![(1.0, one.scales.clone())];
        let own = (0..one.effects.len()).rev();
        let own = own.filter(|&place| one.effects[place].quantity == quantity);
        for place in own.take(TOGETHER) {
            let Some((information, score)) = gram.alone(place, &one.scales) else { continue };
            let scales = Block::scales(information, &score, &self.catalogue.mixtures[quantity]);
            let total = log_sum(scales.iter().map(|one| one.ln_weight));
            let with = |(part, scales): &(f64, Vec<f64>), own: &Component| {
                let mut scales = scales.clone();
                scales[place] = own.scale;
                (part * (own.ln_weight - total).exp(), scales)
            };
            let mut more: Vec<(f64, Vec<f64>)> =
                all.iter().flat_map(|one| scales.iter().map(move |own| with(one, own))).collect();
            more.sort_by(|a, b| b.0.total_cmp(&a.0));
            let distinguished = more.iter().filter(|one| weight * one.0 > DISTINGUISHED).count();
            more.truncate(distinguished.max(1));
            all = more;
        }
        let total: f64 = all.iter().map(|one| one.0).sum();
        for one in &mut all {
            one.0 /= total;
        }
        all
    }

    /// Which condition a forecast lacks.
    fn lacking(&self, quantity: usize, effects: &[Effect], conduct: &Conduct) -> HistoryError {
        let lacks = |effect: &&Effect| {
            effect.variation.is_some_and(|variation| variation.columns(conduct).is_none())
        };
        let kind = effects.iter().find(lacks).and_then(|one| one.variation);
        let condition = match kind.map(Variation::kind) {
            Some(Kind::DriftSincePowerOn | Kind::WarmUp) => "time since power-on",
            Some(Kind::Linear | Kind::Quadratic | Kind::Cubic) => "temperature",
            Some(Kind::Hysteresis) => "direction of the temperature",
            _ => "date",
        };
        HistoryError::Condition { id: self.ids[quantity].clone(), condition }
    }

    /// The causes of the best hypothesis that are probable enough to be named.
    fn found(&self, bases: &[Base<'_>]) -> Vec<Cause> {
        let Some(best) = &self.best else { return Vec::new() };
        let causes = bases.iter().filter_map(|base| self.cause(best, base.lacks?, &base.additions));
        let mut causes: Vec<Cause> =
            causes.filter(|cause| cause.ln_p < FALSE_ALARMS.ln()).collect();
        causes.sort_by(|a, b| a.ln_p.total_cmp(&b.ln_p));
        causes
    }

    /// An effect of the best hypothesis, with all that may be there in its place.
    fn cause(&self, best: &Scored, place: usize, all: &[Addition<'_>]) -> Option<Cause> {
        let effect = &best.effects[place];
        let total = log_sum(all.iter().map(|one| one.ln_odds));
        // The odds of the parameters together against nothing are at most so many times those of one.
        let seen = (0..self.ids.len()).filter(|&at| self.information.sees(at)).count();
        let ln_p = ((seen as f64).ln() - total).min(0.0);
        let mut kinds: Vec<(usize, Kind, f64)> = Vec::new();
        for one in all {
            let Some(kind) = one.effect.variation.map(Variation::kind) else { continue };
            let ln_p = one.ln_odds - total;
            let known = kinds
                .iter_mut()
                .find(|(quantity, other, _)| *quantity == one.effect.quantity && *other == kind);
            match known {
                Some((_, _, sum)) => *sum = log_sum([*sum, ln_p]),
                None => kinds.push((one.effect.quantity, kind, ln_p)),
            }
        }
        kinds.sort_by(|a, b| b.2.total_cmp(&a.2));
        let mut alternatives = Vec::new();
        let mut mass = 0.0;
        for (quantity, kind, ln_p) in kinds {
            if mass >= CREDIBLE {
                break;
            }
            mass += ln_p.exp();
            let id = self.ids[quantity].clone();
            alternatives.push(Alternative { id, kind, probability: ln_p.exp() });
        }
        let solved = best.gram.solved(&best.scales)?;
        let unit = self.information.units[effect.quantity];
        let figures = solved.block(place).into_iter();
        Some(Cause {
            id: self.ids[effect.quantity].clone(),
            variation: effect.variation?,
            amplitudes: figures.map(|(x, var)| (unit * x, unit * var.max(0.0).sqrt())).collect(),
            scale: unit * best.scales[place],
            ln_p,
            alternatives,
        })
    }
}

/// The most probable of all hypotheses that make most of the probability.
fn probable(mut all: Vec<Weighted>) -> Vec<Weighted> {
    all.sort_by(|a, b| b.ln_weight.total_cmp(&a.ln_weight));
    let total = log_sum(all.iter().map(|one| one.ln_weight));
    let mut mass = 0.0;
    let kept = all.iter().take_while(|one| {
        let before = mass;
        mass += (one.ln_weight - total).exp();
        before < AVERAGED
    });
    let kept = kept.count();
    all.truncate(kept);
    all
}

/// The blocks of effects under more conditions; `None` if a condition is lacking.
fn extended(effects: &[Effect], conduct: &Conduct) -> Option<Vec<Amplitudes>> {
    let of = |effect: &Effect| {
        let columns = match effect.variation {
            Some(variation) => variation.columns(conduct)?,
            None => of_units(conduct)?,
        };
        Some(Amplitudes { quantity: effect.quantity, columns })
    };
    effects.iter().map(of).collect()
}
