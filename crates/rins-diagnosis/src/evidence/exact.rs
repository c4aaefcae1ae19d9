//! The marginal likelihood of a hypothesis at its nonlinear fit.

use nalgebra::{DMatrix, DVector};
use rins_bayes::log_sum;
use rins_estimation::Fit;
use rins_imu::ImuSpec;

use crate::hypothesis::{Effect, magnitudes};

/// Scales beyond these multiples of the estimated amplitude have no weight.
const AROUND: (f64, f64) = (0.05, 50.0);

/// How often each effect's support and scale are chosen anew beside those of the others.
const SWEEPS: usize = 2;

/// A support and a scale of one effect: the places of its amplitudes, their scale, and the logarithm of the prior probability.
struct Alternative {
    places: Vec<usize>,
    scale: f64,
    ln_weight: f64,
}

/// The amplitudes of all effects, in units of their largest typical magnitudes, with all other parameters integrated out.
struct Amplitudes {
    information: DMatrix<f64>,
    /// The score at zero amplitudes.
    score: DVector<f64>,
    /// The logarithm of the likelihood at zero amplitudes.
    base: f64,
    /// Of each the effect, the parameter, and the estimate.
    each: Vec<(usize, usize, f64)>,
}

impl Amplitudes {
    fn of(fit: &Fit, given: usize, effects: &[Effect], imu: &ImuSpec) -> Option<Self> {
        let kept: Vec<usize> = (0..fit.parameters.len())
            .filter(|&place| fit.parameters[place].parameter.term >= given)
            .collect();
        let evidence = fit.marginal_evidence(&kept)?;
        let usual = |&place: &usize| {
            let one = &fit.parameters[place].parameter;
            effects[one.term - given].instance.term.parameters[one.parameter].sigma(imu)
        };
        let units = DVector::from_iterator(kept.len(), kept.iter().map(usual));
        let values = DVector::from_iterator(
            kept.len(),
            kept.iter().map(|&place| fit.parameters[place].value),
        )
        .component_div(&units);
        let information = DMatrix::from_fn(kept.len(), kept.len(), |row, column| {
            evidence.information[(row, column)] * units[row] * units[column]
        });
        let here = evidence.score.component_mul(&units);
        let back = &information * &values;
        let base = -0.5 * evidence.square
            - evidence.log_determinant
            - here.dot(&values)
            - 0.5 * values.dot(&back);
        let each = kept.iter().zip(values.iter()).map(|(&place, value)| {
            let one = &fit.parameters[place].parameter;
            (one.term - given, one.parameter, *value)
        });
        Some(Self { score: here + back, base, each: each.collect(), information })
    }

    /// The logarithm of the Bayes factor of amplitudes of these scales at these places against none.
    fn ln_factor(&self, scales: &[(usize, f64)]) -> f64 {
        let n = scales.len();
        let matrix = DMatrix::from_fn(n, n, |row, column| {
            let ((one, of_one), (other, of_other)) = (scales[row], scales[column]);
            let identity = if row == column { 1.0 } else { 0.0 };
            identity + of_one * of_other * self.information[(one, other)]
        });
        let right = DVector::from_iterator(n, scales.iter().map(|&(at, s)| s * self.score[at]));
        let Some(factor) = matrix.cholesky() else { return f64::NEG_INFINITY };
        let log_determinant: f64 = factor.l_dirty().diagonal().iter().map(|x| x.ln()).sum();
        0.5 * right.dot(&factor.solve(&right)) - log_determinant
    }

    /// The supports and scales of an effect.
    fn alternatives(&self, index: usize, effect: &Effect, imu: &ImuSpec) -> Vec<Alternative> {
        let kind = effect.instance.term;
        let own = |place: &usize| self.each[*place].0 == index;
        let places: Vec<usize> = (0..self.each.len()).filter(own).collect();
        let amplitude = places.iter().fold(1e-9, |most: f64, &at| most.max(self.each[at].2.abs()));
        let within = AROUND.0 * amplitude..=AROUND.1 * amplitude;
        let mut all = Vec::new();
        for support in effect.supports() {
            let inside = |place: &usize| support.parameters.contains(&self.each[*place].1);
            let places: Vec<usize> = places.iter().copied().filter(inside).collect();
            let magnitudes = magnitudes(kind, support.parameters[0], imu);
            let components = magnitudes.components().filter(|one| within.contains(&one.scale));
            all.extend(components.map(|one| Alternative {
                places: places.clone(),
                scale: one.scale,
                ln_weight: support.ln_prior + one.ln_weight,
            }));
        }
        all
    }
}

/// The logarithm of the marginal likelihood of a fit whose last terms are the `effects`, with the priors of their amplitudes in
/// place of those of the fit. The noise is as in the fit.
pub(crate) fn log_evidence(fit: &Fit, given: usize, effects: &[Effect], imu: &ImuSpec) -> f64 {
    let Some(amplitudes) = Amplitudes::of(fit, given, effects, imu) else {
        return f64::NEG_INFINITY;
    };
    let all: Vec<Vec<Alternative>> = effects
        .iter()
        .enumerate()
        .map(|(index, effect)| amplitudes.alternatives(index, effect, imu))
        .collect();
    let mut chosen: Vec<usize> = vec![0; effects.len()];
    let mut summed = 0.0;
    for sweep in 0..SWEEPS {
        summed = 0.0;
        for (index, own) in all.iter().enumerate() {
            let others =
                (0..effects.len()).filter(|&other| other != index && (sweep > 0 || other < index));
            let beside: Vec<(usize, f64)> = others
                .filter_map(|other| all[other].get(chosen[other]))
                .flat_map(|one| one.places.iter().map(|&place| (place, one.scale)))
                .collect();
            let factor = |one: &Alternative| {
                let own = one.places.iter().map(|&place| (place, one.scale));
                one.ln_weight
                    + amplitudes.ln_factor(&beside.iter().copied().chain(own).collect::<Vec<_>>())
            };
            let each: Vec<f64> = own.iter().map(factor).collect();
            let best = (0..each.len()).max_by(|&a, &b| each[a].total_cmp(&each[b])).unwrap_or(0);
            chosen[index] = best;
            if let Some(most) = each.get(best) {
                summed += log_sum(each.iter().copied()) - most;
            } else {
                return f64::NEG_INFINITY;
            }
        }
    }
    let together: Vec<&Alternative> =
        all.iter().zip(&chosen).filter_map(|(own, &at)| own.get(at)).collect();
    let scales: Vec<(usize, f64)> = together
        .iter()
        .flat_map(|one| one.places.iter().map(|&place| (place, one.scale)))
        .collect();
    let weights: f64 = together.iter().map(|one| one.ln_weight).sum();
    amplitudes.base + amplitudes.ln_factor(&scales) + weights + summed
}
