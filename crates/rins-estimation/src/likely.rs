//! Estimation of the noise parameters by restricted maximum likelihood.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::linear::Linear;
use crate::noise_parameters::{Noise, NoiseParameters};
use crate::noise_prior::{Unknown, Which, unknowns};

/// The smallest curvature that is used.
const LEAST_CURVATURE: f64 = 0.1;

/// The smallest initial bias instability in a search that starts at an earlier estimate, as a logarithm relative to the usual
/// start.
const LEAST_SHOWING: f64 = -2.0;

/// A stated noise parameter has vanished below this logarithm relative to its stated value: another noise parameter has
/// replaced it. The likelihood then has no gradient that would lead back.
const LOST: f64 = -1.0;

/// The largest number of steps.
const MOST_STEPS: usize = 40;

/// The increase of the log-likelihood below which the search ends.
const LEAST_GAIN: f64 = 0.02;

/// The step of one-sided differences, in logarithms. The estimate is biased by half of it, so that it must be small compared
/// with the uncertainty from thousands of innovations, and large compared with rounding.
const DIFFERENCE: f64 = 0.004;

/// The estimated noise parameters and their uncertainty.
pub(crate) struct Likely {
    /// The maximum of the likelihood.
    pub(crate) noise: Vec<Noise>,
    /// Pairs of a larger and a smaller parameter of each colored process at ±√3 σ: the outer nodes of a Gauss-Hermite quadrature, each with a
    /// weight of one sixth.
    pub(crate) around: Vec<[Vec<Noise>; 2]>,
    /// The logarithm of the posterior widths of these parameters relative to those of their priors: the Occam factor of
    /// Laplace's approximation.
    pub(crate) ln_width: f64,
    /// The approximate inverse Hessian at the estimate, from which another search can start.
    pub(crate) inverse_curvature: DMatrix<f64>,
}

/// The step of second differences, in logarithms: about the σ of a visible bias instability.
const CURVATURE_STEP: f64 = 0.2;

/// The largest 1σ of the logarithm of a bias instability. If it is unobservable, its curvature is that of the prior, and so
/// small a bias instability has no effect.
const MOST_UNCERTAIN: f64 = 0.6;

/// Estimates the noise parameters by restricted maximum likelihood: the parameters are integrated out.
///
/// The priors are log-normal: the noise parameters of a data sheet are known to a factor of e about their stated values, everything
/// else to a factor of twenty. An unobservable noise parameter stays where it has no effect. The search starts from `first`, with the
/// inverse Hessian of an earlier search if there is one.
pub(crate) fn likely_noise(
    linear: &[Linear],
    prior: (&[Noise], &NoiseParameters),
    first: &[Noise],
    inverse_curvature: Option<&DMatrix<f64>>,
    log_likelihood: impl Fn(&[Noise]) -> Option<f64> + Sync,
) -> Likely {
    let unknown = unknowns(linear, prior, first);
    let noise_at = |x: &DVector<f64>| {
        // A process that an earlier search had, and this one has not, is absent.
        let mut noise = prior.0.to_vec();
        for (unknown, x) in unknown.iter().zip(x.iter()) {
            for slot in unknown.which.of(&mut noise) {
                *slot = unknown.start * x.exp();
            }
        }
        noise
    };
    // In logarithms, so that the steps are comparable in all noise parameters.
    let cost = |x: &DVector<f64>| {
        let prior: f64 = unknown
            .iter()
            .zip(x.iter())
            .map(|(u, x)| 0.5 * ((x - u.centre) / u.sigma).powi(2))
            .sum();
        let value = log_likelihood(&noise_at(x)).filter(|value| value.is_finite());
        value.map_or(f64::INFINITY, |value| prior - value)
    };
    let inverse = inverse_curvature.filter(|inverse| inverse.nrows() == unknown.len());
    let start = match inverse_curvature {
        Some(_) => near(&unknown, first),
        None => start(&unknown, cost),
    };
    let mut found = minimum(start, inverse.cloned(), cost);
    // If the model is inadequate, a parameter that has vanished was absent at the start of the search too: it would vanish
    // again.
    let better = |start: &DVector<f64>| cost(start) < found.1;
    if let Some(start) = without_loss(&unknown, &found.0).filter(better) {
        found = minimum(start, None, cost);
    }
    // One that vanished on the way of a first step has no gradient but that of its prior, over which short steps stop.
    let (start, least) = with_prior_means(&unknown, (&found.0, found.1), cost);
    if least < found.1 - LEAST_GAIN {
        found = minimum(start, None, cost);
    }
    let (best, least, inverse_curvature) = found;
    let colored: Vec<usize> =
        (0..unknown.len()).filter(|&axis| unknown[axis].which.is_colored()).collect();
    let around = colored.into_par_iter().map(|axis| {
        let away = |by: f64| {
            let mut x = best.clone();
            x[axis] += by;
            x
        };
        let (more, less) =
            rayon::join(|| cost(&away(CURVATURE_STEP)), || cost(&away(-CURVATURE_STEP)));
        let sides = more + less;
        let curvature = (sides - 2.0 * least) / (CURVATURE_STEP * CURVATURE_STEP);
        let width = curvature.max(0.0).sqrt().recip();
        let sigma = width.min(MOST_UNCERTAIN);
        let sides =
            [3.0_f64.sqrt() * sigma, -(3.0_f64.sqrt()) * sigma].map(|by| noise_at(&away(by)));
        (sides, (width / unknown[axis].sigma).min(1.0).ln())
    });
    let (around, widths): (Vec<_>, Vec<f64>) = around.unzip();
    let ln_width = widths.iter().sum();
    Likely { noise: noise_at(&best), around, ln_width, inverse_curvature }
}

