//! A covariance in the form of its factors `U D Uᵀ`, which represent what the covariance loses by rounding.

use nalgebra::{ComplexField, SMatrix, SVector};

use crate::error::{CovarianceError, Quantity};
use crate::kernel::is_finite;

/// The smallest fraction of a state's variance given others: below it a covariance in matrix form has lost the digits that
/// determine a sigma to 1e-6.
const HELD: f64 = 1e-10;

/// A covariance `P = U D Uᵀ`, with a unit upper triangular `U` and no negative number in the diagonal `D`.
///
/// An element of `D` is the variance of a state given those after it. Two states of variance 1 whose difference has the
/// variance 1e-20 have the covariance 1, to the last bit of an `f64`; their factors still represent the 1e-20.
///
/// ```
/// use nalgebra::{Matrix2, Vector2};
/// use rins_ekf::Factors;
/// // One common source of both states, and a small one of the first alone.
/// let factors = Factors::of_sources(&Matrix2::new(1.0, 1.0, 0.0, 1.0), &Vector2::new(1e-20, 1.0));
/// assert_eq!(factors.covariance(), Matrix2::from_element(1.0));
/// assert_eq!(factors.variance_of(&nalgebra::RowVector2::new(1.0, -1.0)), 1e-20);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factors<const N: usize> {
    /// `U`; the elements below the diagonal are zero.
    pub(crate) upper: SMatrix<f64, N, N>,
    /// `D`.
    pub(crate) variances: SVector<f64, N>,
}

impl<const N: usize> Factors<N> {
    /// The factors of `A W Aᵀ`: states that are the product of `by` and independent sources with these variances.
    pub fn of_sources<const K: usize>(
        by: &SMatrix<f64, N, K>,
        variances: &SVector<f64, K>,
    ) -> Self {
        gram_schmidt(
            (by.transpose(), variances),
            (SMatrix::<f64, 0, N>::zeros(), &SVector::zeros()),
        )
    }

    /// The factors of a covariance.
    ///
    /// A state with zero variance is known exactly; its covariances must then be zero.
    ///
    /// # Errors
    /// [`CovarianceError`] if a number is not finite, or if a linear combination of states has a negative variance, or one so
    /// far below those of the states that the matrix cannot represent it.
    pub fn of(covariance: &SMatrix<f64, N, N>) -> Result<Self, CovarianceError> {
        let factors = Self::of_rounded(covariance, 0.0)?;
        for index in 0..N {
            let part = factors.variances[index] / covariance[(index, index)];
            if part > 0.0 && part < HELD {
                return Err(CovarianceError::Unresolved { index, part });
            }
        }
        Ok(factors)
    }

    /// The factors of a covariance with rounding errors: a state whose variance given those after it is at most the fraction
    /// `rounding` of its variance is treated as determined by them.
    ///
    /// An example is the covariance of a filter that was in plain form so far. Combinations have the precision of that form.
    ///
    /// # Errors
    /// [`CovarianceError`] if a number is not finite, or if the variance of a linear combination is negative beyond rounding.
    pub fn of_rounded(
        covariance: &SMatrix<f64, N, N>,
        rounding: f64,
    ) -> Result<Self, CovarianceError> {
        if !is_finite(covariance) {
            return Err(CovarianceError::NotFinite { quantity: Quantity::Covariance });
        }
        Self::eliminated(*covariance, &covariance.diagonal(), rounding)
            .map_err(|(index, variance)| CovarianceError::NotPositiveDefinite { index, variance })
    }

    /// The factors of the remainder of a covariance, whose upper triangle is used; variances up to `rounding` times those of
    /// `whole` count as zero. Otherwise the error is the first state whose variance is not positive, and that variance.
    pub(crate) fn eliminated(
        mut rest: SMatrix<f64, N, N>,
        whole: &SVector<f64, N>,
        rounding: f64,
    ) -> Result<Self, (usize, f64)> {
        let (mut upper, mut variances) = (SMatrix::identity(), SVector::zeros());
        for j in (0..N).rev() {
            let variance = rest[(j, j)];
            let nothing = rounding * whole[j];
            // A covariance is at most the square root of the product of the variances.
            let known = variance.abs() <= nothing
                && (0..j).all(|i| rest[(i, j)].abs() <= ComplexField::sqrt(whole[i] * nothing));
            if known {
                continue;
            }
            if variance.is_nan() || variance <= nothing {
                return Err((j, variance));
            }
            variances[j] = variance;
            for i in 0..j {
                upper[(i, j)] = rest[(i, j)] / variance;
            }
            for column in 0..j {
                let factor = rest[(column, j)];
                for row in 0..=column {
                    rest[(row, column)] -= upper[(row, j)] * factor;
                }
            }
        }
        Ok(Self { upper, variances })
    }

