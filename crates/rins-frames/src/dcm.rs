//! Direction cosine matrices.

use core::marker::PhantomData;
use core::ops::Mul;

use nalgebra::{ComplexField, Matrix3, Vector3};

use crate::frame::{Frame, InFrame};
use crate::rotation_vector;

/// The maximum norm of `C Cᵀ - I` at which a matrix is accepted as a rotation.
const ORTHONORMAL_WITHIN: f64 = 1e-9;

/// The rotation that resolves a vector of frame `From` in frame `To`.
///
/// `Dcm<Nav, Body>` is the literature's `C_b^n`, and a value of it is called `nav_from_body`.
/// Adjacent frames cancel, like the subscripts on paper:
///
/// ```
/// use rins_frames::{Body, Dcm, InFrame, Nav, Table};
/// let nav_from_table = Dcm::<Nav, Table>::identity();
/// let table_from_body = Dcm::<Table, Body>::about_z(0.5);
///
/// let nav_from_body: Dcm<Nav, Body> = nav_from_table * table_from_body;
/// let f_n: InFrame<Nav> = nav_from_body * InFrame::<Body>::new(0.0, 0.0, 9.8);
/// # assert!((f_n.components().z - 9.8).abs() < 1e-15);
/// ```
///
/// The wrong order does not compile:
/// ```compile_fail,E0277
/// use rins_frames::{Body, Dcm, Nav, Table};
/// let nav_from_table = Dcm::<Nav, Table>::identity();
/// let table_from_body = Dcm::<Table, Body>::identity();
/// let nav_from_body: Dcm<Nav, Body> = table_from_body * nav_from_table;
/// ```
/// nor does a forgotten [`Dcm::inverse`]:
/// ```compile_fail,E0308
/// use rins_frames::{Body, Dcm, Nav};
/// let nav_from_body = Dcm::<Nav, Body>::identity();
/// let body_from_nav: Dcm<Body, Nav> = nav_from_body;
/// ```
/// nor does a vector without a frame:
/// ```compile_fail,E0277
/// use rins_frames::{Body, Dcm, Nav};
/// let up = Dcm::<Nav, Body>::identity() * nalgebra::Vector3::z();
/// ```
/// nor does an unchecked matrix, because the field is private:
/// ```compile_fail,E0423
/// use rins_frames::{Body, Dcm, Nav};
/// let nav_from_body = Dcm::<Nav, Body>(nalgebra::Matrix3::identity() * 2.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Dcm<To, From> {
    matrix: Matrix3<f64>,
    frames: PhantomData<(To, From)>,
}

/// The reason why a matrix is not a rotation.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "not a rotation: C Cᵀ is {defect:e} from the identity and the determinant is {determinant}"
)]
pub struct NotARotation {
    /// The Frobenius norm of `C Cᵀ - I`.
    pub defect: f64,
    /// The determinant of the matrix; that of a rotation is 1.
    pub determinant: f64,
}

impl<To: Frame, From: Frame> Dcm<To, From> {
    /// The rotation between two frames whose axes coincide.
    pub fn identity() -> Self {
        Self::from_orthonormal(Matrix3::identity())
    }

    /// The rotation in which `From` is `To` rotated about their common x axis by `angle` \[rad\], right-handed.
    pub fn about_x(angle: f64) -> Self {
        let (sin, cos) = ComplexField::sin_cos(angle);
        Self::from_orthonormal(Matrix3::new(1.0, 0.0, 0.0, 0.0, cos, -sin, 0.0, sin, cos))
    }

    /// The rotation in which `From` is `To` rotated about their common y axis by `angle` \[rad\], right-handed.
    pub fn about_y(angle: f64) -> Self {
        let (sin, cos) = ComplexField::sin_cos(angle);
        Self::from_orthonormal(Matrix3::new(cos, 0.0, sin, 0.0, 1.0, 0.0, -sin, 0.0, cos))
    }

