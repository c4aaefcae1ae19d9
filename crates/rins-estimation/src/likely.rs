//! The most likely strengths of the noise: restricted maximum likelihood.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rins_frames::units::ARCSEC;

use crate::linear::Linear;
use crate::noise_parameters::Noise;
use crate::run::Reference;

/// How far, in logarithms, a data sheet's white noise may be off, 1σ.
pub(crate) const WHITE: f64 = 1.0;

/// The same for strengths of which nothing is known.
const UNKNOWN: f64 = 3.0;

/// The flicker, over the white noise of a second, where the search starts: about as much as shows within minutes.
const SHOWING: f64 = 0.25;

/// The same that is expected where nothing is said of it: without effect within an hour.
const UNSEEN: f64 = 0.01;

/// The velocity noise of a base that is not firm, where the search starts \[m/s\]: also what a velocity that is read in
/// steps of a millimetre a second leaves.
const UNSTEADY: f64 = 3e-4;

/// The root density with which the attitude of such a base strays, where the search starts \[rad/√s\]: one second of arc.
const SWAYING: f64 = ARCSEC;

/// The same of a base that is firm: a second of arc in three hours.
const FIRM: f64 = 0.01 * ARCSEC;

/// How far, in logarithms, what holds a base may be off, 1σ: from rock to a boat.
const ANYTHING: f64 = 5.0;

/// The least curvature that is believed.
const LEAST_CURVATURE: f64 = 0.1;

/// Where a search starts beside another one, a flicker is at least so strong, as a logarithm over where it shows.
const LEAST_SHOWING: f64 = -2.0;

/// A strength that a data sheet states is lost below this, as a logarithm over that: something else stands for it, and as
/// it does not show it has no slope that would lead back.
const LOST: f64 = -1.0;

/// The most steps of the search.
const MOST_STEPS: usize = 40;

/// The gain of log-likelihood below which the search ends.
const LEAST_GAIN: f64 = 0.02;

/// The step of one-sided differences, in logarithms: half of it is what the result is off by, so that it
/// must be small against what thousands of innovations show, and large against rounding.
const DIFFERENCE: f64 = 0.004;

/// One strength that is searched for.
#[derive(Clone, Debug, PartialEq)]
struct Unknown {
    which: Which,
    /// Where the search starts, in SI units.
    start: f64,
    /// The logarithm of what is expected over that.
    centre: f64,
    /// How far it may be off, as 1σ of its logarithm.
    sigma: f64,
}

impl Unknown {
    /// Whether every data sheet and rig file states it, so that it cannot be far off.
    fn is_stated(&self) -> bool {
        self.sigma <= WHITE
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
            Self::Sway(axis) => noise.iter_mut().map(|n| &mut n.sway[*axis]).collect(),
        }
    }
}

/// The noise of some runs.
fn on<'a>(noise: &'a mut [Noise], runs: &[usize]) -> impl Iterator<Item = &'a mut Noise> {
    let all = noise.iter_mut().enumerate();
    all.filter(move |(run, _)| runs.contains(run)).map(|(_, noise)| noise)
}

/// The most likely noise, and what else it might be.
pub(crate) struct Likely {
    /// The noise that makes the data most likely.
    pub(crate) noise: Vec<Noise>,
    /// Pairs of a stronger and a weaker flicker, √3 of its own σ away: the outer points of a Gauss-Hermite
    /// quadrature, each of which counts for a sixth.
    pub(crate) around: Vec<[Vec<Noise>; 2]>,
    /// The inverse of about the curvature where it was found, from which another search may start.
    pub(crate) inverse_curvature: DMatrix<f64>,
}

/// The step of second differences, in logarithms: about the σ of a flicker that shows.
const CURVATURE_STEP: f64 = 0.2;

/// How far at most, in logarithms, a flicker's strength is taken to be uncertain, 1σ: where it does not show at
/// all its curvature is the prior's, and so weak a flicker does not matter.
const MOST_UNCERTAIN: f64 = 0.6;

