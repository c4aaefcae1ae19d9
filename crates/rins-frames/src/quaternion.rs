//! Unit quaternions.

use core::marker::PhantomData;
use core::ops::Mul;

use nalgebra::{ComplexField, Matrix3, RealField, Vector3};

use crate::dcm::Dcm;
use crate::frame::{Frame, InFrame};
use crate::rotation_vector::cross_matrix;

/// The maximum difference of a quaternion's norm from 1 at which it is accepted as a rotation.
const UNIT_WITHIN: f64 = 1e-9;

/// The rotation that resolves a vector of frame `From` in frame `To`, as four numbers.
///
/// `q = (cos φ/2, u sin φ/2)` for a rotation by `φ` about `u`, with Hamilton's multiplication (`i j = k`),
/// so that a product of quaternions is the product of their matrices in the same order. `q` and
/// `−q` are the same rotation but do not compare equal.
///
/// ```
/// use rins_frames::{Body, InFrame, Nav, Quaternion, Table};
/// use std::f64::consts::FRAC_PI_2;
/// let nav_from_table = Quaternion::<Nav, Table>::about_z(FRAC_PI_2);
/// let nav_from_body = nav_from_table * Quaternion::<Table, Body>::identity();
///
/// let forward: InFrame<Nav> = nav_from_body * InFrame::<Body>::new(0.0, 1.0, 0.0);
/// assert!((forward.components().x + 1.0).abs() < 1e-15); // west, after a quarter turn to the left
/// ```
///
/// Frames cannot be mixed:
/// ```compile_fail,E0308
/// use rins_frames::{Body, Nav, Quaternion, Table};
/// let nav_from_table = Quaternion::<Nav, Table>::identity();
/// let nav_from_body: Quaternion<Nav, Body> = nav_from_table;
/// ```
/// nor is it a matrix, unless [`Quaternion::dcm`] converts it:
/// ```compile_fail,E0308
/// use rins_frames::{Body, Dcm, Nav, Quaternion};
/// let nav_from_body: Dcm<Nav, Body> = Quaternion::<Nav, Body>::identity();
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion<To, From> {
    scalar: f64,
    vector: Vector3<f64>,
    frames: PhantomData<(To, From)>,
}

/// The reason why four numbers are not a rotation.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("not a rotation: the quaternion's norm is {norm}, not 1")]
pub struct NotAUnitQuaternion {
    /// The norm, which should be 1.
    pub norm: f64,
}

impl<To: Frame, From: Frame> Quaternion<To, From> {
    /// The rotation between two frames whose axes coincide.
    pub fn identity() -> Self {
        Self::from_unit(1.0, Vector3::zeros())
    }

    /// The rotation in which `From` is `To` rotated about their common z axis by `angle` \[rad\], right-handed.
    pub fn about_z(angle: f64) -> Self {
        let (sin, cos) = ComplexField::sin_cos(angle / 2.0);
        Self::from_unit(cos, Vector3::new(0.0, 0.0, sin))
    }

    /// The rotation in which `From` is `To` rotated about `vector` by its length \[rad\].
    ///
    /// The vector's components are the same in both frames.
    pub fn from_rotation_vector(vector: &Vector3<f64>) -> Self {
        let half_angle = vector.norm() / 2.0;
        let (sin, cos) = ComplexField::sin_cos(half_angle);
        // The sine is accurate down to the smallest angle, so that only 0/0 needs a special case.
        let half_sinc = if half_angle > 0.0 { sin / half_angle / 2.0 } else { 0.5 };
        Self::from_unit(cos, vector * half_sinc)
    }

    /// The rotation vector \[rad\] by which `From` is rotated relative to `To`.
    ///
    /// Its length is at most π.
    pub fn rotation_vector(&self) -> Vector3<f64> {
        let sin = self.vector.norm();
        if sin > 0.0 {
            let half_angle = RealField::atan2(sin, ComplexField::abs(self.scalar));
            self.vector * RealField::copysign(2.0 * half_angle / sin, self.scalar)
        } else {
            Vector3::zeros()
        }
    }

    /// The rotation with the quaternion (`scalar`, `vector`), which resolves a vector of frame `From` in frame `To`.
    ///
    /// # Errors
    /// [`NotAUnitQuaternion`] if the norm is not 1 within 1e-9.
    pub fn from_components(scalar: f64, vector: Vector3<f64>) -> Result<Self, NotAUnitQuaternion> {
        let norm = ComplexField::sqrt(scalar * scalar + vector.norm_squared());
        if ComplexField::abs(norm - 1.0) < UNIT_WITHIN {
            Ok(Self::from_unit(scalar, vector))
        } else {
            Err(NotAUnitQuaternion { norm })
        }
    }

    /// The scalar part, `cos φ/2`.
    pub const fn scalar(&self) -> f64 {
        self.scalar
    }

