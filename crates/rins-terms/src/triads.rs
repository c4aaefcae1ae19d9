//! Eq. (1) as terms, and terms as eq. (1).

use rins_imu::{ImuError, TriadError};

use crate::catalogue::{
    ACCEL_BIAS, ACCEL_MISALIGNMENT, ACCEL_SCALE, GYRO_BIAS, GYRO_MISALIGNMENT, GYRO_SCALE,
};
use crate::model::{Model, TermInstance};
use crate::term::Term;

/// The rows and columns of the misalignments, in the order of the terms' parameters.
const OFF_DIAGONAL: [(usize, usize); 6] = [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)];

/// Bias, scale and misalignment of the gyros, then of the accelerometers.
static TERMS: [[&Term; 3]; 2] = [
    [&GYRO_BIAS, &GYRO_SCALE, &GYRO_MISALIGNMENT],
    [&ACCEL_BIAS, &ACCEL_SCALE, &ACCEL_MISALIGNMENT],
];

/// The biases, scale errors and misalignments of both triads as six terms, all held.
///
/// ```
/// use rins_imu::{Axis, ImuError, TriadError};
/// use rins_terms::Model;
/// let gyro = TriadError::default().with_misalignment(Axis::X, Axis::Z, 3e-4);
/// let model = Model::from(&ImuError { gyro, ..ImuError::default() });
/// assert_eq!(model.value("gyro.misalignment.xz"), Some(3e-4));
/// ```
impl From<&ImuError> for Model {
    fn from(error: &ImuError) -> Self {
        let triads = [&error.gyro, &error.accel];
        let terms = TERMS.iter().zip(triads).flat_map(|([bias, scale, misalignment], triad)| {
            let crossed = OFF_DIAGONAL.map(|place| triad.matrix[place]);
            [
                TermInstance::new(bias).with_values(triad.bias.as_slice()),
                TermInstance::new(scale).with_values(triad.matrix.diagonal().as_slice()),
                TermInstance::new(misalignment).with_values(&crossed),
            ]
        });
        Self { terms: terms.collect() }
    }
}

impl Model {
    /// Its biases, scale errors and misalignments as eq. (1) has them, and its other terms.
    pub fn split(&self) -> (ImuError, Self) {
        let (mut error, mut others) = (ImuError::default(), Self::default());
        for chosen in &self.terms {
            let is = |term: &Term| term.is(chosen.term);
            let triad = TERMS.iter().position(|terms| terms.iter().any(|term| is(term)));
            match triad {
                Some(0) => add(&mut error.gyro, chosen),
                Some(_) => add(&mut error.accel, chosen),
                None => others.terms.push(chosen.clone()),
            }
        }
        (error, others)
    }
}

/// Adds a term of eq. (1) to a triad's errors.
fn add(triad: &mut TriadError, chosen: &TermInstance) {
    let values = &chosen.values;
    let kind = TERMS.iter().find_map(|terms| terms.iter().position(|term| term.is(chosen.term)));
    match kind {
        Some(0) => values.iter().zip(triad.bias.iter_mut()).for_each(|(value, to)| *to += value),
        Some(1) => (0..3).for_each(|axis| triad.matrix[(axis, axis)] += values[axis]),
        _ => {
            OFF_DIAGONAL.iter().zip(values).for_each(|(&at, value)| triad.matrix[at] += value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};
    use proptest::prelude::*;

    fn any_triad() -> impl Strategy<Value = TriadError> {
        prop::array::uniform12(-1e-2..1e-2_f64).prop_map(|p| TriadError {
            bias: Vector3::from_column_slice(&p[..3]),
            matrix: Matrix3::from_column_slice(&p[3..]),
        })
    }

    proptest! {
        #[test]
        fn splitting_undoes_listing(gyro in any_triad(), accel in any_triad()) {
            let error = ImuError { gyro, accel };
            let other = TermInstance::new(&crate::catalogue::MOUNTING).with_values(&[1e-4, 2e-4]);
            let (same, others) = Model::from(&error).with(other.clone()).split();
            prop_assert_eq!(same, error);
            prop_assert_eq!(others.terms, vec![other]);
        }
    }
}
