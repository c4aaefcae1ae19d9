//! Estimation of the noise parameters by restricted maximum likelihood.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rins_frames::units::ARCSEC;

use crate::linear::Linear;
use crate::noise_parameters::Noise;
use crate::run::Reference;

/// 1σ of the logarithm of a noise parameter in a data sheet.
pub(crate) const STATED: f64 = 1.0;

/// The same for noise parameters without prior knowledge.
const UNKNOWN: f64 = 3.0;

/// The initial bias instability relative to the white noise over one second: an effect visible within minutes.
const SHOWING: f64 = 0.25;

/// The prior mean of this ratio if no bias instability is stated: no visible effect within an hour.
const UNSEEN: f64 = 0.01;

/// The initial velocity noise of a base that is not stationary \[m/s\]. A velocity with a resolution of 1 mm/s has about this
/// noise too.
const UNSTEADY: f64 = 3e-4;

/// The initial random walk density of the attitude of such a base \[rad/√s\]: one arcsecond.
const SWAYING: f64 = ARCSEC;

/// The initial error of a rotation between static intervals, relative to the rotation: that of a consumer MEMS gyro.
const TURNING: f64 = 1e-3;

/// The same for a stationary base: one arcsecond in three hours.
const FIRM: f64 = 0.01 * ARCSEC;

/// 1σ of the logarithm of base motion: from rock to a boat.
const ANYTHING: f64 = 5.0;

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

/// A noise parameter to be estimated.
#[derive(Clone, Debug, PartialEq)]
struct Unknown {
    which: Which,
    /// The initial value, in SI units.
    start: f64,
    /// The logarithm of the prior mean relative to the initial value.
    centre: f64,
    /// 1σ of the logarithm in the prior.
    sigma: f64,
}

impl Unknown {
    /// Whether every data sheet or rig file states it, so that the prior is narrow.
    fn is_stated(&self) -> bool {
        self.sigma <= STATED
    }
}

#[derive(Clone, Debug, PartialEq)]
enum Which {
    GyroWhite,
    GyroFlicker,
    GyroWalk,
    AccelWhite,
    AccelFlicker,
    AccelWalk,
    Jitter,
    /// Of the runs on one rig.
    Wobble(Vec<usize>),
    Encoder(Vec<usize>),
    Velocity,
    Sway(usize),
    Turn,
}

impl Which {
    fn of<'a>(&self, noise: &'a mut [Noise]) -> Vec<&'a mut f64> {
        match self {
            Self::GyroWhite => noise.iter_mut().map(|n| &mut n.imu.gyro.white).collect(),
            Self::GyroFlicker => noise.iter_mut().map(|n| &mut n.imu.gyro.flicker).collect(),
            Self::GyroWalk => noise.iter_mut().map(|n| &mut n.imu.gyro.walk).collect(),
            Self::AccelWhite => noise.iter_mut().map(|n| &mut n.imu.accel.white).collect(),
            Self::AccelFlicker => noise.iter_mut().map(|n| &mut n.imu.accel.flicker).collect(),
            Self::AccelWalk => noise.iter_mut().map(|n| &mut n.imu.accel.walk).collect(),
            Self::Jitter => noise.iter_mut().map(|n| &mut n.imu.jitter).collect(),
            Self::Wobble(runs) => on(noise, runs).map(|n| &mut n.wobble).collect(),
            Self::Encoder(runs) => on(noise, runs).map(|n| &mut n.encoder).collect(),
            Self::Velocity => noise.iter_mut().map(|n| &mut n.velocity).collect(),
            Self::Turn => noise.iter_mut().map(|n| &mut n.turn).collect(),
            Self::Sway(axis) => noise.iter_mut().map(|n| &mut n.sway[*axis]).collect(),
        }
    }
}

/// The noise of these runs.
fn on<'a>(noise: &'a mut [Noise], runs: &[usize]) -> impl Iterator<Item = &'a mut Noise> {
    let all = noise.iter_mut().enumerate();
    all.filter(move |(run, _)| runs.contains(run)).map(|(_, noise)| noise)
}

