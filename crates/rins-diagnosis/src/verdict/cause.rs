//! A cause that was found, and its alternatives.

use rins_bayes::log_sum;
use rins_estimation::Estimate;
use rins_terms::Term;

/// An effect that might be what is wrong.
#[derive(Clone, Debug)]
pub struct Rival {
    /// The effect.
    pub term: &'static Term,
    /// Its settings, in SI units.
    pub settings: Vec<f64>,
    /// The logarithm of its odds against the most likely one.
    pub odds: f64,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Cause {
    /// The effect that explains it best.
    pub term: &'static Term,
    /// Its settings, in SI units.
    pub settings: Vec<f64>,
    /// Which of its settings was sought from a continuum, and its 1σ.
    pub sought: Option<(usize, f64)>,
    /// Its parameters as the final model has them.
    pub parameters: Vec<Estimate>,
    /// The logarithm of the probability that anything in the catalogue explains as much by chance.
    pub ln_p: f64,
    /// How many of its parameters' directions the runs show.
    pub dof: usize,
    /// By how much the logarithm of the likelihood rises.
    pub gain: f64,
    /// The other effects that these runs cannot tell from it, best first.
    pub rivals: Vec<Rival>,
}

impl Cause {
    /// The posterior probability that the effect is this one and none of the rivals, if it is one of them.
    pub fn probability(&self) -> f64 {
        (-self.ln_total()).exp()
    }

    /// The posterior probability that the effect is this rival, if it is one of the set.
    pub fn probability_of(&self, rival: &Rival) -> f64 {
        (rival.odds - self.ln_total()).exp()
    }

    /// The logarithm of the odds of all together against this one.
    fn ln_total(&self) -> f64 {
        log_sum(self.rivals.iter().map(|rival| rival.odds).chain([0.0]))
    }
}