/// The noise that makes the data most likely, the parameters integrated out.
///
/// White noise of the sensors is known to a factor of e about what is expected, everything else to a factor of twenty,
/// as a log-normal prior; a strength that the data do not show stays where it does no harm. The search starts from
/// `first`, with the curvature of an earlier one if there was one.
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
    // Per unit of its prior's sigma, so that the search is equally brave in all.
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
    // Where much is missing from the model, noise that is lost has not been found by then: it would be lost again.
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
    // No pier holds what nothing reads: what that does is no noise of the sensors.
    let unread = |linear: &Linear| matches!(linear.reference, Reference::Gravity | Reference::Rest);
    let free = linear.iter().all(unread);
    let first = if free { expected } else { first };
    let (imu, sheet) = (first[0].imu, expected[0].imu);
    // Where nothing is said of flicker, little is expected, but the search starts where it would show.
    let flicker = |given: f64, white: f64| {
        if given > 0.0 { (given, given) } else { (SHOWING * white, UNSEEN * white) }
    };
    add(Which::GyroWhite, imu.gyro.white, sheet.gyro.white, WHITE);
    let (start, expect) = flicker(sheet.gyro.flicker, sheet.gyro.white);
    add(Which::GyroFlicker, start, expect, UNKNOWN);
    add(Which::AccelWhite, imu.accel.white, sheet.accel.white, WHITE);
    let (start, expect) = flicker(sheet.accel.flicker, sheet.accel.white);
    add(Which::AccelFlicker, start, expect, UNKNOWN);
    if sheet.gyro.walk > 0.0 {
        add(Which::GyroWalk, sheet.gyro.walk, sheet.gyro.walk, UNKNOWN);
    }
    if sheet.accel.walk > 0.0 {
        add(Which::AccelWalk, sheet.accel.walk, sheet.accel.walk, UNKNOWN);
    }
    if sheet.jitter > 0.0 {
        add(Which::Jitter, sheet.jitter, sheet.jitter, UNKNOWN);
    }
    for runs in rigs(linear) {
        let (first, expected) = (first[runs[0]], expected[runs[0]]);
        let read = matches!(linear[runs[0]].reference, Reference::Encoder { .. });
        if read {
            add(Which::Encoder(runs.clone()), first.encoder, expected.encoder, WHITE);
        }
        add(Which::Wobble(runs), first.wobble, expected.wobble, UNKNOWN);
    }
    // How well a table follows its command is told by nothing but the gyro.
    if linear.iter().any(|linear| matches!(linear.reference, Reference::Command { .. })) {
        add(Which::Sway(2), SWAYING, FIRM, ANYTHING);
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

/// The runs on each rig: those that were not switched off in between are on one.
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

/// Where the search starts: where nothing holds the base, at the best of some bases, from rock to a boat.
///
/// From the wrong one it would end where the sensors' noise stands for the base's, or the other way round.
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

/// Where a search starts beside one that has found `first`. Flicker that did not show there may show now.
fn near(unknown: &[Unknown], first: &[Noise]) -> DVector<f64> {
    let mut first = first.to_vec();
    let of = |unknown: &Unknown| {
        let found = unknown.which.of(&mut first).first().map_or(0.0, |strength| **strength);
        let from_start = (found / unknown.start).ln();
        if from_start.is_finite() { from_start.max(LEAST_SHOWING) } else { 0.0 }
    };
    DVector::from_iterator(unknown.len(), unknown.iter().map(of))
}

/// Where to search again if a strength was lost that is stated: as stated, and flicker as expected, for that may stand
/// for white noise; all else as it was found. `None` if none was.
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

/// Where `cost` is least, how little, and the inverse of about the curvature there: quasi-Newton steps (BFGS), derivatives by
/// differences.
///
/// Without an inverse the first step knows the curvature along every axis: strengths that thousands of figures show
/// and such that a few do differ a thousandfold in it.
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
    (x, value, inverse)
}
