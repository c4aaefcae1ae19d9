//! The catalogue: every effect that is known here, by id.

mod base;
mod triads;

pub use base::{AXIS_ATTITUDE, ENCODER_ZERO, MOUNTING};
pub use triads::{
    ACCEL_BIAS, ACCEL_MISALIGNMENT, ACCEL_SCALE, GYRO_BIAS, GYRO_MISALIGNMENT, GYRO_SCALE,
};

use crate::term::Term;

/// All terms: those of the baseline first, then gyros, accelerometers, table and timing, base and place.
pub static CATALOGUE: &[&Term] = &[
    &GYRO_BIAS,
    &GYRO_SCALE,
    &GYRO_MISALIGNMENT,
    &ACCEL_BIAS,
    &ACCEL_SCALE,
    &ACCEL_MISALIGNMENT,
    &AXIS_ATTITUDE,
    &MOUNTING,
    &ENCODER_ZERO,
];

/// The term of this id.
pub fn term(id: &str) -> Option<&'static Term> {
    CATALOGUE.iter().copied().find(|term| term.id == id)
}
