//! What runs would have shown of each effect, and how often chance passes for one.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rayon::prelude::*;
use rins_estimation::{Fit, Indefinite, Run};
use rins_imu::{ImuSpec, Seed};
use rins_terms::Term;
use statrs::distribution::{ContinuousCDF, Normal};

use crate::candidates::{Candidate, candidates};
use crate::dead_zone;
use crate::diagnosis::FALSE_ALARMS;
use crate::score::choices;
use crate::survey::Survey;
use crate::trial::{Context, trials};

/// An effect of the detectable amplitude is found with this probability.
const POWER: f64 = 0.95;

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
    /// An estimate of so many sigmas would have been significant, over the catalogue and all shapes and choices.
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
    let families =
        list.iter().map(|one| one.chosen.term.id).collect::<std::collections::BTreeSet<_>>();
    let normal = Normal::standard();
    let mut limits: Vec<Limit> = Vec::new();
    for (index, candidate) in list.iter().enumerate() {
        let own = survey.of_candidate(index);
        let looks =
            families.len() as f64 * candidate.looks * choices(candidate.chosen.term).len() as f64;
        let significant = normal.inverse_cdf(1.0 - 0.5 * FALSE_ALARMS / looks);
        let reach = significant + normal.inverse_cdf(POWER);
        for (parameter, places) in own.iter().enumerate() {
            let (information, _) = left.block(&places[..1]);
            let usual = candidate.chosen.term.parameters[parameter].sigma(imu);
            if information[(0, 0)] <= 0.0 {
                continue;
            }
            let sigma = usual / information[(0, 0)].sqrt();
            let term = candidate.chosen.term;
            let mut detectable = reach * sigma;
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

/// How often chance alone would have named an effect of the catalogue beside the model in `fit`, of so many draws.
///
/// The innovations of a right model are white noise, and what they say of all candidates at once is normal, with
/// their information for covariance: that is drawn, with the noise as it was found.
///
/// # Errors
/// [`Indefinite`] if the noise makes no covariance.
pub fn chance(
    runs: &[Run],
    fit: &Fit,
    imu: &ImuSpec,
    draws: u32,
    seed: Seed,
) -> Result<f64, Indefinite> {
    let list = candidates(runs, fit.model());
    let survey = Survey::of(runs, fit, imu, &list, std::slice::from_ref(&fit.noise))?;
    let Some(left) = survey.left(0, &[], &[]) else { return Ok(0.0) };
    let root = square_root(&left.all());
    let named = (0..draws)
        .into_par_iter()
        .filter(|&draw| {
            let mut random = Pcg64::new(u128::from(seed.seed), u128::from(draw));
            let n = root.ncols();
            let white = DVector::from_fn(n, |_, _| StandardNormal.sample(&mut random));
            let context = Context::drawn(&survey, left.with_score(&root * white));
            passes(&survey, &context, &list)
        })
        .count();
    Ok(named as f64 / f64::from(draws))
}

fn passes(survey: &Survey, context: &Context<'_>, list: &[Candidate]) -> bool {
    let tried = trials(survey, context, list);
    let threshold = FALSE_ALARMS.ln() - (tried.len() as f64).ln();
    tried.iter().any(|trial| trial.ln_p < threshold && trial.is_likely())
}

/// A matrix whose product with its transpose is this one; what rounding made negative is nothing.
fn square_root(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let SymmetricEigen { eigenvalues, mut eigenvectors } = SymmetricEigen::new(matrix.clone());
    for (value, mut column) in eigenvalues.iter().zip(eigenvectors.column_iter_mut()) {
        column *= value.max(0.0).sqrt();
    }
    eigenvectors
}
