//! Rotation vectors: axis times angle of a rotation, and their exponential, the rotation matrix.

use nalgebra::{ComplexField, Matrix3, Vector3};

/// The angle \[rad\] below which the coefficients of the exponential come from their Taylor series.
///
/// The first omitted terms are `φ⁸/9!` of `sin φ/φ` and `2 φ⁸/10!` of `2 (1 − cos φ)/φ²`; at this angle
/// they are 2e-17 and 4e-18, a tenth of a rounding error.
const SMALL_ANGLE: f64 = 0.04;

/// The matrix `[v×]`, so that `cross_matrix(&v) * w` is `v × w`.
pub fn cross_matrix(v: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0)
}

/// The matrix `exp[v×]` of a rotation by `|v|` about `v` (Rodrigues' formula).
pub(crate) fn exp(v: &Vector3<f64>) -> Matrix3<f64> {
    let (sinc, cosc) = coefficients(v.norm_squared());
    let cross = cross_matrix(v);
    Matrix3::identity() + cross * sinc + cross * cross * cosc
}

/// The coefficients `sin φ / φ` and `(1 − cos φ) / φ²` as functions of `φ²`.
fn coefficients(square: f64) -> (f64, f64) {
    if square < SMALL_ANGLE * SMALL_ANGLE { series(square) } else { closed_form(square) }
}

fn series(square: f64) -> (f64, f64) {
    (
        1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)),
        0.5 - square / 24.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0)),
    )
}

fn closed_form(square: f64) -> (f64, f64) {
    let angle = ComplexField::sqrt(square);
    let (sin_half, cos_half) = ComplexField::sin_cos(angle / 2.0);
    // Half angles, because 1 − cos φ would cancel for small φ.
    let half_sinc = sin_half / angle;
    (2.0 * half_sinc * cos_half, 2.0 * half_sinc * half_sinc)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, Dcm, Nav};
    use core::f64::consts::PI;
    use proptest::prelude::*;
    use rins_testing::{any_direction, any_rotation_vector, assert_close, small_rotation_vector};

    /// Six products and sums of numbers of order one.
    const ROUNDING: f64 = 6.0 * f64::EPSILON;

    fn there_and_back(vector: &Vector3<f64>) -> Vector3<f64> {
        Dcm::<Nav, Body>::from_rotation_vector(vector).rotation_vector()
    }

    /// `exp` by the power series of the matrix, with scaling and squaring.
    fn exp_by_squaring(vector: &Vector3<f64>) -> Matrix3<f64> {
        const HALVINGS: i32 = 8;
        let generator = cross_matrix(vector) / f64::from(1 << HALVINGS);
        let mut term = Matrix3::identity();
        let mut sum = Matrix3::identity();
        for order in 1..12 {
            term = term * generator / f64::from(order);
            sum += term;
        }
        for _ in 0..HALVINGS {
            sum *= sum;
        }
        sum
    }

    #[test]
    fn series_and_closed_form_meet_at_the_seam() {
        let square = SMALL_ANGLE * SMALL_ANGLE;
        let (sinc, cosc) = series(square);
        let (sinc_closed, cosc_closed) = closed_form(square);
        assert_close!(sinc / sinc_closed, 1.0, 4.0 * f64::EPSILON);
        assert_close!(cosc / cosc_closed, 1.0, 4.0 * f64::EPSILON);
    }

    #[test]
    fn omitted_terms_at_the_seam_are_below_rounding() {
        let eighth_power = SMALL_ANGLE.powi(8);
        let factorial_of_9: f64 = (1..=9).map(f64::from).product();
        assert!(eighth_power / factorial_of_9 < 1e-16);
        assert!(2.0 * eighth_power / (10.0 * factorial_of_9) < 1e-16);
    }

    #[test]
    fn a_quarter_turn_about_z_takes_x_to_y() {
        let c = exp(&Vector3::new(0.0, 0.0, PI / 2.0));
        assert!((c * Vector3::x() - Vector3::y()).norm() < ROUNDING);
    }

    #[test]
    fn half_a_turn_has_a_rotation_vector_of_length_pi() {
        for axis in [Vector3::x(), Vector3::y(), Vector3::z(), Vector3::new(0.6, 0.0, -0.8)] {
            let vector = there_and_back(&(axis * PI));
            assert_close!(vector.norm(), PI, ROUNDING);
            assert_close!(vector.dot(&axis).abs(), PI, ROUNDING);
        }
    }

    #[test]
    fn the_identity_has_no_rotation_vector() {
        assert_eq!(there_and_back(&Vector3::zeros()), Vector3::zeros());
    }

    proptest! {
        #[test]
        fn exponential_agrees_with_the_matrix_power_series(vector in any_rotation_vector()) {
            let vector = Vector3::from(vector);
            // Eight squarings double the rounding of the reference eight times.
            let within = 256.0 * ROUNDING;
            prop_assert!((exp(&vector) - exp_by_squaring(&vector)).norm() < within);
        }

        #[test]
        fn logarithm_undoes_the_exponential(vector in any_rotation_vector()) {
            let vector = Vector3::from(vector);
            prop_assert!((there_and_back(&vector) - vector).norm() < 4.0 * ROUNDING);
        }

        #[test]
        fn small_vectors_keep_their_relative_precision(vector in small_rotation_vector()) {
            let vector = Vector3::from(vector);
            prop_assert!((there_and_back(&vector) - vector).norm() < ROUNDING * vector.norm());
        }

        #[test]
        fn logarithm_is_precise_up_to_half_a_turn(
            direction in any_direction(),
            exponent in -15.0..-1.0_f64,
        ) {
            let vector = Vector3::from(direction) * (PI - 10_f64.powf(exponent));
            let back = there_and_back(&vector);
            prop_assert!((back - vector).norm() < 4.0 * ROUNDING, "{}", (back - vector).norm());
        }

        #[test]
        fn what_turns_about_a_vector_leaves_it_alone(vector in any_rotation_vector()) {
            let vector = Vector3::from(vector);
            prop_assert!((exp(&vector) * vector - vector).norm() < 2.0 * ROUNDING * (1.0 + vector.norm()));
        }

        #[test]
        fn cross_matrix_is_the_vector_product(
            v in any_rotation_vector(),
            w in any_rotation_vector(),
        ) {
            let (v, w) = (Vector3::from(v), Vector3::from(w));
            prop_assert_eq!(cross_matrix(&v) * w, v.cross(&w));
        }
    }
}
