//! SIMD lanes: as many numbers as the vector registers of the machine hold.

use core::ops::{Add, Div, Mul, Neg, Sub};

use pulp::Simd;
use pulp::bytemuck;

use crate::real::Real;

/// One number of each of several runs, as many as a vector of the instruction set `S` holds.
///
/// It can be created only if the machine is known to have these instructions: from the token that
/// [`dispatch`](crate::Arch::dispatch) provides.
#[derive(Clone, Copy, Debug)]
pub struct Lane<S: Simd> {
    simd: S,
    values: S::f64s,
}

impl<S: Simd> Lane<S> {
    /// The number of runs in a vector.
    pub const WIDTH: usize = S::F64_LANES;

    /// The same constant for all runs.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self { simd, values: simd.splat_f64s(value) }
    }

    /// A vector of numbers, one for each run.
    #[inline(always)]
    pub fn new(simd: S, values: S::f64s) -> Self {
        Self { simd, values }
    }

    /// The vector of numbers.
    #[inline(always)]
    pub fn values(self) -> S::f64s {
        self.values
    }

    /// Replaces every number by a function of it, vector by vector.
    #[inline(always)]
    pub fn map_slice(simd: S, numbers: &mut [f64], f: impl Fn(Self) -> Self) {
        let (vectors, rest) = S::as_mut_simd_f64s(numbers);
        for values in vectors {
            *values = f(Self { simd, values: *values }).values;
        }
        if !rest.is_empty() {
            let values = f(Self { simd, values: simd.partial_load_f64s(rest) }).values;
            simd.partial_store_f64s(rest, values);
        }
    }

    #[inline(always)]
    fn with(self, values: S::f64s) -> Self {
        Self { simd: self.simd, values }
    }
}

impl<S: Simd> Real for Lane<S> {
    #[inline(always)]
    fn lanes(self) -> usize {
        Self::WIDTH
    }

    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        let values: &[f64] = bytemuck::cast_slice(core::slice::from_ref(&self.values));
        values[index]
    }

    #[inline(always)]
    fn each(self, mut value: impl FnMut(usize) -> f64) -> Self {
        let mut made = self.values;
        let values: &mut [f64] = bytemuck::cast_slice_mut(core::slice::from_mut(&mut made));
        for (index, lane) in values.iter_mut().enumerate() {
            *lane = value(index);
        }
        self.with(made)
    }

    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.with(self.simd.sqrt_f64s(self.values))
    }

    #[inline(always)]
    fn all_below(self, bound: f64) -> bool {
        self.simd.reduce_max_f64s(self.values) < bound
    }
}

impl<S: Simd> Add for Lane<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(self.simd.add_f64s(self.values, other.values))
    }
}

impl<S: Simd> Sub for Lane<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(self.simd.sub_f64s(self.values, other.values))
    }
}

impl<S: Simd> Mul for Lane<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with(self.simd.mul_f64s(self.values, other.values))
    }
}

impl<S: Simd> Div for Lane<S> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.with(self.simd.div_f64s(self.values, other.values))
    }
}

impl<S: Simd> Neg for Lane<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.with(self.simd.neg_f64s(self.values))
    }
}

impl<S: Simd> Add<f64> for Lane<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: f64) -> Self {
        self + self.constant(other)
    }
}

impl<S: Simd> Sub<f64> for Lane<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: f64) -> Self {
        self - self.constant(other)
    }
}

impl<S: Simd> Mul<f64> for Lane<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self * self.constant(other)
    }
}
