//! A hypothesis: which parameters vary between runs, and in which way; and its score.

use nalgebra::DMatrix;
use rins_bayes::{Block, Component, ScaleMixture, log_sum};

use crate::conditions::Conduct;
use crate::information::{Amplitudes, Gram, Information};
use crate::variation::{Variation, of_units};

/// The logarithm of the prior odds that a parameter varies between runs in any way: as probable as not.
const VARIES: f64 = 0.0;

/// The scales of blocks that are estimated together are found one after the other, so many times over.
const SWEEPS: usize = 4;

/// One parameter varies in one way.
#[derive(Clone, Debug)]
pub(crate) struct Effect {
    /// Which parameter.
    pub(crate) quantity: usize,
    /// In which way; `None` for the spread of several units, which is always there.
    pub(crate) variation: Option<Variation>,
    /// What one of each amplitude adds in every run.
    pub(crate) columns: DMatrix<f64>,
    /// The logarithm of the prior probability.
    pub(crate) ln_prior: f64,
}

impl Effect {
    /// Whether two are one: the same parameter in the same way.
    pub(crate) fn is(&self, other: &Self) -> bool {
        self.quantity == other.quantity && self.variation == other.variation
    }

    /// Whether both cannot be in one hypothesis: one parameter has one drift, and one polynomial of temperature.
    pub(crate) fn excludes(&self, other: &Self) -> bool {
        let kinds = [self, other].map(|one| one.variation.map(Variation::kind));
        let polynomials =
            [self, other].map(|one| matches!(one.variation, Some(Variation::Temperature { .. })));
        let repeatable = kinds[0].is_some_and(crate::variation::Kind::is_repeatable);
        self.quantity == other.quantity
            && (self.variation == other.variation
                || polynomials == [true, true]
                || kinds[0] == kinds[1] && !repeatable)
    }

    /// The block of its amplitudes.
    pub(crate) fn amplitudes(&self) -> Amplitudes {
        Amplitudes { quantity: self.quantity, columns: self.columns.clone() }
    }
}

/// The parameters' priors, and all effects that may be.
#[derive(Clone, Debug)]
pub(crate) struct Catalogue {
    /// The scales of each parameter's variations, in units of the largest typical one.
    pub(crate) mixtures: Vec<ScaleMixture>,
    /// The effects that are always there: the spread of each parameter over the units.
    pub(crate) always: Vec<Effect>,
    /// All others.
    pub(crate) effects: Vec<Effect>,
}

impl Catalogue {
    /// All effects that runs under these conditions can show on what they observe.
    pub(crate) fn of(conduct: &Conduct, information: &Information, typical: &[(f64, f64)]) -> Self {
        let mixtures =
            typical.iter().map(|(low, high)| ScaleMixture::between(low / high, 1.0)).collect();
        let seen: Vec<usize> =
            (0..typical.len()).filter(|&place| information.sees(place)).collect();
        let spread = of_units(conduct);
        let always = |&quantity: &usize| {
            let columns = spread.clone()?;
            Some(Effect { quantity, variation: None, columns, ln_prior: 0.0 })
        };
        let variations = Variation::all(conduct);
        let mut kinds: Vec<_> = variations.iter().map(|one| one.kind()).collect();
        let ways = |kind| kinds.iter().filter(|other| **other == kind).count() as f64;
        let priors: Vec<f64> =
            variations.iter().map(|one| one.kind().ln_odds() - ways(one.kind()).ln()).collect();
        kinds.sort_unstable();
        kinds.dedup();
        let odds = kinds.iter().map(|kind| kind.ln_odds().exp()).sum::<f64>().ln();
        let effects = seen.iter().flat_map(|&quantity| {
            let of = move |(variation, prior): (&Variation, &f64)| Effect {
                quantity,
                variation: Some(*variation),
                columns: variation.columns(conduct).unwrap_or_else(|| DMatrix::zeros(0, 0)),
                ln_prior: VARIES + prior - odds,
            };
            variations.iter().zip(&priors).map(of)
        });
        Self {
            mixtures,
            always: seen.iter().filter_map(always).collect(),
            effects: effects.collect(),
        }
    }
}

/// A hypothesis with the scales of its amplitudes and its score.
#[derive(Clone, Debug)]
pub(crate) struct Scored {
    /// Its effects, those that are always there first.
    pub(crate) effects: Vec<Effect>,
    /// What the runs say of their amplitudes.
    pub(crate) gram: Gram,
    /// The most probable scale of each.
    pub(crate) scales: Vec<f64>,
    /// The logarithm of its marginal likelihood and prior probability, but for a constant.
    pub(crate) score: f64,
}

impl Scored {
    /// These effects, scored.
    ///
    /// `None` if the information on them is not finite.
    pub(crate) fn of(
        information: &Information,
        catalogue: &Catalogue,
        effects: Vec<Effect>,
    ) -> Option<Self> {
        let gram = information.gram(effects.iter().map(Effect::amplitudes));
        let mut scored = Self { scales: vec![1.0; effects.len()], gram, effects, score: 0.0 };
        // Beside the best scales of the others: the sum over its scales relative to the best one, a block at a time.
        let mut summed = vec![0.0; scored.effects.len()];
        let mut weights = vec![0.0; scored.effects.len()];
        for _ in 0..SWEEPS {
            let before = scored.scales.clone();
            for place in 0..scored.effects.len() {
                let all = scored.scales_of(catalogue, place)?;
                let best = all.iter().max_by(|a, b| a.ln_weight.total_cmp(&b.ln_weight))?;
                summed[place] = log_sum(all.iter().map(|one| one.ln_weight)) - best.ln_weight;
                scored.scales[place] = best.scale;
                let mixture = &catalogue.mixtures[scored.effects[place].quantity];
                weights[place] = mixture.ln_weight(best.scale);
            }
            if before == scored.scales {
                break;
            }
        }
        let ln_marginal = scored.gram.solved(&scored.scales)?.ln_marginal;
        let priors: f64 = scored.effects.iter().map(|one| one.ln_prior).sum();
        scored.score =
            ln_marginal + priors + weights.iter().sum::<f64>() + summed.iter().sum::<f64>();
        Some(scored)
    }

    /// The scales of one of its effects beside the best scales of the others, with the logarithms of their weights.
    pub(crate) fn scales_of(&self, catalogue: &Catalogue, place: usize) -> Option<Vec<Component>> {
        let (information, score) = self.gram.alone(place, &self.scales)?;
        let mixture = &catalogue.mixtures[self.effects[place].quantity];
        Some(Block::scales(information, &score, mixture))
    }
}