/// The start of the search: without a fixed base, the best of several levels of base motion, from rock to a boat.
///
/// From a wrong level the search would attribute base motion to the sensors' noise, or the reverse.
fn start(unknown: &[Unknown], cost: impl Fn(&DVector<f64>) -> f64 + Sync + Send) -> DVector<f64> {
    let steps = [0.0, 2.5, 5.0, 7.5];
    let on = |velocity: f64, sway: f64| {
        let of = |unknown: &Unknown| match &unknown.which {
            Which::Velocity => unknown.centre + velocity,
            Which::Sway(_) => unknown.centre + sway,
            _ => 0.0,
        };
        DVector::from_iterator(unknown.len(), unknown.iter().map(of))
    };
    if unknown.iter().all(|unknown| unknown.which != Which::Velocity) {
        return DVector::zeros(unknown.len());
    }
    let bases: Vec<DVector<f64>> = steps
        .iter()
        .flat_map(|&velocity| steps.iter().map(move |&sway| on(velocity, sway)))
        .collect();
    let costs: Vec<f64> = bases.par_iter().map(cost).collect();
    let best = costs.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |best| best.0);
    bases[best].clone()
}

/// The start of a search after one that found `first`. Bias instability that was invisible there may be visible now.
fn near(unknown: &[Unknown], first: &[Noise]) -> DVector<f64> {
    let mut first = first.to_vec();
    let of = |unknown: &Unknown| {
        let found = unknown.which.of(&mut first).first().map_or(0.0, |strength| **strength);
        let from_start = (found / unknown.start).ln();
        if from_start.is_finite() { from_start.max(LEAST_SHOWING) } else { 0.0 }
    };
    DVector::from_iterator(unknown.len(), unknown.iter().map(of))
}

