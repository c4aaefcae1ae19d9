//! The most likely strengths of the noise: restricted maximum likelihood.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::linear::Linear;
use crate::run::Reference;
use crate::strengths::Noise;

/// How far, in logarithms, a data sheet's white noise may be off, 1σ.
const WHITE: f64 = 1.0;

/// The same for strengths of which nothing is known.
const UNKNOWN: f64 = 3.0;

/// The flicker, over the white noise of a second, where the search starts: about as much as shows within minutes.
const SHOWING: f64 = 0.25;

/// The same that is expected where nothing is said of it: without effect within an hour.
const UNSEEN: f64 = 0.01;

/// The least curvature that is believed.
const LEAST_CURVATURE: f64 = 0.1;

/// The most steps of the search.
const MOST_STEPS: usize = 15;

/// The gain of log-likelihood below which the search ends.
const LEAST_GAIN: f64 = 0.02;

/// The step of one-sided differences, in logarithms: half of it is what the result is off by, so that it
/// must be small against what thousands of innovations show, and large against rounding.
const DIFFERENCE: f64 = 0.004;

/// One strength that is searched for.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Unknown {
    which: Which,
    /// Where the search starts, in SI units.
    start: f64,
    /// The logarithm of what is expected over that.
    centre: f64,
    /// How far it may be off, as 1σ of its logarithm.
    sigma: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Which {
    GyroWhite,
    GyroFlicker,
    GyroWalk,
    AccelWhite,
    AccelFlicker,
    AccelWalk,
    Wobble(usize),
    Encoder(usize),
}

impl Which {
    fn of<'a>(&self, noise: &'a mut [Noise]) -> Vec<&'a mut f64> {
        match *self {
            Self::GyroWhite => noise.iter_mut().map(|n| &mut n.imu.gyro.white).collect(),
            Self::GyroFlicker => noise.iter_mut().map(|n| &mut n.imu.gyro.flicker).collect(),
            Self::GyroWalk => noise.iter_mut().map(|n| &mut n.imu.gyro.walk).collect(),
            Self::AccelWhite => noise.iter_mut().map(|n| &mut n.imu.accel.white).collect(),
            Self::AccelFlicker => noise.iter_mut().map(|n| &mut n.imu.accel.flicker).collect(),
            Self::AccelWalk => noise.iter_mut().map(|n| &mut n.imu.accel.walk).collect(),
            Self::Wobble(run) => vec![&mut noise[run].wobble],
            Self::Encoder(run) => vec![&mut noise[run].encoder],
        }
    }
}

/// The most likely noise, and what else it might be.
pub(crate) struct Likely {
    /// The noise that makes the data most likely.
    pub(crate) noise: Vec<Noise>,
    /// Pairs of a stronger and a weaker flicker, √3 of its own σ away: the outer points of a Gauss-Hermite
    /// quadrature, each of which counts for a sixth.
    pub(crate) around: Vec<[Vec<Noise>; 2]>,
}

/// The step of second differences, in logarithms: about the σ of a flicker that shows.
const CURVATURE_STEP: f64 = 0.2;

/// How far at most, in logarithms, a flicker's strength is taken to be uncertain, 1σ: where it does not show at
/// all its curvature is the prior's, and so weak a flicker does not matter.
const MOST_UNCERTAIN: f64 = 0.6;

/// The noise that makes the data most likely, the parameters integrated out.
///
/// White noise of the sensors is known to a factor of e, everything else to a factor of twenty, as a
/// log-normal prior; a strength that the data do not show stays where it does no harm.
pub(crate) fn likely_noise(
    linear: &[Linear],
    first: &[Noise],
    log_likelihood: impl Fn(&[Linear], &[Noise]) -> Option<f64> + Sync,
) -> Likely {
    let unknown = unknowns(linear, first);
    let noise_at = |x: &DVector<f64>| {
        let mut noise = first.to_vec();
        for (unknown, x) in unknown.iter().zip(x.iter()) {
            for slot in unknown.which.of(&mut noise) {
                *slot = unknown.start * x.exp();
            }
        }
        noise
    };
    // Per unit of its prior's sigma, so that the search is equally brave in all.
    let cost = |x: &DVector<f64>| {
        let prior: f64 = unknown
            .iter()
            .zip(x.iter())
            .map(|(u, x)| 0.5 * ((x - u.centre) / u.sigma).powi(2))
            .sum();
        let value = log_likelihood(linear, &noise_at(x)).filter(|value| value.is_finite());
        value.map_or(f64::INFINITY, |value| prior - value)
    };
    let best = minimum(unknown.len(), cost);
    let least = cost(&best);
    let flickers = (0..unknown.len())
        .filter(|&axis| matches!(unknown[axis].which, Which::GyroFlicker | Which::AccelFlicker));
    let around = flickers.map(|axis| {
        let away = |by: f64| {
            let mut x = best.clone();
            x[axis] += by;
            x
        };
        let sides = cost(&away(CURVATURE_STEP)) + cost(&away(-CURVATURE_STEP));
        let curvature = (sides - 2.0 * least) / (CURVATURE_STEP * CURVATURE_STEP);
        let sigma = curvature.max(0.0).sqrt().recip().min(MOST_UNCERTAIN);
        [3.0_f64.sqrt() * sigma, -(3.0_f64.sqrt()) * sigma].map(|by| noise_at(&away(by)))
    });
    Likely { noise: noise_at(&best), around: around.collect() }
}