    /// The rotation in which `From` is `To` rotated about their common z axis by `angle` \[rad\], right-handed.
    pub fn about_z(angle: f64) -> Self {
        let (sin, cos) = ComplexField::sin_cos(angle);
        Self::from_orthonormal(Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0))
    }

    /// The rotation in which `From` is `To` rotated about `vector` by its length \[rad\].
    ///
    /// The vector's components are the same in both frames.
    pub fn from_rotation_vector(vector: &Vector3<f64>) -> Self {
        Self::from_orthonormal(rotation_vector::exp(vector))
    }

    /// The rotation vector \[rad\] by which `From` is rotated relative to `To`.
    ///
    /// Its length is at most π.
    pub fn rotation_vector(&self) -> Vector3<f64> {
        self.quaternion().rotation_vector()
    }

    /// The rotation with this matrix, which resolves a vector of frame `From` in frame `To`.
    ///
    /// # Errors
    /// [`NotARotation`] if `C Cᵀ` is not the identity within 1e-9, or the matrix is left-handed.
    ///
    /// A sensor triad's scale and misalignment errors are not a rotation, and the error must be handled:
    /// ```compile_fail,E0308
    /// use rins_frames::{Body, Dcm, Nav};
    /// let triad = nalgebra::Matrix3::identity() * 1.0001;
    /// let nav_from_body: Dcm<Nav, Body> = Dcm::from_matrix(triad);
    /// ```
    pub fn from_matrix(matrix: Matrix3<f64>) -> Result<Self, NotARotation> {
        let defect = (matrix * matrix.transpose() - Matrix3::identity()).norm();
        let determinant = matrix.determinant();
        if defect < ORTHONORMAL_WITHIN && determinant > 0.0 {
            Ok(Self::from_orthonormal(matrix))
        } else {
            Err(NotARotation { defect, determinant })
        }
    }

    /// The rotation with this matrix of a kernel, without a check.
    ///
    /// It is only for products of rotations in a kernel; for any other matrix use
    /// [`Dcm::from_matrix`].
    pub const fn from_kernel(matrix: Matrix3<f64>) -> Self {
        Self::from_orthonormal(matrix)
    }

    /// The inverse rotation, which is the transpose.
    #[must_use]
    pub fn inverse(self) -> Dcm<From, To> {
        Dcm::from_orthonormal(self.matrix.transpose())
    }

    /// The nearest rotation, to first order in the rounding errors of this one.
    ///
    /// A product of many rotations loses orthonormality by one unit in the last place per
    /// factor; one step of Newton's iteration for the polar decomposition restores it.
    #[must_use]
    pub fn orthonormalised(self) -> Self {
        let excess = self.matrix * self.matrix.transpose() - Matrix3::identity();
        Self::from_orthonormal(self.matrix - excess * self.matrix * 0.5)
    }

    /// The bare matrix, for a kernel.
    pub const fn matrix(&self) -> &Matrix3<f64> {
        &self.matrix
    }

    pub(crate) const fn from_orthonormal(matrix: Matrix3<f64>) -> Self {
        Self { matrix, frames: PhantomData }
    }
}

impl<To: Frame, Mid: Frame, From: Frame> Mul<Dcm<Mid, From>> for Dcm<To, Mid> {
    type Output = Dcm<To, From>;

    #[inline]
    fn mul(self, other: Dcm<Mid, From>) -> Dcm<To, From> {
        Dcm::from_orthonormal(self.matrix * other.matrix)
    }
}

impl<To: Frame, From: Frame> Mul<InFrame<From>> for Dcm<To, From> {
    type Output = InFrame<To>;

    #[inline]
    fn mul(self, vector: InFrame<From>) -> InFrame<To> {
        InFrame::from_components(self.matrix * vector.components)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, Nav, Table};
    use core::f64::consts::FRAC_PI_2;
    use proptest::prelude::*;
    use rins_testing::{any_matrix, any_rotation_vector, assert_close};

    /// The rounding error of nine elements of order one: among a million random rotations the
    /// largest defect was 15 units in the last place.
    const ROUNDING: f64 = 24.0 * f64::EPSILON;

    fn any_dcm<To: Frame, From: Frame>() -> impl Strategy<Value = Dcm<To, From>> {
        any_rotation_vector().prop_map(|v| Dcm::from_rotation_vector(&Vector3::from(v)))
    }

    fn any_vector<F: Frame>() -> impl Strategy<Value = InFrame<F>> {
        any_rotation_vector().prop_map(|v| InFrame::from_components(Vector3::from(v)))
    }

    fn defect(matrix: &Matrix3<f64>) -> f64 {
        (matrix * matrix.transpose() - Matrix3::identity()).norm()
    }

    #[test]
    fn quarter_turns_take_each_axis_to_the_next() {
        let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
        let about_x = *Dcm::<Nav, Body>::about_x(FRAC_PI_2).matrix();
        let about_y = *Dcm::<Nav, Body>::about_y(FRAC_PI_2).matrix();
        let about_z = *Dcm::<Nav, Body>::about_z(FRAC_PI_2).matrix();
        assert!((about_x * y - z).norm() < ROUNDING);
        assert!((about_y * z - x).norm() < ROUNDING);
        assert!((about_z * x - y).norm() < ROUNDING);
    }

