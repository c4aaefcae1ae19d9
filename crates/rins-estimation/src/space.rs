//! The states beside the parameters, and how an epoch carries and shows them.
//!
//! First attitude and velocity, then the angles by which a servo or a base strays, then the processes of coloured
//! noise, three numbers each.

use nalgebra::{DMatrix, Matrix3, SMatrix};
use rins_frames::cross_matrix;

use crate::colour::{Colours, Passage};
use crate::epoch::{Epoch, Held, Turning};
use crate::linear::Linear;
use crate::noise_parameters::Noise;
use crate::run::Reference;
use crate::step::{NAVIGATION, SHOWN, Step, Weight};

/// How far a first attitude may be off where its epoch's readings put it \[rad\].
const START_ATTITUDE: f64 = 2e-3;

/// The same about an axis whose angle only gravity shows \[rad\].
const START_ANGLE_BY_GRAVITY: f64 = 0.2;

/// The least 1σ of an epoch's mean angle where the reference is exact \[rad\].
const EXACT: f64 = 1e-10;

/// The triad that a process belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Of {
    Gyro,
    Accel,
}

/// The states and their noise for a linear run.
pub(crate) struct Space<'a> {
    linear: &'a Linear,
    white: [f64; 2],
    /// Angles that walk away from what the readings take for fixed: about which axis, and the root density \[rad/√s\].
    astray: Vec<(usize, f64)>,
    colours: Vec<(Of, crate::colour::Process)>,
    /// What each process does over an epoch of the usual length, which is nearly every one's \[s\].
    usual: (f64, Vec<Passage>),
    force_cross: Matrix3<f64>,
    wobble: f64,
    encoder: f64,
    /// 1σ of the moments at which the encoder is read \[s\].
    jitter: f64,
    velocity: f64,
}

impl<'a> Space<'a> {
    pub(crate) fn new(linear: &'a Linear, noise: &Noise) -> Self {
        let strengths = &noise.imu;
        let (epoch, duration) = (linear.mean_epoch(), linear.duration());
        let gyro = Colours::of(&strengths.gyro, epoch, duration);
        let accel = Colours::of(&strengths.accel, epoch, duration);
        let mut astray: Vec<(usize, f64)> = match linear.reference {
            Reference::Command { noise: stated } => vec![(2, stated.hypot(noise.sway[2]))],
            Reference::Encoder { .. } => Vec::new(),
            Reference::Gravity => noise.sway.into_iter().enumerate().take(2).collect(),
            Reference::Rest => noise.sway.into_iter().enumerate().collect(),
        };
        astray.retain(|(_, density)| *density > 0.0);
        let white = [
            strengths.gyro.white.powi(2) + gyro.white,
            strengths.accel.white.powi(2) + accel.white,
        ];
        let of = |of, colours: Colours| colours.processes.into_iter().map(move |p| (of, p));
        let colours: Vec<_> = of(Of::Gyro, gyro).chain(of(Of::Accel, accel)).collect();
        let usual = linear.epochs.first().map_or(epoch, |epoch| epoch.duration);
        let passages = colours.iter().map(|(_, process)| process.passage(usual)).collect();
        Self {
            linear,
            white,
            astray,
            colours,
            usual: (usual, passages),
            force_cross: cross_matrix(&linear.force),
            wobble: noise.wobble,
            encoder: noise.encoder,
            jitter: strengths.jitter,
            velocity: noise.velocity,
        }
    }

    /// How many states there are.
    pub(crate) fn states(&self) -> usize {
        self.first_colour() + 3 * self.colours.len()
    }

    fn first_colour(&self) -> usize {
        NAVIGATION + self.astray.len()
    }

    /// The covariance at the start of a run.
    pub(crate) fn start(&self) -> DMatrix<f64> {
        let mut covariance = DMatrix::zeros(self.states(), self.states());
        self.forget_navigation(&mut covariance);
        for (index, (_, process)) in self.colours.iter().enumerate() {
            for axis in 0..3 {
                let place = self.first_colour() + 3 * index + axis;
                covariance[(place, place)] = process.initial_variance();
            }
        }
        covariance
    }

