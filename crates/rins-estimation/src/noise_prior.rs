//! The noise parameters that are estimated, with their priors.

use rins_frames::units::ARCSEC;

use crate::estimate::Fit;
use crate::linear::Linear;
use crate::noise_parameters::{Noise, NoiseKnowledge, NoiseParameters};
use crate::run::{Reference, Run};

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

/// A noise parameter to be estimated.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Unknown {
    pub(crate) which: Which,
    /// The initial value, in SI units.
    pub(crate) start: f64,
    /// The logarithm of the prior mean relative to the initial value.
    pub(crate) centre: f64,
    /// 1σ of the logarithm in the prior.
    pub(crate) sigma: f64,
}

impl Unknown {
    /// Whether every data sheet or rig file states it, so that the prior is narrow.
    pub(crate) fn is_stated(&self) -> bool {
        self.sigma <= STATED
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Which {
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
    /// Whether few data determine it: the parameter of a slow process, or of one that shows at some rates only.
    pub(crate) const fn is_colored(&self) -> bool {
        matches!(
            self,
            Self::GyroFlicker
                | Self::AccelFlicker
                | Self::GyroWalk
                | Self::AccelWalk
                | Self::Jitter
        )
    }

    pub(crate) fn of<'a>(&self, noise: &'a mut [Noise]) -> Vec<&'a mut f64> {
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

impl Fit {
    /// The logarithm of the prior density of noise parameters of the runs of the fit, up to a constant: the priors of
    /// the estimation, about the noise parameters in `knowledge`. Zero if they are known.
    pub fn log_prior_of_noise(
        &self,
        runs: &[Run],
        knowledge: NoiseKnowledge,
        noise: &[Noise],
    ) -> f64 {
        if !knowledge.is_estimated() {
            return 0.0;
        }
        let stated = knowledge.sheet();
        let expected: Vec<Noise> = runs.iter().map(|run| Noise::on(&run.rig, &stated)).collect();
        let mut noise = noise.to_vec();
        let of = |unknown: Unknown| {
            let value = unknown.which.of(&mut noise).first().map_or(0.0, |slot| **slot);
            let sigmas = ((value / unknown.start).ln() - unknown.centre) / unknown.sigma;
            -0.5 * sigmas * sigmas
        };
        unknowns(&self.linear, (&expected, &knowledge.open()), &expected).into_iter().map(of).sum()
    }
}

/// The noise parameters that these runs need, in order. The priors are about `expected`, and about the processes in `open` that are not
/// stated.
pub(crate) fn unknowns(
    linear: &[Linear],
    (expected, open): (&[Noise], &NoiseParameters),
    first: &[Noise],
) -> Vec<Unknown> {
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
    // The search for an unstated random walk starts where it is as visible over the run as the other noise.
    let duration = linear.iter().map(Linear::duration).fold(0.0, f64::max);
    let walks = [
        (Which::GyroWalk, (sheet.gyro.walk, imu.gyro), open.gyro.walk),
        (Which::AccelWalk, (sheet.accel.walk, imu.accel), open.accel.walk),
    ];
    for (which, (stated, beside), open) in walks {
        if stated > 0.0 {
            add(which, stated, stated, STATED);
        } else if open > 0.0 {
            add(which, beside.walk_as_visible(duration), open, UNKNOWN);
        }
    }
    let jitter = if sheet.jitter > 0.0 { sheet.jitter } else { open.jitter };
    if jitter > 0.0 {
        add(Which::Jitter, jitter, jitter, UNKNOWN);
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
