//! The states of the filter other than the parameters, and the linear system of an epoch.
//!
//! The states are attitude and velocity, then the random-walk angles of a servo or a base, then the colored-noise processes
//! with three states each.

use nalgebra::{DMatrix, Matrix3, SMatrix, Vector3};
use rins_frames::cross_matrix;

use crate::colour::{Colours, Passage};
use crate::epoch::{Epoch, Held, Turning};
use crate::linear::Linear;
use crate::noise_parameters::Noise;
use crate::run::Reference;
use crate::step::{NAVIGATION, SHOWN, Step, Weight};

/// 1σ of the attitude at the start, relative to the readings of its epoch \[rad\].
const START_ATTITUDE: f64 = 2e-3;

/// The same about an axis whose angle is measured only by gravity \[rad\].
const START_ANGLE_BY_GRAVITY: f64 = 0.2;

/// The smallest 1σ of the mean angle of an epoch if the reference is exact \[rad\].
const EXACT: f64 = 1e-10;

/// The triad that a process belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Of {
    Gyro,
    Accel,
}

/// The states and their noise for a linear run.
#[derive(Clone, Debug)]
pub(crate) struct Space {
    reference: Reference,
    white: [f64; 2],
    /// Random-walk angles of the reference: axis, and density \[rad/√s\].
    astray: Vec<(usize, f64)>,
    colours: Vec<(Of, crate::colour::Process)>,
    /// The transition of each process over an epoch of the usual duration, which nearly all epochs have; the duration in
    /// \[s\].
    usual: (f64, Vec<Passage>),
    /// The cross-product matrices of the specific force and of the Earth's rate in the axis frame.
    force_cross: Matrix3<f64>,
    turning: Matrix3<f64>,
    wobble: f64,
    encoder: f64,
    /// 1σ of the times of the encoder readings \[s\].
    jitter: f64,
    velocity: f64,
}

/// The durations that determine which processes of colored noise are states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Durations {
    /// The mean duration of an epoch \[s\].
    pub(crate) mean: f64,
    /// The duration of nearly all epochs \[s\].
    pub(crate) usual: f64,
    /// The duration of the run \[s\].
    pub(crate) run: f64,
}

impl Space {
    pub(crate) fn new(linear: &Linear, noise: &Noise) -> Self {
        let mean = linear.mean_epoch();
        let usual = linear.epochs.first().map_or(mean, |epoch| epoch.duration);
        let durations = Durations { mean, usual, run: linear.duration() };
        let mut space = Self::of(linear.reference, durations, noise);
        space.set_around(&linear.force, &linear.earth_rate);
        space
    }

    /// The same for epochs of these durations, in surroundings that are yet to be set.
    pub(crate) fn of(reference: Reference, durations: Durations, noise: &Noise) -> Self {
        let strengths = &noise.imu;
        let Durations { mean, usual, run } = durations;
        let gyro = Colours::of(&strengths.gyro, mean, run);
        let accel = Colours::of(&strengths.accel, mean, run);
        let mut astray: Vec<(usize, f64)> = match reference {
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
        let passages = colours.iter().map(|(_, process)| process.passage(usual)).collect();
        Self {
            reference,
            white,
            astray,
            colours,
            usual: (usual, passages),
            force_cross: Matrix3::zeros(),
            turning: Matrix3::zeros(),
            wobble: noise.wobble,
            encoder: noise.encoder,
            jitter: strengths.jitter,
            velocity: noise.velocity,
        }
    }

    /// Sets the specific force \[m/s²\] and the Earth's rate \[rad/s\] in the axis frame.
    pub(crate) fn set_around(&mut self, force: &Vector3<f64>, earth_rate: &Vector3<f64>) {
        self.force_cross = cross_matrix(force);
        self.turning = cross_matrix(earth_rate);
    }

    /// Whether the angle about the axis is measured.
    pub(crate) fn shows_angle(&self) -> bool {
        self.reference.shows_angle()
    }

    /// The number of states.
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

    /// Resets the covariance of attitude and velocity to its initial value, without correlations to other states.
    pub(crate) fn forget_navigation(&self, covariance: &mut DMatrix<f64>) {
        covariance.rows_mut(0, NAVIGATION).fill(0.0);
        covariance.columns_mut(0, NAVIGATION).fill(0.0);
        let angle = if self.shows_angle() { START_ATTITUDE } else { START_ANGLE_BY_GRAVITY };
        let velocity = self.velocity;
        for (place, sigma) in
            [START_ATTITUDE, START_ATTITUDE, angle, velocity, velocity, velocity].iter().enumerate()
        {
            covariance[(place, place)] = sigma * sigma;
        }
    }

    /// An empty step with rows of states of this length.
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
            shows_angle: self.shows_angle(),
            decay: vec![1.0; length],
            colour_noise: vec![0.0; length],
            shown: SMatrix::zeros(),
            noise: DMatrix::zeros(length, NAVIGATION),
            cross: DMatrix::zeros(length, SHOWN),
        }
    }

    /// The linear system of an epoch.
    pub(crate) fn step(&self, epoch: &Epoch) -> Step {
        let mut step = self.blank(self.states());
        self.set(epoch, &mut step);
        step
    }

    /// Sets a step of this space to the linear system of an epoch.
    pub(crate) fn set(&self, epoch: &Epoch, step: &mut Step) {
        let t = epoch.duration;
        let identity = Matrix3::identity();
        let turning = self.turning;
        // The mean over the readings, each of which is at the end of a sample, and the integral.
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
            // Readings are means over the epoch, during which the random walk continues.
            step.shown[(axis, axis)] += variance * of_mean;
            step.cross[(NAVIGATION + index, axis)] = -variance * with_end;
        }
        // Durations are sums of time differences: they differ in the last digits.
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
            // The row is not a measurement: it is pure noise of variance one.
            step.cross.column_mut(2).fill(0.0);
            step.shown.row_mut(2).fill(0.0);
            step.shown.column_mut(2).fill(0.0);
            step.shown[(2, 2)] = 1.0;
        }
    }

    /// Adds the white noise of both triads, of the readings and of the base.
    fn set_white(&self, epoch: &Epoch, step: &mut Step) {
        let (t, m) = (epoch.duration, epoch.count());
        let [gyro, accel] = self.white;
        let identity = Matrix3::identity();
        let (of_mean, with_end) = mean_of_walk(m);
        let (mean_variance, mean_covariance) = (gyro * t * of_mean, gyro * t * with_end);
        let f = &self.force_cross;
        // φ increases by W; v increases by -F × ∫W dt in addition to its own noise.
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
        let angle = match self.reference {
            Reference::Encoder { .. } => {
                // A time error of a reading is an angle error in proportion to the table rate.
                let further = self.jitter * epoch.rotation / epoch.duration;
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

/// Adds the uncertainty due to missing samples.
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

/// Adds the noise of a colored-noise process of a triad, whose three states begin at `place`.
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

/// The variance of the mean over the step ends of a random walk of `m` equal steps, and its covariance with the end value,
/// both relative to the variance of the end value.
fn mean_of_walk(m: f64) -> (f64, f64) {
    ((m + 1.0) * (2.0 * m + 1.0) / (6.0 * m * m), (m + 1.0) / (2.0 * m))
}

fn set(to: &mut DMatrix<f64>, row: usize, column: usize, block: &Matrix3<f64>) {
    to.fixed_view_mut::<3, 3>(row, column).copy_from(block);
}