    /// The variances of the states.
    pub fn diagonal(&self) -> SVector<f64, N> {
        let square = |i: usize, k: usize| self.upper[(i, k)] * self.upper[(i, k)];
        SVector::from_fn(|i, _| (i..N).map(|k| square(i, k) * self.variances[k]).sum())
    }

    /// `U`.
    pub const fn upper(&self) -> &SMatrix<f64, N, N> {
        &self.upper
    }

    /// The diagonal of `D`.
    pub const fn variances(&self) -> &SVector<f64, N> {
        &self.variances
    }

    /// The covariance, exactly symmetric.
    pub fn covariance(&self) -> SMatrix<f64, N, N> {
        let mut covariance = SMatrix::zeros();
        for row in 0..N {
            for column in 0..=row {
                let sum: f64 = (row..N)
                    .map(|k| self.upper[(row, k)] * self.variances[k] * self.upper[(column, k)])
                    .sum();
                covariance[(row, column)] = sum;
                covariance[(column, row)] = sum;
            }
        }
        covariance
    }

    /// The variance of a linear combination of states.
    pub fn variance_of(&self, combination: &SMatrix<f64, 1, N>) -> f64 {
        let by = combination * self.upper;
        (0..N).map(|k| by[k] * by[k] * self.variances[k]).sum()
    }

    /// The factors after a step: those of `Φ P Φᵀ` plus the contribution of noise sources.
    pub(crate) fn carried<const K: usize>(
        &self,
        transition: &SMatrix<f64, N, N>,
        by: &SMatrix<f64, N, K>,
        variances: &SVector<f64, K>,
    ) -> Self {
        let mut carried = SMatrix::<f64, N, N>::zeros();
        crate::kernel::add_product(&mut carried, &self.upper.transpose(), transition);
        gram_schmidt((carried, &self.variances), (by.transpose(), variances))
    }

    pub(crate) fn is_finite(&self) -> bool {
        is_finite(&self.upper) && is_finite(&self.variances)
    }

    /// `U⁻¹ v`.
    pub(crate) fn unmixed(&self, mut v: SVector<f64, N>) -> SVector<f64, N> {
        for j in (0..N).rev() {
            for i in 0..j {
                v[i] -= self.upper[(i, j)] * v[j];
            }
        }
        v
    }
}

/// The dependence of `N` states on `K` sources, a column for each state, and the variances of the sources.
type Sources<'a, const K: usize, const N: usize> = (SMatrix<f64, K, N>, &'a SVector<f64, K>);

/// The factors from two sets of sources: modified weighted Gram-Schmidt orthogonalization, from the last state to the first
/// (‹thornton1976›; ‹bierman1977›, ch. VI).
///
/// It uses only sums of squares and projections: nothing is subtracted from a variance.
fn gram_schmidt<const N: usize, const K: usize, const L: usize>(
    (mut a, weights_a): Sources<'_, K, N>,
    (mut b, weights_b): Sources<'_, L, N>,
) -> Factors<N> {
    let mut factors = Factors { upper: SMatrix::identity(), variances: SVector::zeros() };
    for j in (0..N).rev() {
        let (of_a, of_b) = (a.data.0[j], b.data.0[j]);
        let (heavy_a, heavy_b) =
            (times(&of_a, &weights_a.data.0[0]), times(&of_b, &weights_b.data.0[0]));
        let variance = dot(&heavy_a, &of_a) + dot(&heavy_b, &of_b);
        factors.variances[j] = variance;
        if variance <= 0.0 {
            continue;
        }
        for i in 0..j {
            let share = (dot(&heavy_a, &a.data.0[i]) + dot(&heavy_b, &b.data.0[i])) / variance;
            factors.upper[(i, j)] = share;
            take(&mut a.data.0[i], &of_a, share);
            take(&mut b.data.0[i], &of_b, share);
        }
    }
    factors
}

/// The element-wise product.
#[inline]
fn times<const K: usize>(a: &[f64; K], b: &[f64; K]) -> [f64; K] {
    core::array::from_fn(|k| a[k] * b[k])
}

/// The scalar product, in four parallel sums.
#[inline]
fn dot<const K: usize>(a: &[f64; K], b: &[f64; K]) -> f64 {
    let mut sums = [0.0; 4];
    for (k, (a, b)) in a.iter().zip(b).enumerate() {
        sums[k % 4] += a * b;
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// Subtracts `share` times `part` from `whole`.
#[inline]
fn take<const K: usize>(whole: &mut [f64; K], part: &[f64; K], share: f64) {
    for (whole, part) in whole.iter_mut().zip(part) {
        *whole -= part * share;
    }
}