/// The start of a further search if a stated noise parameter has vanished: the stated value for it, the prior mean for bias
/// instability, which may have replaced white noise, and the estimate for everything else. `None` if none has vanished.
fn without_loss(unknown: &[Unknown], found: &DVector<f64>) -> Option<DVector<f64>> {
    let is_lost = |(unknown, x): (&Unknown, &f64)| unknown.is_stated() && x - unknown.centre < LOST;
    unknown.iter().zip(found.iter()).any(is_lost).then(|| {
        let of = |(unknown, &x): (&Unknown, &f64)| match unknown.which {
            Which::GyroFlicker | Which::AccelFlicker => unknown.centre.max(LEAST_SHOWING),
            _ if unknown.is_stated() => x.max(unknown.centre),
            _ => x,
        };
        DVector::from_iterator(unknown.len(), unknown.iter().zip(found.iter()).map(of))
    })
}

/// The estimate and its cost, with each noise parameter that is far below its prior mean at this mean if that is better.
fn with_prior_means(
    unknown: &[Unknown],
    (found, least): (&DVector<f64>, f64),
    cost: impl Fn(&DVector<f64>) -> f64,
) -> (DVector<f64>, f64) {
    let (mut best, mut least) = (found.clone(), least);
    for (axis, unknown) in unknown.iter().enumerate() {
        if found[axis] < unknown.centre - unknown.sigma {
            let mut other = best.clone();
            other[axis] = unknown.centre;
            let there = cost(&other);
            if there < least {
                (best, least) = (other, there);
            }
        }
    }
    (best, least)
}

/// The minimum of `cost`: its place, its value and the approximate inverse Hessian there, by quasi-Newton steps (BFGS) with
/// finite differences.
///
/// Without an initial inverse Hessian the first step uses the curvature along every axis: the curvatures of noise parameters
/// that are determined by thousands of data and by a few differ by a factor of a thousand.
fn minimum(
    start: DVector<f64>,
    inverse: Option<DMatrix<f64>>,
    cost: impl Fn(&DVector<f64>) -> f64 + Sync,
) -> (DVector<f64>, f64, DMatrix<f64>) {
    let n = start.len();
    let unit = |axis| DVector::from_fn(n, |row, _| if row == axis { DIFFERENCE } else { 0.0 });
    let ahead = |x: &DVector<f64>| -> Vec<f64> {
        (0..n).into_par_iter().map(|axis| cost(&(x + unit(axis)))).collect()
    };
    let gradient = |x: &DVector<f64>, here: f64| {
        DVector::from_vec(ahead(x).into_iter().map(|value| (value - here) / DIFFERENCE).collect())
    };
    let mut x = start;
    let mut value = cost(&x);
    let mut slope = gradient(&x, value);
    let mut inverse = inverse.unwrap_or_else(|| {
        let behind: Vec<f64> =
            (0..n).into_par_iter().map(|axis| cost(&(&x - unit(axis)))).collect();
        DMatrix::from_diagonal(&DVector::from_fn(n, |axis, _| {
            let curvature = (slope[axis] + (behind[axis] - value) / DIFFERENCE) / DIFFERENCE;
            1.0 / curvature.abs().max(LEAST_CURVATURE)
        }))
    });
    for _ in 0..MOST_STEPS {
        let mut step = -(&inverse * &slope);
        if !step.iter().all(|s| s.is_finite()) {
            break;
        }
        // At most a factor of five in one step.
        let longest = step.amax();
        if longest > 1.6 {
            step *= 1.6 / longest;
        }
        let foreseen = -slope.dot(&step);
        let mut tried = cost(&(&x + &step));
        let mut halvings = 0;
        while tried >= value && halvings < 5 {
            step *= 0.4;
            tried = cost(&(&x + &step));
            halvings += 1;
        }
        if tried >= value {
            break;
        }
        let gain = value - tried;
        x += &step;
        value = tried;
        if gain < LEAST_GAIN && foreseen < 2.0 * LEAST_GAIN {
            break;
        }
        let new_slope = gradient(&x, value);
        let change = &new_slope - &slope;
        slope = new_slope;
        let curvature = change.dot(&step);
        if curvature > 1e-12 {
            let left = DMatrix::identity(n, n) - &step * change.transpose() / curvature;
            inverse = &left * inverse * left.transpose() + &step * step.transpose() / curvature;
        }
    }
    (x, value, inverse)
}
