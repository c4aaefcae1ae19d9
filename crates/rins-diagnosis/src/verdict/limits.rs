//! What runs would have shown of each effect.

use nalgebra::{DMatrix, DVector};
use rins_bayes::{Block, ScaleMixture};
use rins_estimation::{Fit, Indefinite, Run};
use rins_imu::ImuSpec;
use rins_terms::Term;
use statrs::distribution::{ContinuousCDF, Normal};

use crate::evidence::survey::Survey;
use crate::hypothesis::{SOMETHING, ln_prior, ln_settings, magnitudes, supports};
use crate::proposal::candidates::{candidates, number_of_terms};
use crate::proposal::dead_zone;

/// An effect of the detectable amplitude is found with this probability.
const POWER: f64 = 0.95;

/// Detection begins below so many sigmas, and is determined to ...
const MOST_SIGMAS: f64 = 100.0;

/// ... so many.
const FINE: f64 = 1e-4;

/// The smallest amplitude of an effect that runs would have shown.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// The effect.
    pub term: &'static Term,
    /// Which of its parameters, the others being nothing.
    pub parameter: usize,
    /// The 1σ of its estimate beside the model, in SI units.
    pub sigma: f64,
    /// The amplitude that would have been found with a probability of 95 %, in SI units.
    pub detectable: f64,
    /// With an estimate of so many sigmas the effect would have been more probable than none.
    pub significant: f64,
}

impl Limit {
    /// The probability that this amplitude would have been found, in SI units.
    pub fn power(&self, amplitude: f64) -> f64 {
        let normal = Normal::standard();
        let sigmas = (amplitude / self.sigma).abs();
        normal.cdf(sigmas - self.significant) + normal.cdf(-sigmas - self.significant)
    }
}

/// What `runs` would have shown of each effect that `fit` does not have in its model, in its best shape.
///
/// # Errors
/// [`Indefinite`] if the noise makes no covariance.
pub fn limits(runs: &[Run], fit: &Fit, imu: &ImuSpec) -> Result<Vec<Limit>, Indefinite> {
    let list = candidates(runs, fit.model());
    let survey = Survey::of(runs, fit, imu, &list, std::slice::from_ref(&fit.noise))?;
    let Some(left) = survey.left(0, &[], &[]) else { return Ok(Vec::new()) };
    let terms = number_of_terms(&list);
    let normal = Normal::standard();
    let mut limits: Vec<Limit> = Vec::new();
    for (index, candidate) in list.iter().enumerate() {
        let own = survey.of_candidate(index);
        let supports = supports(candidate.chosen.term);
        let prior = SOMETHING + ln_prior(candidate.chosen.term, terms) + ln_settings(candidate);
        for (parameter, places) in own.iter().enumerate() {
            let (information, _) = left.block(&places[..1]);
            let usual = candidate.chosen.term.parameters[parameter].sigma(imu);
            if information[(0, 0)] <= 0.0 {
                continue;
            }
            let sigma = usual / information[(0, 0)].sqrt();
            let term = candidate.chosen.term;
            let own = supports.iter().filter(|one| one.parameters.contains(&parameter));
            let support = own.map(|one| one.ln_prior).fold(f64::NEG_INFINITY, f64::max);
            let magnitudes = magnitudes(term, parameter, imu);
            let Some(significant) = significant(sigma / usual, &magnitudes, prior + support) else {
                continue;
            };
            let mut detectable = (significant + normal.inverse_cdf(POWER)) * sigma;
            if dead_zone::is_of_widths(&candidate.chosen) {
                // It is as deep as it is wide.
                let width = candidate.chosen.settings[parameter];
                if detectable > width {
                    continue;
                }
                detectable = width;
            }
            let limit = Limit { term, parameter, sigma, detectable, significant };
            let same =
                |other: &&mut Limit| other.term.is(limit.term) && other.parameter == parameter;
            match limits.iter_mut().find(same) {
                Some(other) if other.detectable <= limit.detectable => {}
                Some(other) => *other = limit,
                None => limits.push(limit),
            }
        }
    }
    Ok(limits)
}

/// How many sigmas make an amplitude as probable as none, whose 1σ is this in units of its largest typical magnitude, and whose prior
/// probability is this but for its size; `None` if no number does.
fn significant(sigma: f64, magnitudes: &ScaleMixture, ln_prior: f64) -> Option<f64> {
    let information = DMatrix::from_element(1, 1, sigma.powi(-2));
    let odds = |sigmas: f64| {
        let score = DVector::from_element(1, sigmas / sigma);
        Block::of(information.clone(), &score, magnitudes).ln_factor + ln_prior
    };
    let (mut below, mut above) = (0.0, MOST_SIGMAS);
    if odds(above) < 0.0 {
        return None;
    }
    while above - below > FINE {
        let middle = 0.5 * (below + above);
        if odds(middle) < 0.0 { below = middle } else { above = middle }
    }
    Some(above)
}
