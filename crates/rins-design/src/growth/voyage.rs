//! The growth of navigation errors of a carried table: the linear model in short steps.

use nalgebra::{Matrix3, SMatrix};
use rins_frames::Site;
use rins_imu::{BiasProcess, NoiseModel, Span};
use rins_motion::CarriedTable;
use rins_terms::{Model, Surroundings};

use super::sensitivity::Sensitivity;
use super::service::{Columns, Square};
use super::system::system;
use super::{GROWTH_STATES, Growth, GrowthError};

/// The interval in which flicker noise is approximated \[s\].
pub const NOISE_INTERVAL: f64 = 0.5;

/// A step is at most so long \[s\], ...
const LONGEST_STEP: f64 = 10.0;

/// ... at most so much of a turn of the table \[rad\], ...
const LARGEST_TURN: f64 = 0.17;

/// ... and at most this part of the shortest period of the sway.
const PART_OF_PERIOD: f64 = 1.0 / 16.0;

/// The places of the two nodes of Gauss-Legendre quadrature on [-1, 1].
const NODE: f64 = 0.577_350_269_189_625_8;

/// A system on a carrier: how it moves, and the errors that it has.
#[derive(Clone, Copy, Debug)]
pub struct Voyage<'a> {
    /// The table and its carrier.
    pub table: &'a CarriedTable,
    /// The error model, at the values about which it is linear; its terms must be affine in rate and specific force.
    pub model: &'a Model,
    /// The parameters of it whose errors grow, as term and place within it.
    pub parameters: &'a [(usize, usize)],
    /// The noise of gyros \[rad/s and its multiples\] and accelerometers \[m/s² and its multiples\]: white noise, bias random walk,
    /// Gauss-Markov processes and flicker noise.
    pub noise: [&'a NoiseModel; 2],
}

/// The covariance of the states with the biases of one process on the three axes of a triad.
struct Wandering {
    process: BiasProcess,
    /// The variance of the bias on each axis.
    variance: f64,
    /// States and biases, 7 × 3.
    with_states: SMatrix<f64, GROWTH_STATES, 3>,
}