/// The estimated noise parameters and their uncertainty.
pub(crate) struct Likely {
    /// The maximum of the likelihood.
    pub(crate) noise: Vec<Noise>,
    /// Pairs of a larger and a smaller bias instability at ±√3 σ: the outer nodes of a Gauss-Hermite quadrature, each with a
    /// weight of one sixth.
    pub(crate) around: Vec<[Vec<Noise>; 2]>,
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
    expected: &[Noise],
    first: &[Noise],
    inverse_curvature: Option<&DMatrix<f64>>,
    log_likelihood: impl Fn(&[Noise]) -> Option<f64> + Sync,
) -> Likely {
    let unknown = unknowns(linear, expected, first);
    let noise_at = |x: &DVector<f64>| {
        let mut noise = first.to_vec();
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
    let start = match inverse {
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
    let (best, least, inverse_curvature) = found;
    let flickers: Vec<usize> = (0..unknown.len())
        .filter(|&axis| matches!(unknown[axis].which, Which::GyroFlicker | Which::AccelFlicker))
        .collect();
    let around = flickers.into_par_iter().map(|axis| {
        let away = |by: f64| {
            let mut x = best.clone();
            x[axis] += by;
            x
        };
        let (more, less) =
            rayon::join(|| cost(&away(CURVATURE_STEP)), || cost(&away(-CURVATURE_STEP)));
        let sides = more + less;
        let curvature = (sides - 2.0 * least) / (CURVATURE_STEP * CURVATURE_STEP);
        let sigma = curvature.max(0.0).sqrt().recip().min(MOST_UNCERTAIN);
        [3.0_f64.sqrt() * sigma, -(3.0_f64.sqrt()) * sigma].map(|by| noise_at(&away(by)))
    });
    Likely { noise: noise_at(&best), around: around.collect(), inverse_curvature }
}

fn unknowns(linear: &[Linear], expected: &[Noise], first: &[Noise]) -> Vec<Unknown> {
    let mut unknown = Vec::new();
    let mut add = |which, start: f64, expected: f64, sigma| {
        unknown.push(Unknown { which, start, centre: (expected / start).ln(), sigma });
    };
    // Without a measured table angle no pier holds the base: its motion is not sensor noise.
    let unread = |linear: &Linear| matches!(linear.reference, Reference::Gravity | Reference::Rest);
    let free = linear.iter().all(unread);
    let first = if free { expected } else { first };
    let (imu, sheet) = (first[0].imu, expected[0].imu);
    // If no bias instability is stated, the prior mean is small, but the search starts where it is visible.
    let flicker = |given: f64, white: f64| {
        if given > 0.0 {
            (given, given, STATED)
        } else {
            (SHOWING * white, UNSEEN * white, UNKNOWN)
        }
    };
    add(Which::GyroWhite, imu.gyro.white, sheet.gyro.white, STATED);
    let (start, expect, sigma) = flicker(sheet.gyro.flicker, sheet.gyro.white);
    add(Which::GyroFlicker, start, expect, sigma);
    add(Which::AccelWhite, imu.accel.white, sheet.accel.white, STATED);
    let (start, expect, sigma) = flicker(sheet.accel.flicker, sheet.accel.white);
    add(Which::AccelFlicker, start, expect, sigma);
    if sheet.gyro.walk > 0.0 {
        add(Which::GyroWalk, sheet.gyro.walk, sheet.gyro.walk, STATED);
    }
    if sheet.accel.walk > 0.0 {
        add(Which::AccelWalk, sheet.accel.walk, sheet.accel.walk, STATED);
    }
    if sheet.jitter > 0.0 {
        add(Which::Jitter, sheet.jitter, sheet.jitter, UNKNOWN);
    }
    for runs in rigs(linear) {
        let (first, expected) = (first[runs[0]], expected[runs[0]]);
        let read = matches!(linear[runs[0]].reference, Reference::Encoder { .. });
        if read {
            add(Which::Encoder(runs.clone()), first.encoder, expected.encoder, STATED);
        }
        add(Which::Wobble(runs), first.wobble, expected.wobble, UNKNOWN);
    }
    // Only the gyro measures how well a table follows its command.
    if linear.iter().any(|linear| matches!(linear.reference, Reference::Command { .. })) {
        add(Which::Sway(2), SWAYING, FIRM, ANYTHING);
    }
    if linear.iter().any(|linear| linear.follows_turn) {
        add(Which::Turn, TURNING, expected[0].turn, ANYTHING);
    }
    if free {
        add(Which::Velocity, UNSTEADY, expected[0].velocity, ANYTHING);
        let axes = if linear.iter().all(Linear::shows_angle) { 3 } else { 2 };
        for axis in 0..axes {
            add(Which::Sway(axis), SWAYING, FIRM, ANYTHING);
        }
    }
    unknown
}

/// The runs on each rig: runs without a power cycle in between are on the same one.
fn rigs(linear: &[Linear]) -> Vec<Vec<usize>> {
    let mut rigs: Vec<Vec<usize>> = Vec::new();
    for (run, one) in linear.iter().enumerate() {
        let same =
            |rig: &&mut Vec<usize>| one.turn_on.is_some() && linear[rig[0]].turn_on == one.turn_on;
        match rigs.iter_mut().find(same) {
            Some(rig) => rig.push(run),
            None => rigs.push(vec![run]),
        }
    }
    rigs
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
