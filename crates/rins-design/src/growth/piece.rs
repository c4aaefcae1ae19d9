//! The growth of navigation errors over a piece of constant table rate.

use nalgebra::{Matrix2, SMatrix, Vector3};
use rins_terms::Surroundings;

use super::input::{HARMONICS, Input};
use super::service::{GROWTH_STATES, Growth, Square};
use super::system::system;

/// The states with a cosine and a sine for each.
const DRIVEN: usize = 3 * GROWTH_STATES;

/// Twice the states.
const DOUBLED: usize = 2 * GROWTH_STATES;

/// The transition over a piece.
pub(super) struct Piece {
    transition: Square,
    /// For each harmonic of the table angle, `∫ exp(A (T - t)) cos(k ω t) dt` and the same with the sine.
    driven: Vec<[Square; 2]>,
    noise: Square,
}

impl Piece {
    /// A piece at a rate \[rad/s\] that lasts so long \[s\], with this white noise of gyros \[rad/√s\] and accelerometers \[m/s/√s\].
    pub(super) fn new(
        surroundings: &Surroundings,
        (rate, duration): (f64, f64),
        noise: [f64; 2],
    ) -> Self {
        let station = surroundings.station;
        let at_rest = Vector3::zeros();
        let system = system(&at_rest, &(Vector3::z() * station.gravity), &station.site);
        let driven = |order: usize| driven(&system, order as f64 * rate, duration);
        Self {
            transition: (system * duration).exp(),
            driven: (0..=HARMONICS).map(driven).collect(),
            noise: by_noise(&system, duration, noise),
        }
    }

    /// Adds the growth over the piece, at the start of which the table is at this angle \[rad\].
    pub(super) fn grow(&self, now: &mut Growth, input: &Input, angle: f64) {
        let Self { transition, driven, noise } = self;
        now.by_parameter = transition * &now.by_parameter;
        for (order, [by_cos, by_sin]) in driven.iter().enumerate() {
            let (sin, cos) = (order as f64 * angle).sin_cos();
            now.by_parameter += (by_cos * cos - by_sin * sin) * &input.cos[order];
            now.by_parameter += (by_sin * cos + by_cos * sin) * &input.sin[order];
        }
        now.by_start = transition * now.by_start;
        now.by_noise = transition * now.by_noise * transition.transpose() + noise;
    }
}

/// `∫ exp(A (T - t)) cos(k ω t) dt` and the same with the sine, over a piece: blocks of one matrix exponential.
fn driven(system: &Square, frequency: f64, duration: f64) -> [Square; 2] {
    const FIRST: usize = GROWTH_STATES;
    const SECOND: usize = 2 * GROWTH_STATES;
    let mut joint = SMatrix::<f64, DRIVEN, DRIVEN>::zeros();
    joint.fixed_view_mut::<GROWTH_STATES, GROWTH_STATES>(0, 0).copy_from(system);
    let turn = Matrix2::new(0.0, -frequency, frequency, 0.0);
    for state in 0..GROWTH_STATES {
        joint[(state, FIRST + state)] = 1.0;
        for row in 0..2 {
            for column in 0..2 {
                let (row_of, column_of) = ([FIRST, SECOND][row], [FIRST, SECOND][column]);
                joint[(row_of + state, column_of + state)] = turn[(row, column)];
            }
        }
    }
    let grown = (joint * duration).exp();
    let block = |column: usize| grown.fixed_view::<GROWTH_STATES, GROWTH_STATES>(0, column);
    [block(FIRST).into_owned(), -block(SECOND).into_owned()]
}

/// The covariance that white noise adds over a piece (C. F. Van Loan, IEEE Trans. Automatic Control 23(3), 1978).
fn by_noise(system: &Square, duration: f64, [gyro, accel]: [f64; 2]) -> Square {
    let mut joint = SMatrix::<f64, DOUBLED, DOUBLED>::zeros();
    joint.fixed_view_mut::<GROWTH_STATES, GROWTH_STATES>(0, 0).copy_from(&-system);
    joint
        .fixed_view_mut::<GROWTH_STATES, GROWTH_STATES>(GROWTH_STATES, GROWTH_STATES)
        .copy_from(&system.transpose());
    for state in 0..5 {
        let density = if state < 3 { gyro } else { accel };
        joint[(state, GROWTH_STATES + state)] = density * density;
    }
    let grown = (joint * duration).exp();
    let block = |row: usize| {
        grown.fixed_view::<GROWTH_STATES, GROWTH_STATES>(row, GROWTH_STATES).into_owned()
    };
    let added = block(GROWTH_STATES).transpose() * block(0);
    0.5 * (added + added.transpose())
}
