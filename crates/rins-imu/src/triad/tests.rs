//! Laws of the triad error and its compensation.

use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use rins_frames::{Body, InFrame};

use super::{CompensationError, TriadError};
use crate::axis::Axis;

/// The round trip of a vector has six rounding errors of half a unit in the last place.
const ROUND_TRIP: f64 = 1e-15;

fn any_vector(size: f64) -> impl Strategy<Value = InFrame<Body>> {
    [-size..size, -size..size, -size..size].prop_map(|[x, y, z]| InFrame::new(x, y, z))
}

fn any_error(size: f64) -> impl Strategy<Value = TriadError> {
    let matrix = prop::array::uniform9(-size..size);
    (any_vector(0.1), matrix).prop_map(|(bias, matrix)| TriadError {
        bias: *bias.components(),
        matrix: Matrix3::from_column_slice(&matrix),
    })
}

proptest! {
    #[test]
    fn compensation_undoes_the_error(error in any_error(0.01), rate in any_vector(10.0)) {
        let measured = error.measured_rate(&rate);
        let undone = error.compensation().unwrap().true_rate(&measured);
        let scale = measured.norm() + error.bias.norm();
        prop_assert!((undone - rate).norm() <= ROUND_TRIP * scale);
    }

    #[test]
    fn compensation_undoes_errors_as_large_as_the_signal(
        error in any_error(1.0), rate in any_vector(10.0),
    ) {
        // A condition number up to 10⁸ can cost eight digits of sixteen, and a little more.
        let Ok(compensation) = error.compensation() else { return Ok(()) };
        let undone = compensation.true_rate(&error.measured_rate(&rate));
        prop_assert!((undone - rate).norm() <= 1e-6 * (rate.norm() + error.bias.norm()));
    }

    #[test]
    fn no_error_changes_no_bit(rate in any_vector(10.0)) {
        let perfect = TriadError::default();
        prop_assert_eq!(perfect.measured_rate(&rate), rate);
        prop_assert_eq!(perfect.compensation().unwrap().true_rate(&rate), rate);
    }

    #[test]
    fn increments_of_consecutive_intervals_add(
        error in any_error(0.01), first in any_vector(1.0), second in any_vector(1.0),
    ) {
        let parts = error.measured_increment(&first, 0.25) + error.measured_increment(&second, 0.5);
        let whole = error.measured_increment(&(first + second), 0.75);
        prop_assert!((parts - whole).norm() < 1e-15);
    }

    #[test]
    fn compensation_never_panics_and_never_yields_nan(
        matrix in prop::array::uniform9(prop_oneof![
            prop::num::f64::ANY, -2.0..2.0, Just(0.0), Just(-1.0), Just(1.0),
        ]),
        rate in any_vector(1.0),
    ) {
        let error =
            TriadError { bias: Vector3::zeros(), matrix: Matrix3::from_column_slice(&matrix) };
        if let Ok(compensation) = error.compensation() {
            prop_assert!(compensation.true_rate(&rate).norm().is_finite());
        }
    }
}

#[test]
fn misalignment_xz_puts_spin_rate_into_the_x_gyro() {
    let error = TriadError::default()
        .with_misalignment(Axis::X, Axis::Z, 0.001)
        .with_scale(Axis::Z, 0.002)
        .with_bias(Axis::Y, 0.003);
    let measured = error.measured_rate(&InFrame::new(0.0, 0.0, 2.0));
    assert!((measured - InFrame::new(0.002, 0.003, 2.004)).norm() < 1e-15);
    let read_back = [
        error.misalignment(Axis::X, Axis::Z),
        error.misalignment(Axis::Z, Axis::X),
        error.scale(Axis::Z),
    ];
    assert_eq!(Vector3::from(read_back), Vector3::new(0.001, 0.0, 0.002));
}

#[test]
fn sensors_that_swap_axes_can_be_undone() {
    // Scale errors of -1 alone would be dead axes; here each sensor measures along its neighbor.
    let error = TriadError {
        bias: Vector3::zeros(),
        matrix: Matrix3::new(-1.0, 1.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0),
    };
    let undone = error.compensation().unwrap().true_rate(&InFrame::new(1.0, 2.0, 3.0));
    assert!((undone - InFrame::new(2.0, 1.0, 3.0)).norm() < 1e-15);
}

#[test]
fn coplanar_axes_are_refused_with_their_determinant() {
    let error = TriadError::default().with_misalignment(Axis::X, Axis::Y, 1.0).with_misalignment(
        Axis::Y,
        Axis::X,
        1.0,
    );
    assert_eq!(error.compensation(), Err(CompensationError::Singular { determinant: 0.0 }));
    let nearly = error.with_scale(Axis::X, 1e-9);
    assert!(matches!(nearly.compensation(), Err(CompensationError::Singular { .. })));
}

#[test]
fn nan_is_refused() {
    let error = TriadError::default().with_bias(Axis::X, f64::NAN);
    assert_eq!(error.compensation(), Err(CompensationError::NotFinite));
}
