//! Rotation vectors: a rotation's axis times its angle, and the exponential that turns it into a matrix.

use nalgebra::{ComplexField, Matrix3, Vector3};

/// Below this angle \[rad\] the coefficients are taken from their Taylor series, whose first
/// omitted terms are then under one part in 10^17.
const SMALL_ANGLE: f64 = 1e-2;

/// The matrix `[v×]`, so that `cross_matrix(&v) * w` is `v × w`.
pub fn cross_matrix(v: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0)
}

/// `exp[v×]` (Rodrigues' formula): the matrix of a turn by `|v|` about `v`.
pub(crate) fn exp(v: &Vector3<f64>) -> Matrix3<f64> {
    let square = v.norm_squared();
    let (sinc, cosc) = if square < SMALL_ANGLE * SMALL_ANGLE {
        (
            1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)),
            0.5 - square / 24.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0)),
        )
    } else {
        let angle = ComplexField::sqrt(square);
        let (sin, cos) = ComplexField::sin_cos(angle);
        (sin / angle, (1.0 - cos) / square)
    };
    let cross = cross_matrix(v);
    Matrix3::identity() + cross * sinc + cross * cross * cosc
}

/// The rotation vector of an orthonormal matrix, of length at most π.
pub(crate) fn log(c: &Matrix3<f64>) -> Vector3<f64> {
    let rotation = nalgebra::Rotation3::from_matrix_unchecked(*c);
    nalgebra::UnitQuaternion::from_rotation_matrix(&rotation).scaled_axis()
}