    #[test]
    fn what_is_no_rotation_is_refused() {
        let stretched = Dcm::<Nav, Body>::from_matrix(Matrix3::identity() * 1.001).unwrap_err();
        assert_close!(stretched.determinant, 1.003003001, 1e-12);
        let mirrored = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0));
        let mirrored = Dcm::<Nav, Body>::from_matrix(mirrored).unwrap_err();
        assert_close!(mirrored.determinant, -1.0, 1e-15);
        assert_close!(mirrored.defect + 1.0, 1.0, 1e-15);
        let mut broken = Matrix3::identity();
        broken[(1, 2)] = f64::NAN;
        assert!(Dcm::<Nav, Body>::from_matrix(broken).is_err());
    }

    proptest! {
        #[test]
        fn rotations_are_orthonormal_and_right_handed(c in any_dcm::<Nav, Body>()) {
            prop_assert!(defect(&c.matrix) < ROUNDING);
            prop_assert!((c.matrix.determinant() - 1.0).abs() < ROUNDING);
            prop_assert_eq!(Dcm::from_matrix(c.matrix), Ok(c));
        }

        #[test]
        fn inverse_undoes(c in any_dcm::<Nav, Body>()) {
            let in_nav: Dcm<Nav, Nav> = c * c.inverse();
            let in_body: Dcm<Body, Body> = c.inverse() * c;
            prop_assert!((in_nav.matrix - Matrix3::identity()).norm() < ROUNDING);
            prop_assert!((in_body.matrix - Matrix3::identity()).norm() < ROUNDING);
            prop_assert_eq!(c.inverse().inverse(), c);
        }

        #[test]
        fn product_is_associative_and_acts(
            a in any_dcm::<Nav, Table>(),
            b in any_dcm::<Table, Body>(),
            c in any_dcm::<Body, Nav>(),
            x in any_vector::<Nav>(),
        ) {
            prop_assert!((((a * b) * c).matrix - (a * (b * c)).matrix).norm() < 2.0 * ROUNDING);
            let within = 2.0 * ROUNDING * (1.0 + x.norm());
            prop_assert!(((b * c) * x - b * (c * x)).norm() < within);
        }

        #[test]
        fn identity_changes_nothing(c in any_dcm::<Nav, Body>(), x in any_vector::<Body>()) {
            prop_assert_eq!(Dcm::<Nav, Nav>::identity() * c, c);
            prop_assert_eq!(c * Dcm::<Body, Body>::identity(), c);
            prop_assert_eq!(Dcm::<Body, Body>::identity() * x, x);
        }

        #[test]
        fn rotations_keep_lengths_angles_and_handedness(
            c in any_dcm::<Nav, Body>(),
            x in any_vector::<Body>(),
            y in any_vector::<Body>(),
        ) {
            let within = 4.0 * ROUNDING * (1.0 + x.norm() * y.norm());
            prop_assert!(((c * x).dot(&(c * y)) - x.dot(&y)).abs() < within);
            prop_assert!(((c * x).cross(&(c * y)) - c * x.cross(&y)).norm() < within);
        }

        #[test]
        fn angles_about_one_axis_add(a in -3.0..3.0_f64, b in -3.0..3.0_f64) {
            for about in [Dcm::<Nav, Nav>::about_x, Dcm::about_y, Dcm::about_z] {
                prop_assert!(((about(a) * about(b)).matrix - about(a + b).matrix).norm() < ROUNDING);
            }
        }

        #[test]
        fn axis_turns_are_exponentials(angle in -3.0..3.0_f64) {
            let turns = [Dcm::<Nav, Body>::about_x, Dcm::about_y, Dcm::about_z];
            for (about, axis) in turns.into_iter().zip([Vector3::x(), Vector3::y(), Vector3::z()]) {
                let exponential = Dcm::<Nav, Body>::from_rotation_vector(&(axis * angle));
                prop_assert!((about(angle).matrix - exponential.matrix).norm() < ROUNDING);
            }
        }

        #[test]
        fn orthonormalised_squares_the_defect(c in any_dcm::<Nav, Body>(), noise in any_matrix()) {
            let drifted = Dcm::<Nav, Body>::from_orthonormal(c.matrix + Matrix3::from(noise) * 1e-5);
            let before = defect(&drifted.matrix);
            let after = defect(&drifted.orthonormalised().matrix);
            prop_assert!(after < before * before + ROUNDING, "{before:e} became {after:e}");
        }

        #[test]
        fn orthonormalised_takes_off_a_stretch_and_keeps_the_turn(
            c in any_dcm::<Nav, Body>(),
            noise in any_matrix(),
        ) {
            const STRETCH: f64 = 1e-6;
            let noise = Matrix3::from(noise);
            let symmetric = (noise + noise.transpose()) * STRETCH;
            let drifted = Dcm::<Nav, Body>::from_orthonormal(c.matrix + symmetric * c.matrix);
            let repaired = drifted.orthonormalised();
            // The remainder is of second order in the stretch, whose norm is at most 6e-6.
            prop_assert!((repaired.matrix - c.matrix).norm() < 1e-10);
        }
    }
}
