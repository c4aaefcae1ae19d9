//! Direction cosine matrices.

use core::marker::PhantomData;
use core::ops::Mul;

use nalgebra::{ComplexField, Matrix3, Vector3};

use crate::frame::{Frame, InFrame};
use crate::rotation_vector;

/// How far `C Cᵀ` may be from the identity for a matrix to be accepted as a rotation.
const ORTHONORMAL_WITHIN: f64 = 1e-9;

/// The rotation that resolves a vector of frame `From` in frame `To`.
///
/// `Dcm<Nav, Body>` is the literature's `C_b^n`, and a value of it is called `nav_from_body`.
/// Neighbouring frames cancel, as the subscripts do on paper:
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
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Dcm<To, From> {
    matrix: Matrix3<f64>,
    frames: PhantomData<(To, From)>,
}

/// Why a matrix is not a rotation.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("not a rotation: C Cᵀ is {defect:e} from the identity and the determinant is {determinant}")]
pub struct NotARotation {
    /// The Frobenius norm of `C Cᵀ - I`.
    pub defect: f64,
    /// The matrix's determinant; a rotation has 1.
    pub determinant: f64,
}

impl<To: Frame, From: Frame> Dcm<To, From> {
    /// The rotation between two frames whose axes coincide.
    pub fn identity() -> Self {
        Self::from_orthonormal(Matrix3::identity())
    }

    /// `From` is `To` turned about their common x axis by `angle` \[rad\], right-handed.
    pub fn about_x(angle: f64) -> Self {
        let (sin, cos) = ComplexField::sin_cos(angle);
        Self::from_orthonormal(Matrix3::new(1.0, 0.0, 0.0, 0.0, cos, -sin, 0.0, sin, cos))
    }

    /// `From` is `To` turned about their common y axis by `angle` \[rad\], right-handed.
    pub fn about_y(angle: f64) -> Self {
        let (sin, cos) = ComplexField::sin_cos(angle);
        Self::from_orthonormal(Matrix3::new(cos, 0.0, sin, 0.0, 1.0, 0.0, -sin, 0.0, cos))
    }

    /// `From` is `To` turned about their common z axis by `angle` \[rad\], right-handed.
    pub fn about_z(angle: f64) -> Self {
        let (sin, cos) = ComplexField::sin_cos(angle);
        Self::from_orthonormal(Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0))
    }

    /// `From` is `To` turned about `vector` by its length \[rad\].
    ///
    /// The vector's components are the same in both frames.
    pub fn from_rotation_vector(vector: &Vector3<f64>) -> Self {
        Self::from_orthonormal(rotation_vector::exp(vector))
    }

    /// The vector about which, and by whose length \[rad\], `From` is turned against `To`.
    ///
    /// Its length is at most π.
    pub fn rotation_vector(&self) -> Vector3<f64> {
        rotation_vector::log(&self.matrix)
    }

    /// Claims that a bare matrix rotates `From` into `To`.
    ///
    /// # Errors
    /// [`NotARotation`] if the matrix is not orthonormal or is left-handed.
    pub fn from_matrix(matrix: Matrix3<f64>) -> Result<Self, NotARotation> {
        let defect = (matrix * matrix.transpose() - Matrix3::identity()).norm();
        let determinant = matrix.determinant();
        if defect < ORTHONORMAL_WITHIN && determinant > 0.0 {
            Ok(Self::from_orthonormal(matrix))
        } else {
            Err(NotARotation { defect, determinant })
        }
    }

    /// The inverse rotation, which is the transpose.
    #[must_use]
    pub fn inverse(self) -> Dcm<From, To> {
        Dcm::from_orthonormal(self.matrix.transpose())
    }

    /// The nearest rotation, to first order in what rounding has done to this one.
    ///
    /// A product of many rotations drifts off orthonormality by a unit in the last place a
    /// factor; one step of Newton's iteration for the polar decomposition brings it back.
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
