//! Matrices of three by three numbers.

use core::ops::{Add, Index, IndexMut, Mul, Sub};

use crate::real::Real;
use crate::vector::Vector;

/// Nine numbers, or nine lanes, row by row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix<T>(pub [[T; 3]; 3]);

impl<T: Real> Matrix<T> {
    /// The matrix with the elements `element(row, column)`.
    #[inline(always)]
    pub fn from_fn(mut element: impl FnMut(usize, usize) -> T) -> Self {
        Self([
            [element(0, 0), element(0, 1), element(0, 2)],
            [element(1, 0), element(1, 1), element(1, 2)],
            [element(2, 0), element(2, 1), element(2, 2)],
        ])
    }

    /// A matrix that is the same for all runs of `like`.
    #[inline(always)]
    pub fn constant(like: T, value: &nalgebra::Matrix3<f64>) -> Self {
        Self::from_fn(|row, column| like.constant(value[(row, column)]))
    }

    /// The matrix `[v×]`, whose product with `w` is `v × w`.
    #[inline(always)]
    pub fn cross(v: &Vector<T>) -> Self {
        let [x, y, z] = v.0;
        let zero = x.constant(0.0);
        Self([[zero, -z, y], [z, zero, -x], [-y, x, zero]])
    }

    /// The transpose.
    #[inline(always)]
    #[must_use]
    pub fn transpose(&self) -> Self {
        Self::from_fn(|row, column| self[column][row])
    }

    /// The matrix multiplied by a number.
    #[inline(always)]
    #[must_use]
    pub fn times(&self, factor: T) -> Self {
        Self::from_fn(|row, column| self[row][column] * factor)
    }

    /// The matrix multiplied by a constant.
    #[inline(always)]
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self::from_fn(|row, column| self[row][column] * factor)
    }

    /// The matrix of one run.
    #[inline(always)]
    pub fn lane(&self, index: usize) -> nalgebra::Matrix3<f64> {
        nalgebra::Matrix3::from_fn(|row, column| self[row][column].lane(index))
    }
}

impl From<&nalgebra::Matrix3<f64>> for Matrix<f64> {
    #[inline(always)]
    fn from(matrix: &nalgebra::Matrix3<f64>) -> Self {
        Self::from_fn(|row, column| matrix[(row, column)])
    }
}

impl<T> Index<usize> for Matrix<T> {
    type Output = [T; 3];

    #[inline(always)]
    fn index(&self, row: usize) -> &[T; 3] {
        &self.0[row]
    }
}

impl<T> IndexMut<usize> for Matrix<T> {
    #[inline(always)]
    fn index_mut(&mut self, row: usize) -> &mut [T; 3] {
        &mut self.0[row]
    }
}

impl<T: Real> Add for Matrix<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::from_fn(|row, column| self[row][column] + other[row][column])
    }
}

impl<T: Real> Sub for Matrix<T> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::from_fn(|row, column| self[row][column] - other[row][column])
    }
}

impl<T: Real> Mul<Vector<T>> for Matrix<T> {
    type Output = Vector<T>;

    #[inline(always)]
    fn mul(self, vector: Vector<T>) -> Vector<T> {
        Vector([
            Vector(self[0]).dot(&vector),
            Vector(self[1]).dot(&vector),
            Vector(self[2]).dot(&vector),
        ])
    }
}

impl<T: Real> Mul for Matrix<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::from_fn(|row, column| {
            self[row][0] * other[0][column]
                + self[row][1] * other[1][column]
                + self[row][2] * other[2][column]
        })
    }
}
