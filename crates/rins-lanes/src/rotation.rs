//! Rotation matrices and rotation vectors, by series for small angles and by closed forms for large ones.

use crate::matrix::Matrix;
use crate::real::Real;
use crate::vector::Vector;

/// The angle \[rad\] below which coefficients come from their Taylor series: the first omitted terms are
/// `φ⁸/9!` and `2 φ⁸/10!`, a tenth of a rounding error.
const SMALL_ANGLE: f64 = 0.04;

/// The sine below which the logarithm comes from the series of the arc sine, to the tenth power: the
/// first omitted term is 2e-18.
const SMALL_SINE: f64 = 0.03;

/// The matrix `exp[v×]` of a rotation by `|v|` about `v` (Rodrigues' formula).
#[inline(always)]
pub fn exp<T: Real>(v: &Vector<T>) -> Matrix<T> {
    let square = v.dot(v);
    let (sinc, cosc) = coefficients(square);
    let [x, y, z] = v.0;
    // 1 + cosc (v vᵀ - v² I) + sinc [v×]
    let one = |other: T| -(other * cosc) + 1.0;
    let (xy, xz, yz) = (x * y * cosc, x * z * cosc, y * z * cosc);
    let (sx, sy, sz) = (x * sinc, y * sinc, z * sinc);
    Matrix([
        [one(y * y + z * z), xy - sz, xz + sy],
        [xy + sz, one(x * x + z * z), yz - sx],
        [xz - sy, yz + sx, one(x * x + y * y)],
    ])
}

/// The coefficients `sin φ / φ` and `(1 - cos φ) / φ²` as functions of `φ²`.
#[inline(always)]
fn coefficients<T: Real>(square: T) -> (T, T) {
    if square.all_below(SMALL_ANGLE * SMALL_ANGLE) {
        (series(square, [6.0, 20.0, 42.0], 1.0), series(square, [24.0, 30.0, 56.0], 0.5))
    } else {
        // Each run is computed separately, so that it has the same bits as alone.
        (square.map(|square| one_run(square).0), square.map(|square| one_run(square).1))
    }
}

/// `first - x/a (1 - x/b (1 - x/c))`.
#[inline(always)]
fn series<T: Real>(x: T, [a, b, c]: [f64; 3], first: f64) -> T {
    let inner = -(x * (1.0 / c)) + 1.0;
    let middle = -(x * (1.0 / b) * inner) + 1.0;
    -(x * (1.0 / a) * middle) + first
}

fn one_run(square: f64) -> (f64, f64) {
    if square < SMALL_ANGLE * SMALL_ANGLE {
        return coefficients(square);
    }
    let angle = square.sqrt();
    let (sin_half, cos_half) = libm::sincos(angle / 2.0);
    // Half angles, because 1 - cos φ would cancel for small φ.
    let half_sinc = sin_half / angle;
    (2.0 * half_sinc * cos_half, 2.0 * half_sinc * half_sinc)
}

/// The weights `(1 - cos θ)/θ²` and `(1 - sin θ/θ)/θ²`, as functions of `θ²`, of `θ×` and `θ×θ×` in the mean
/// orientation of a frame during a rotation.
#[inline(always)]
pub fn mean_weights<T: Real>(square: T) -> (T, T) {
    /// The limit below which the omitted terms are smaller than 1e-17.
    const SMALL: f64 = 1e-4;
    #[inline(always)]
    fn of_small<T: Real>(square: T) -> (T, T) {
        let first = -(square * (1.0 / 24.0) * (-(square * (1.0 / 30.0)) + 1.0)) + 0.5;
        let second = -(square * (1.0 / 120.0) * (-(square * (1.0 / 42.0)) + 1.0)) + 1.0 / 6.0;
        (first, second)
    }
    fn of_one(square: f64) -> (f64, f64) {
        if square < SMALL {
            return of_small(square);
        }
        let angle = square.sqrt();
        let (sin, cos) = libm::sincos(angle);
        ((1.0 - cos) / square, (1.0 - sin / angle) / square)
    }
    if square.all_below(SMALL) {
        of_small(square)
    } else {
        (square.map(|square| of_one(square).0), square.map(|square| of_one(square).1))
    }
}