    /// Nothing is known of attitude and velocity any more, but what is known of any fixed table's.
    pub(crate) fn forget_navigation(&self, covariance: &mut DMatrix<f64>) {
        covariance.rows_mut(0, NAVIGATION).fill(0.0);
        covariance.columns_mut(0, NAVIGATION).fill(0.0);
        let angle = if self.linear.shows_angle() { START_ATTITUDE } else { START_ANGLE_BY_GRAVITY };
        let velocity = self.velocity;
        for (place, sigma) in
            [START_ATTITUDE, START_ATTITUDE, angle, velocity, velocity, velocity].iter().enumerate()
        {
            covariance[(place, place)] = sigma * sigma;
        }
    }

    /// A step of nothing yet, whose rows of states are this long.
    pub(crate) fn blank(&self, length: usize) -> Step {
        let weight = |index: usize| {
            let place = self.first_colour() + 3 * index;
            Weight { place, mean: 0.0, half_mean: 0.0 }
        };
        let all = self.colours.iter().enumerate();
        let of = |triad| {
            all.clone()
                .filter(|(_, (of, _))| *of == triad)
                .map(|(index, _)| weight(index))
                .collect()
        };
        Step {
            turned: Matrix3::zeros(),
            mean_turned: Matrix3::zeros(),
            pulled: Matrix3::zeros(),
            body: Turning::default(),
            body_pulled: Matrix3::zeros(),
            astray: self.astray.iter().map(|&(axis, _)| axis).collect(),
            gyros: of(Of::Gyro),
            accels: of(Of::Accel),
            shows_angle: self.linear.shows_angle(),
            decay: vec![1.0; length],
            colour_noise: vec![0.0; length],
            shown: SMatrix::zeros(),
            noise: DMatrix::zeros(length, NAVIGATION),
            cross: DMatrix::zeros(length, SHOWN),
        }
    }

    /// An epoch as a linear system.
    pub(crate) fn step(&self, epoch: &Epoch) -> Step {
        let mut step = self.blank(self.states());
        self.set(epoch, &mut step);
        step
    }

    /// Makes an epoch of a step that was one of this space's.
    pub(crate) fn set(&self, epoch: &Epoch, step: &mut Step) {
        let t = epoch.duration;
        let identity = Matrix3::identity();
        let turning = cross_matrix(&self.linear.earth_rate);
        // The mean over the readings, each at the end of a sample, and the integral.
        let middle = 0.5 * t * (1.0 + epoch.count().recip());
        let integral = identity * t - turning * (0.5 * t * t);
        step.turned = identity - turning * t;
        step.mean_turned = identity - turning * middle;
        step.pulled = -self.force_cross * integral;
        step.body = epoch.turning;
        step.body_pulled = self.force_cross * epoch.turning.twice;
        self.set_white(epoch, step);
        for (index, &(axis, density)) in self.astray.iter().enumerate() {
            let variance = density * density * t;
            let (of_mean, with_end) = mean_of_walk(epoch.count());
            step.colour_noise[NAVIGATION + index] = variance;
            // Readings are means over the epoch, in which it strays already.
            step.shown[(axis, axis)] += variance * of_mean;
            step.cross[(NAVIGATION + index, axis)] = -variance * with_end;
        }
        // Durations are sums of time stamps' differences: they differ in the last digits.
        let usual = (t - self.usual.0).abs() <= 1e-9 * t;
        let mean_turn = epoch.turning.turned / t;
        let gyros = step.gyros.len();
        for (index, (of, process)) in self.colours.iter().enumerate() {
            let passage = if usual { self.usual.1[index] } else { process.passage(t) };
            let weight = match of {
                Of::Gyro => &mut step.gyros[index],
                Of::Accel => &mut step.accels[index - gyros],
            };
            (weight.mean, weight.half_mean) = (passage.mean, passage.half_mean);
            let place = weight.place;
            add_colour((*of, place), &mean_turn, &passage, step);
        }
        if !step.shows_angle {
            // The row shows nothing: it is one of pure noise, of variance one.
            step.cross.column_mut(2).fill(0.0);
            step.shown.row_mut(2).fill(0.0);
            step.shown.column_mut(2).fill(0.0);
            step.shown[(2, 2)] = 1.0;
        }
    }