    /// The vector part, `u sin φ/2`.
    pub const fn vector(&self) -> &Vector3<f64> {
        &self.vector
    }

    /// The inverse rotation, which is the conjugate.
    #[must_use]
    pub fn inverse(self) -> Quaternion<From, To> {
        Quaternion::from_unit(self.scalar, -self.vector)
    }

    /// The same rotation with its norm restored to 1, from which rounding has moved it.
    #[must_use]
    pub fn renormalised(self) -> Self {
        let norm = ComplexField::sqrt(self.scalar * self.scalar + self.vector.norm_squared());
        Self::from_unit(self.scalar / norm, self.vector / norm)
    }

    /// The same rotation as a matrix.
    pub fn dcm(&self) -> Dcm<To, From> {
        let cross = cross_matrix(&self.vector);
        let doubled = (cross * self.scalar + cross * cross) * 2.0;
        Dcm::from_orthonormal(Matrix3::identity() + doubled)
    }

    const fn from_unit(scalar: f64, vector: Vector3<f64>) -> Self {
        Self { scalar, vector, frames: PhantomData }
    }
}

impl<To: Frame, From: Frame> Dcm<To, From> {
    /// The same rotation as a quaternion, with a scalar part that is not negative.
    ///
    /// The component of largest magnitude is computed first and divides the others (Shepperd 1978), so
    /// that no rotation loses digits.
    pub fn quaternion(&self) -> Quaternion<To, From> {
        let c = self.matrix();
        let antisymmetric =
            Vector3::new(c[(2, 1)] - c[(1, 2)], c[(0, 2)] - c[(2, 0)], c[(1, 0)] - c[(0, 1)]);
        let trace = c.trace();
        let axis = c.diagonal().imax();
        let unit = if trace >= c[(axis, axis)] {
            let doubled = ComplexField::sqrt(1.0 + trace);
            Quaternion::from_unit(doubled / 2.0, antisymmetric / (2.0 * doubled))
        } else {
            // 2 |q_axis|, and from it the row of the symmetric part: 4 q_i q_axis = c_ia + c_ai.
            let doubled = ComplexField::sqrt(1.0 + 2.0 * c[(axis, axis)] - trace);
            let mut vector = (c.column(axis) + c.row(axis).transpose()) / (2.0 * doubled);
            vector[axis] = doubled / 2.0;
            let scalar = antisymmetric[axis] / (2.0 * doubled);
            let sign = RealField::copysign(1.0, scalar);
            Quaternion::from_unit(scalar * sign, vector * sign)
        };
        // A matrix that is not exactly orthonormal must not give a quaternion whose norm is not 1.
        unit.renormalised()
    }
}

impl<To: Frame, Mid: Frame, From: Frame> Mul<Quaternion<Mid, From>> for Quaternion<To, Mid> {
    type Output = Quaternion<To, From>;

    #[inline]
    fn mul(self, other: Quaternion<Mid, From>) -> Quaternion<To, From> {
        Quaternion::from_unit(
            self.scalar * other.scalar - self.vector.dot(&other.vector),
            other.vector * self.scalar
                + self.vector * other.scalar
                + self.vector.cross(&other.vector),
        )
    }
}

impl<To: Frame, From: Frame> Mul<InFrame<From>> for Quaternion<To, From> {
    type Output = InFrame<To>;

