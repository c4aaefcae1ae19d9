//! The numbers of a kernel: one number, or one lane for each of several runs.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number of one run (`f64`), or of several runs in lanes ([`crate::Lane`]).
///
/// Every operation rounds each lane as IEEE 754 rounds an `f64`, and none is fused: a lane has the
/// same bits as its run alone.
pub trait Real:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// The number of runs.
    fn lanes(self) -> usize;

    /// The number of one run.
    ///
    /// # Panics
    /// If there is no such lane.
    fn lane(self, index: usize) -> f64;

    /// A number for each of the runs of `self`.
    #[must_use]
    fn each(self, value: impl FnMut(usize) -> f64) -> Self;

    /// The same constant for all runs of `self`.
    #[must_use]
    fn constant(self, value: f64) -> Self;

    /// The square root, correctly rounded.
    #[must_use]
    fn sqrt(self) -> Self;

    /// Whether the numbers of all runs are below a bound; NaN may be ignored.
    fn all_below(self, bound: f64) -> bool;

    /// A function of one number, applied to that of each run.
    #[must_use]
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        self.each(|index| f(self.lane(index)))
    }

    /// The absolute value.
    #[must_use]
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }
}

impl Real for f64 {
    #[inline(always)]
    fn lanes(self) -> usize {
        1
    }

    #[inline(always)]
    fn lane(self, index: usize) -> Self {
        assert!(index == 0, "one run has one lane");
        self
    }

    #[inline(always)]
    fn each(self, mut value: impl FnMut(usize) -> Self) -> Self {
        value(0)
    }

    #[inline(always)]
    fn constant(self, value: Self) -> Self {
        value
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }

    #[inline(always)]
    fn all_below(self, bound: Self) -> bool {
        self < bound
    }
}