    /// White noise of both triads, of the readings and of the base.
    fn set_white(&self, epoch: &Epoch, step: &mut Step) {
        let (t, m) = (epoch.duration, epoch.count());
        let [gyro, accel] = self.white;
        let identity = Matrix3::identity();
        let (of_mean, with_end) = mean_of_walk(m);
        let (mean_variance, mean_covariance) = (gyro * t * of_mean, gyro * t * with_end);
        let f = &self.force_cross;
        // φ gains W, v gains -F × ∫W dt besides its own noise.
        let velocity = identity * (accel * t) + f * f.transpose() * (gyro * t * t * t / 3.0);
        let across = f.transpose() * (gyro * t * t / 2.0);
        let mean_across = f.transpose() * (gyro * t * t / 3.0);
        set(&mut step.noise, 0, 0, &(identity * (gyro * t)));
        set(&mut step.noise, 0, 3, &-across);
        set(&mut step.noise, 3, 0, &-across.transpose());
        set(&mut step.noise, 3, 3, &velocity);
        set(&mut step.cross, 0, 0, &(identity * mean_covariance));
        set(&mut step.cross, 0, 3, &-across);
        set(&mut step.cross, 3, 0, &-mean_across.transpose());
        set(&mut step.cross, 3, 3, &velocity);
        let wobble = self.wobble * self.wobble / m;
        let angle = match self.linear.reference {
            Reference::Encoder { .. } => {
                // Read too late, a table that turns is further on.
                let further = self.jitter * self.linear.turned(epoch) / epoch.duration;
                (self.encoder.powi(2) + further.powi(2)) / m + epoch.rounding
            }
            Reference::Command { .. } => EXACT * EXACT,
            Reference::Gravity | Reference::Rest => wobble,
        };
        let base = self.velocity.powi(2);
        let readings = Matrix3::from_diagonal(&[wobble, wobble, angle].into());
        let shown = &mut step.shown;
        let mut set = |row, column, block: &Matrix3<f64>| {
            shown.fixed_view_mut::<3, 3>(row, column).copy_from(block);
        };
        set(0, 0, &(identity * mean_variance + readings));
        set(0, 3, &-mean_across);
        set(3, 0, &-mean_across.transpose());
        set(3, 3, &(velocity + identity * base));
        if let Some(held) = &epoch.held {
            set_held(held, step);
        }
    }
}

/// Adds what is not known where samples are missing.
fn set_held(held: &Held, step: &mut Step) {
    for axis in 0..3 {
        step.noise[(axis, axis)] += held.angle[axis];
        step.cross[(axis, axis)] += held.angle_with_mean[axis];
        step.shown[(axis, axis)] += held.mean_angle[axis];
        let of_velocity = 3 + axis;
        step.noise[(of_velocity, of_velocity)] += held.velocity[axis];
        step.cross[(of_velocity, of_velocity)] += held.velocity[axis];
        step.shown[(of_velocity, of_velocity)] += held.velocity[axis];
    }
}

/// A process with memory, of a triad, whose three states begin at a place.
fn add_colour(
    (of, place): (Of, usize),
    mean_turn: &Matrix3<f64>,
    passage: &Passage,
    step: &mut Step,
) {
    step.decay[place..place + 3].fill(passage.decay);
    step.colour_noise[place..place + 3].fill(passage.end);
    let of_end = -mean_turn.transpose() * passage.end_integral;
    match of {
        Of::Gyro => {
            set(&mut step.noise, place, 0, &of_end);
            set(&mut step.cross, place, 0, &(-mean_turn.transpose() * passage.end_half));
            for axis in 0..3 {
                step.noise[(axis, axis)] += passage.integral;
                step.cross[(axis, axis)] += passage.integral_half;
                step.shown[(axis, axis)] += passage.half;
            }
        }
        Of::Accel => {
            set(&mut step.noise, place, 3, &of_end);
            set(&mut step.cross, place, 3, &of_end);
            for axis in 3..6 {
                step.noise[(axis, axis)] += passage.integral;
                step.cross[(axis, axis)] += passage.integral;
                step.shown[(axis, axis)] += passage.integral;
            }
        }
    }
}

/// Of a random walk of `m` equal steps, its mean over the steps' ends: variance, and covariance with the end, as parts of
/// the end's variance.
fn mean_of_walk(m: f64) -> (f64, f64) {
    ((m + 1.0) * (2.0 * m + 1.0) / (6.0 * m * m), (m + 1.0) / (2.0 * m))
}

fn set(to: &mut DMatrix<f64>, row: usize, column: usize, block: &Matrix3<f64>) {
    to.fixed_view_mut::<3, 3>(row, column).copy_from(block);
}
