//! Vectors of three numbers.

use core::ops::{Add, Index, IndexMut, Mul, Neg, Sub};

use crate::real::Real;

/// Three numbers, or three lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector<T>(pub [T; 3]);

impl<T: Real> Vector<T> {
    /// A vector that is the same for all runs of `like`.
    #[inline(always)]
    pub fn constant(like: T, value: [f64; 3]) -> Self {
        Self([like.constant(value[0]), like.constant(value[1]), like.constant(value[2])])
    }

    /// The zero vector for the runs of `like`.
    #[inline(always)]
    pub fn zeros(like: T) -> Self {
        Self([like.constant(0.0); 3])
    }

    /// The cross product `self × other`.
    #[inline(always)]
    #[must_use]
    pub fn cross(&self, other: &Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    /// The scalar product.
    #[inline(always)]
    pub fn dot(&self, other: &Self) -> T {
        self[0] * other[0] + self[1] * other[1] + self[2] * other[2]
    }

    /// The vector of one run.
    #[inline(always)]
    pub fn lane(&self, index: usize) -> [f64; 3] {
        [self[0].lane(index), self[1].lane(index), self[2].lane(index)]
    }
}

impl From<nalgebra::Vector3<f64>> for Vector<f64> {
    #[inline(always)]
    fn from(vector: nalgebra::Vector3<f64>) -> Self {
        Self(vector.into())
    }
}

impl From<Vector<f64>> for nalgebra::Vector3<f64> {
    #[inline(always)]
    fn from(vector: Vector<f64>) -> Self {
        vector.0.into()
    }
}

impl<T> Index<usize> for Vector<T> {
    type Output = T;

    #[inline(always)]
    fn index(&self, index: usize) -> &T {
        &self.0[index]
    }
}

impl<T> IndexMut<usize> for Vector<T> {
    #[inline(always)]
    fn index_mut(&mut self, index: usize) -> &mut T {
        &mut self.0[index]
    }
}

impl<T: Real> Add for Vector<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self([self[0] + other[0], self[1] + other[1], self[2] + other[2]])
    }
}

impl<T: Real> Sub for Vector<T> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self([self[0] - other[0], self[1] - other[1], self[2] - other[2]])
    }
}

impl<T: Real> Neg for Vector<T> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self([-self[0], -self[1], -self[2]])
    }
}

impl<T: Real> Mul<T> for Vector<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Self([self[0] * factor, self[1] * factor, self[2] * factor])
    }
}

impl<T: Real> Vector<T> {
    /// The vector multiplied by a constant.
    #[inline(always)]
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self([self[0] * factor, self[1] * factor, self[2] * factor])
    }
}