    #[inline]
    fn mul(self, vector: InFrame<From>) -> InFrame<To> {
        let turned = self.vector.cross(&vector.components) * 2.0;
        InFrame::from_components(
            vector.components + turned * self.scalar + self.vector.cross(&turned),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, Nav, Table};
    use core::f64::consts::PI;
    use proptest::prelude::*;
    use rins_testing::{any_direction, any_rotation_vector, small_rotation_vector};

    /// The rounding error of nine elements of order one: among a million random rotations the
    /// largest defect was 17 units in the last place.
    const ROUNDING: f64 = 24.0 * f64::EPSILON;

    fn both<To: Frame, From: Frame>(vector: [f64; 3]) -> (Quaternion<To, From>, Dcm<To, From>) {
        let vector = Vector3::from(vector);
        (Quaternion::from_rotation_vector(&vector), Dcm::from_rotation_vector(&vector))
    }

    fn distance<To: Frame, From: Frame>(q: Quaternion<To, From>, p: Quaternion<To, From>) -> f64 {
        (q.scalar - p.scalar).abs() + (q.vector - p.vector).norm()
    }

    #[test]
    fn units_multiply_as_hamilton_carved_them() {
        let unit = |axis| Quaternion::<Nav, Nav>::from_components(0.0, axis).unwrap();
        let (i, j, k) = (unit(Vector3::x()), unit(Vector3::y()), unit(Vector3::z()));
        let minus_one = Quaternion::from_components(-1.0, Vector3::zeros()).unwrap();
        assert_eq!(i * j, k);
        assert_eq!(j * k, i);
        assert_eq!(k * i, j);
        assert_eq!(i * j * k, minus_one);
    }

    #[test]
    fn a_quaternion_of_another_norm_is_refused() {
        let err = Quaternion::<Nav, Body>::from_components(0.6, Vector3::x()).unwrap_err();
        assert!((err.norm - 1.36_f64.sqrt()).abs() < ROUNDING);
        assert!(Quaternion::<Nav, Body>::from_components(f64::NAN, Vector3::x()).is_err());
    }

    proptest! {
        #[test]
        fn exponentials_agree_with_the_matrix(v in any_rotation_vector()) {
            let (q, c) = both::<Nav, Body>(v);
            prop_assert!((q.dcm().matrix() - c.matrix()).norm() < ROUNDING);
        }

        #[test]
        fn products_and_actions_agree_with_the_matrix(
            v in any_rotation_vector(),
            w in any_rotation_vector(),
            x in any_rotation_vector(),
        ) {
            let (q, c) = both::<Nav, Table>(v);
            let (p, d) = both::<Table, Body>(w);
            let x = InFrame::<Body>::from_components(Vector3::from(x));
            prop_assert!(((q * p).dcm().matrix() - (c * d).matrix()).norm() < 2.0 * ROUNDING);
            prop_assert!((q * (p * x) - c * (d * x)).norm() < 2.0 * ROUNDING * (1.0 + x.norm()));
            prop_assert!(((q * p) * x - q * (p * x)).norm() < 2.0 * ROUNDING * (1.0 + x.norm()));
        }

        #[test]
        fn matrix_and_back_is_the_same_quaternion(v in any_rotation_vector()) {
            let (q, c) = both::<Nav, Body>(v);
            prop_assert!(q.scalar >= 0.0);
            prop_assert!(distance(c.quaternion(), q) < ROUNDING);
        }

        #[test]
        fn matrix_and_back_keeps_half_turns(direction in any_direction(), short in 0.0..1e-7_f64) {
            let q = Quaternion::<Nav, Body>::from_rotation_vector(
                &(Vector3::from(direction) * (PI - short)),
            );
            let back = q.dcm().quaternion();
            // At half a turn u and −u are the same rotation.
            let sign = back.vector.dot(&q.vector).signum();
            let back = Quaternion::from_unit(back.scalar * sign, back.vector * sign);
            prop_assert!(distance(back, q) < ROUNDING);
        }

        #[test]
        fn product_is_associative(
            u in any_rotation_vector(),
            v in any_rotation_vector(),
            w in any_rotation_vector(),
        ) {
            let (a, b, c) =
                (both::<Nav, Table>(u).0, both::<Table, Body>(v).0, both::<Body, Nav>(w).0);
            prop_assert!(distance((a * b) * c, a * (b * c)) < ROUNDING);
        }

        #[test]
        fn inverse_undoes(v in any_rotation_vector()) {
            let q = both::<Nav, Body>(v).0;
            prop_assert!(distance(q * q.inverse(), Quaternion::identity()) < ROUNDING);
            prop_assert!(distance(q.inverse() * q, Quaternion::identity()) < ROUNDING);
        }

        #[test]
        fn logarithm_undoes_the_exponential_and_ignores_the_sign(v in any_rotation_vector()) {
            let q = both::<Nav, Body>(v).0;
            let negative = Quaternion::<Nav, Body>::from_unit(-q.scalar, -q.vector);
            prop_assert!((q.rotation_vector() - Vector3::from(v)).norm() < ROUNDING);
            prop_assert!((negative.rotation_vector() - Vector3::from(v)).norm() < ROUNDING);
        }

        #[test]
        fn small_vectors_keep_their_relative_precision(v in small_rotation_vector()) {
            let v = Vector3::from(v);
            let back = Quaternion::<Nav, Body>::from_rotation_vector(&v).rotation_vector();
            prop_assert!((back - v).norm() < ROUNDING * v.norm());
        }

        #[test]
        fn renormalised_has_norm_one_and_the_same_axis(
            v in any_rotation_vector(),
            drift in -1e-3..1e-3_f64,
        ) {
            let q = both::<Nav, Body>(v).0;
            let drifted = Quaternion::<Nav, Body>::from_unit(
                q.scalar * (1.0 + drift),
                q.vector * (1.0 + drift),
            );
            prop_assert!(distance(drifted.renormalised(), q) < ROUNDING);
        }

        #[test]
        fn about_z_is_a_turn_about_z(angle in -10.0..10.0_f64) {
            let q = Quaternion::<Nav, Body>::about_z(angle);
            let c = Dcm::<Nav, Body>::about_z(angle);
            prop_assert!((q.dcm().matrix() - c.matrix()).norm() < ROUNDING);
        }
    }
}