fn unknowns(linear: &[Linear], first: &[Noise]) -> Vec<Unknown> {
    let imu = first[0].imu;
    let mut unknown = Vec::new();
    let mut add = |which, start, centre, sigma| {
        unknown.push(Unknown { which, start, centre, sigma });
    };
    // Where nothing is said of flicker, little is expected, but the search starts where it would show.
    let flicker = |given: f64, white: f64| {
        if given > 0.0 { (given, 0.0) } else { (SHOWING * white, (UNSEEN / SHOWING).ln()) }
    };
    add(Which::GyroWhite, imu.gyro.white, 0.0, WHITE);
    let (start, centre) = flicker(imu.gyro.flicker, imu.gyro.white);
    add(Which::GyroFlicker, start, centre, UNKNOWN);
    add(Which::AccelWhite, imu.accel.white, 0.0, WHITE);
    let (start, centre) = flicker(imu.accel.flicker, imu.accel.white);
    add(Which::AccelFlicker, start, centre, UNKNOWN);
    if imu.gyro.walk > 0.0 {
        add(Which::GyroWalk, imu.gyro.walk, 0.0, UNKNOWN);
    }
    if imu.accel.walk > 0.0 {
        add(Which::AccelWalk, imu.accel.walk, 0.0, UNKNOWN);
    }
    for (run, (linear, noise)) in linear.iter().zip(first).enumerate() {
        add(Which::Wobble(run), noise.wobble, 0.0, UNKNOWN);
        if matches!(linear.reference, Reference::Encoder { .. }) {
            add(Which::Encoder(run), noise.encoder, 0.0, WHITE);
        }
    }
    unknown
}

/// Where `cost` is least: quasi-Newton steps from zero (BFGS), derivatives by differences.
///
/// The first step knows the curvature along every axis: strengths that thousands of figures show and such
/// that a few do differ a thousandfold in it.
fn minimum(n: usize, cost: impl Fn(&DVector<f64>) -> f64 + Sync) -> DVector<f64> {
    let unit = |axis| DVector::from_fn(n, |row, _| if row == axis { DIFFERENCE } else { 0.0 });
    let ahead = |x: &DVector<f64>| -> Vec<f64> {
        (0..n).into_par_iter().map(|axis| cost(&(x + unit(axis)))).collect()
    };
    let gradient = |x: &DVector<f64>, here: f64| {
        DVector::from_vec(ahead(x).into_iter().map(|value| (value - here) / DIFFERENCE).collect())
    };
    let mut x = DVector::zeros(n);
    let mut value = cost(&x);
    let (after, before): (Vec<f64>, Vec<f64>) = {
        let sides: Vec<f64> = (0..2 * n)
            .into_par_iter()
            .map(|side| cost(&if side < n { &x + unit(side) } else { &x - unit(side - n) }))
            .collect();
        (sides[..n].to_vec(), sides[n..].to_vec())
    };
    let mut slope = DVector::from_fn(n, |axis, _| (after[axis] - value) / DIFFERENCE);
    let mut inverse = DMatrix::from_diagonal(&DVector::from_fn(n, |axis, _| {
        let curvature = (after[axis] + before[axis] - 2.0 * value) / (DIFFERENCE * DIFFERENCE);
        1.0 / curvature.abs().max(LEAST_CURVATURE)
    }));
    for _ in 0..MOST_STEPS {
        let mut step = -(&inverse * &slope);
        if !step.iter().all(|s| s.is_finite()) {
            break;
        }
        // Not further than a factor of five at once.
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
    x
}