/// The rotation vector of a matrix near the identity; `None` if the angle exceeds 0.03 rad in
/// any run.
#[inline(always)]
pub fn small_rotation_vector<T: Real>(c: &Matrix<T>) -> Option<Vector<T>> {
    /// The coefficients of `asin s / s` in powers of `s²`, the highest first.
    const ARC_SINE: [f64; 5] = [63.0 / 2816.0, 35.0 / 1152.0, 5.0 / 112.0, 3.0 / 40.0, 1.0 / 6.0];
    let sine = Vector([c[2][1] - c[1][2], c[0][2] - c[2][0], c[1][0] - c[0][1]]).scaled(0.5);
    let square = sine.dot(&sine);
    // Beyond a right angle the sine decreases again; there the trace is below 1.
    let trace = c[0][0] + c[1][1] + c[2][2];
    if !(square.all_below(SMALL_SINE * SMALL_SINE) && (-trace).all_below(-1.0)) {
        return None;
    }
    let mut sum = square.constant(ARC_SINE[0]);
    for coefficient in &ARC_SINE[1..] {
        sum = sum * square + *coefficient;
    }
    Some(sine * (sum * square + 1.0))
}

/// The nearest rotation, to first order in the rounding errors of this one: one step of Newton's
/// iteration for the polar decomposition.
#[inline(always)]
#[must_use]
pub fn orthonormalised<T: Real>(c: &Matrix<T>) -> Matrix<T> {
    let row = |index: usize| Vector(c[index]);
    let excess = |i: usize, j: usize| row(i).dot(&row(j)) * 0.5;
    let (xy, xz, yz) = (excess(0, 1), excess(0, 2), excess(1, 2));
    let keep = |index: usize| -excess(index, index) + 1.5;
    let (x, y, z) = (row(0), row(1), row(2));
    Matrix([
        (x * keep(0) - y * xy - z * xz).0,
        (y * keep(1) - x * xy - z * yz).0,
        (z * keep(2) - x * xz - y * yz).0,
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn rotation(v: [f64; 3]) -> nalgebra::Rotation3<f64> {
        nalgebra::Rotation3::from_scaled_axis(v.into())
    }

    fn any_vector(most: f64) -> impl Strategy<Value = [f64; 3]> {
        [-most..most, -most..most, -most..most]
    }

    proptest! {
        #[test]
        fn exponential_is_the_rotation(v in prop_oneof![any_vector(0.02), any_vector(1.5)]) {
            let got = exp(&Vector(v)).lane(0);
            prop_assert!((got - rotation(v).matrix()).norm() < 1e-15 * 6.0);
        }

        #[test]
        fn logarithm_undoes_small_turns_and_refuses_large_ones(v in any_vector(0.017)) {
            let back = small_rotation_vector(&exp(&Vector(v))).map(|vector| vector - Vector(v));
            let off = back.map(|d| d.dot(&d).sqrt());
            prop_assert!(off.is_some_and(|off| off < 1e-15), "{:?}", off);
            let large = rotation([v[0] + 3.1, v[1], v[2]]);
            let large = Matrix::from(large.matrix());
            prop_assert!(small_rotation_vector(&large).is_none());
        }

        #[test]
        fn newtons_step_removes_a_small_defect(
            v in any_vector(1.0), noise in prop::array::uniform9(-1e-7..1e-7_f64),
        ) {
            let spoilt = rotation(v).matrix() + nalgebra::Matrix3::from_column_slice(&noise);
            let mended = orthonormalised(&Matrix::from(&spoilt)).lane(0);
            let defect = (mended * mended.transpose() - nalgebra::Matrix3::identity()).norm();
            prop_assert!(defect < 1e-12, "{:e}", defect);
        }

        /// The mean of `exp[tv×]` over t from 0 to 1, by Simpson's rule with 200 parts.
        #[test]
        fn weights_are_those_of_the_mean_rotation(v in prop_oneof![any_vector(0.004), any_vector(1.0)]) {
            let part = |t: f64| *rotation(v.map(|x| x * t)).matrix();
            let mut mean = nalgebra::Matrix3::zeros();
            for k in 0..200 {
                let at = |offset: f64| part((f64::from(k) + offset) / 200.0);
                mean += (at(0.0) + at(0.5) * 4.0 + at(1.0)) / 1200.0;
            }
            let (first, second) = mean_weights(Vector(v).dot(&Vector(v)));
            let cross = nalgebra::Vector3::from(v).cross_matrix();
            let got = nalgebra::Matrix3::identity() + cross * first + cross * cross * second;
            prop_assert!((got - mean).norm() < 1e-11);
        }
    }
}