impl Voyage<'_> {
    /// The navigation errors at these times \[s\], in ascending order.
    ///
    /// The linear model is that of [`Service`](super::Service) with the velocity of the carrier in it: `φ' = -ω_in × φ + δω_in - C_b^n δω_ib`,
    /// `δv' = f × φ + C_b^n δf - (2 ω_ie + ω_en) × δv - (2 δω_ie + δω_en) × v` (‹groves2013›, section 14.2.4), with the vertical channel held.
    ///
    /// # Errors
    /// [`GrowthError`] if a time or a term is not as it must be, or the voyage comes to a pole.
    pub fn growth(&self, times: &[f64]) -> Result<Vec<Growth>, GrowthError> {
        super::check_times(times)?;
        let station = self.table.station;
        let surroundings = Surroundings::new(station, self.table.mounting);
        let each = Sensitivity::of_each(self.model, self.parameters, &surroundings)?;
        let last = times.last().copied().unwrap_or_default();
        let span = Span { interval: NOISE_INTERVAL, duration: last.max(NOISE_INTERVAL) };
        let mut wandering = self.noise.map(|model| {
            let start = |process: BiasProcess| Wandering {
                process,
                variance: process.initial_sigma().powi(2),
                with_states: SMatrix::zeros(),
            };
            model.bias_processes(&span).into_iter().map(start).collect::<Vec<_>>()
        });
        let white = self.noise.map(|model| model.white_density.powi(2));
        let longest = self.longest_step();
        let mut now = Growth {
            time: 0.0,
            by_parameter: Columns::zeros(each.len()),
            by_start: Square::identity(),
            by_noise: Square::zeros(),
        };
        let mut site = station.site;
        let mut corner = self.table.next_corner(0.0);
        let mut grown = Vec::with_capacity(times.len());
        for &time in times {
            while now.time < time {
                let to = (now.time + longest).min(corner).min(time);
                self.step(&mut now, (&mut site, to), &each, (&white, &mut wandering));
                if site.latitude.cos().abs() < 1e-6 {
                    return Err(GrowthError::Pole);
                }
                if corner <= to {
                    corner = self.table.next_corner(corner);
                }
            }
            grown.push(now.clone());
        }
        Ok(grown)
    }

    fn longest_step(&self) -> f64 {
        let sway =
            self.table.carrier.shortest_period().map_or(f64::INFINITY, |t| t * PART_OF_PERIOD);
        (LARGEST_TURN / self.table.fastest()).min(sway).min(LONGEST_STEP)
    }

    /// Grows the errors until `to` \[s\].
    fn step(
        &self,
        now: &mut Growth,
        (site, to): (&mut Site, f64),
        each: &[Sensitivity],
        (white, wandering): (&[f64; 2], &mut [Vec<Wandering>; 2]),
    ) {
        let table = self.table;
        let step = to - now.time;
        let middle_time = now.time + 0.5 * step;
        let middle_site = table.advanced(site, now.time, middle_time);
        let middle = table.state(middle_time, &middle_site);
        let a = system(&middle.velocity, &middle.force, &middle_site);
        let squared = a * a;
        // The transition from an instant of the step, so long before its end, to the end.
        let transition_over = |time: f64| {
            let [first, second, third] = [time, time * time / 2.0, time.powi(3) / 6.0];
            let cubed = squared * a;
            Square::identity()
                + a * first
                + squared * second
                + cubed * third
                + squared * squared * (third * time / 4.0)
        };
        let transition = transition_over(step);
        now.by_parameter = transition * &now.by_parameter;
        now.by_start = transition * now.by_start;
        let nodes = [-NODE, NODE].map(|node| {
            let state = table.state(middle_time + 0.5 * step * node, &middle_site);
            (state, transition_over(0.5 * step * (1.0 - node)))
        });
        let mut input = Columns::zeros(each.len());
        for (state, to_end) in &nodes {
            for (one, mut column) in each.iter().zip(input.column_iter_mut()) {
                let sensed = (&state.body_rate, &state.body_force);
                let rate = state.nav_from_body * one.gyro.at(sensed.0, sensed.1);
                let force = state.nav_from_body * one.accel.at(sensed.0, sensed.1);
                for axis in 0..3 {
                    column[axis] = -rate[axis] * (0.5 * step);
                }
                column[3] = force.x * (0.5 * step);
                column[4] = force.y * (0.5 * step);
            }
            now.by_parameter += to_end * &input;
        }

        let [h, h2, h3] = [step, step * step / 2.0, step.powi(3) / 6.0];
        let mut density = Square::zeros();
        for state in 0..5 {
            density[(state, state)] = white[usize::from(state > 2)];
        }
        let (once, twice) = (a * density, squared * density);
        let added = density * h
            + (once + once.transpose()) * h2
            + (twice + twice.transpose() + once * a.transpose() * 2.0) * h3;
        now.by_noise = transition * now.by_noise * transition.transpose() + added;
        for (triad, all) in wandering.iter_mut().enumerate() {
            let reach = nodes
                .each_ref()
                .map(|(state, to_end)| to_end * of_triad(triad, &state.nav_from_body));
            let reach = (reach[0] + reach[1]) * 0.5;
            for one in all {
                one.step((&transition, &reach, step), &mut now.by_noise);
            }
        }
        *site = table.advanced(&middle_site, middle_time, to);
        now.time = to;
    }
}

impl Wandering {
    /// Adds what the bias contributes over a step, of which `reach` is the effect of an integrated bias on the states.
    fn step(
        &mut self,
        (transition, reach, step): (&Square, &SMatrix<f64, GROWTH_STATES, 3>, f64),
        covariance: &mut Square,
    ) {
        let by = self.process.step(step);
        let noise = by.spread * by.spread;
        // The integral has the mean `weight (1 + decay)` times the bias at the start.
        let mean = by.weight * (1.0 + by.decay);
        let cross = transition * self.with_states * reach.transpose() * mean;
        let own = mean * mean * self.variance + by.weight * by.weight * noise + by.residual;
        *covariance += cross + cross.transpose() + reach * reach.transpose() * own;
        self.with_states = transition * self.with_states * by.decay
            + reach * (mean * by.decay * self.variance + by.weight * noise);
        self.variance = by.decay * by.decay * self.variance + noise;
    }
}

/// The effect of an error of each sensor of a triad, gyros first, on the derivatives of the states.
fn of_triad(triad: usize, nav_from_body: &Matrix3<f64>) -> SMatrix<f64, GROWTH_STATES, 3> {
    let mut reach = SMatrix::<f64, GROWTH_STATES, 3>::zeros();
    if triad == 0 {
        reach.fixed_view_mut::<3, 3>(0, 0).copy_from(&-nav_from_body);
    } else {
        reach.fixed_view_mut::<2, 3>(3, 0).copy_from(&nav_from_body.fixed_view::<2, 3>(0, 0));
    }
    reach
}
