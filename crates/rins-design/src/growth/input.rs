//! The sensor errors of a table at a constant rate as a Fourier series in its angle.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use rins_frames::{Body, Dcm, Table};
use rins_terms::{Instant, KinematicState, derivatives};

use super::service::{Columns, Service};

/// The highest harmonic of the table angle: a matrix of sensors that turns has the second, an error of the square of specific force the third.
pub(super) const HARMONICS: usize = 4;

/// The number of angles at which the errors are evaluated.
const ANGLES: usize = 16;

/// The derivatives of the states by the parameters, at each harmonic of the table angle: 7 × n.
pub(super) struct Input {
    pub(super) cos: Vec<Columns>,
    pub(super) sin: Vec<Columns>,
}

impl Input {
    /// That of a table at this rate \[rad/s\].
    pub(super) fn of(service: &Service<'_>, rate: f64) -> Self {
        let count = service.parameters.len();
        let none = || vec![Columns::zeros(count); HARMONICS + 1];
        let mut input = Self { cos: none(), sin: none() };
        for step in 0..ANGLES {
            let angle = TAU * step as f64 / ANGLES as f64;
            let at = at(service, angle, rate);
            for order in 0..=HARMONICS {
                let part = if order == 0 { 1.0 } else { 2.0 } / ANGLES as f64;
                let (sin, cos) = (order as f64 * angle).sin_cos();
                input.cos[order] += &at * (part * cos);
                input.sin[order] += &at * (part * sin);
            }
        }
        input
    }

    /// The mean while the table turns by `turn` from `angle` \[rad\].
    pub(super) fn mean(&self, angle: f64, turn: f64) -> Columns {
        let mut mean = self.cos[0].clone();
        for order in 1..=HARMONICS {
            let [from, by] = [angle, turn].map(|part| order as f64 * part);
            let half = 0.5 * by;
            let part = if half.abs() < 1e-6 { 1.0 } else { half.sin() / half };
            let (sin, cos) = (from + half).sin_cos();
            mean += (&self.cos[order] * cos + &self.sin[order] * sin) * part;
        }
        mean
    }
}

/// The derivatives of the states by the parameters at a table angle \[rad\].
fn at(service: &Service<'_>, angle: f64, rate: f64) -> Columns {
    let Service { surroundings, model, parameters, .. } = service;
    let table_from_body = Dcm::<Table, Body>::about_z(angle);
    let in_body = |vector: &Vector3<f64>| table_from_body.matrix().transpose() * vector;
    let now = Instant { angle, rate, ..Instant::default() };
    let moment = KinematicState {
        sample: 0,
        interval: 1e-3,
        duration: 1.0,
        mean: now,
        end: now,
        rate: in_body(&surroundings.earth_rate) + Vector3::z() * rate,
        force: in_body(&surroundings.specific_force),
        surroundings: *surroundings,
        track: None,
    };
    let nav_from_body = surroundings.nav_from_table.matrix() * table_from_body.matrix();
    let mut all = Columns::zeros(parameters.len());
    for (&(term, parameter), mut column) in parameters.iter().zip(all.column_iter_mut()) {
        let signals = model.terms[term].signals(&moment, Some(parameter));
        let rate = nav_from_body * derivatives(&signals.gyro);
        let force = nav_from_body * derivatives(&signals.accel);
        column.fixed_rows_mut::<3>(0).copy_from(&-rate);
        column.fixed_rows_mut::<2>(3).copy_from(&force.fixed_rows::<2>(0));
    }
    all
}
