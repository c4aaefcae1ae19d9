//! The matrix kernels: a product, its exactly symmetric form, and a Cholesky factor.
//!
//! Columns are contiguous, so every inner loop runs along a column, with a length known at compile time.

use nalgebra::{ComplexField, SMatrix, SVector};

/// `A P Aᵀ`, exactly symmetric, for a symmetric `P`.
///
/// An application is noise that enters through a matrix: `Q = G W Gᵀ`.
///
/// ```
/// use nalgebra::{Matrix1, Matrix2, Vector2};
/// let noise = rins_ekf::congruence(&Vector2::new(0.5, 1.0), &Matrix1::new(4.0));
/// assert_eq!(noise, Matrix2::new(1.0, 2.0, 2.0, 4.0));
/// ```
pub fn congruence<const N: usize, const K: usize>(
    a: &SMatrix<f64, N, K>,
    p: &SMatrix<f64, K, K>,
) -> SMatrix<f64, N, N> {
    let mut product = SMatrix::zeros();
    add_congruence(&mut product, a, p);
    mirrored(product)
}

/// Adds `A P Aᵀ`, with a symmetric `P`, to `sum`; only the lower triangle is valid afterwards and must be mirrored.
pub(crate) fn add_congruence<const N: usize, const K: usize>(
    sum: &mut SMatrix<f64, N, N>,
    a: &SMatrix<f64, N, K>,
    p: &SMatrix<f64, K, K>,
) {
    let mut half = SMatrix::<f64, K, N>::zeros();
    add_product(&mut half, p, a);
    add_product(sum, &half.transpose(), a);
}

/// Adds `A Bᵀ` to `sum`.
///
/// Zero elements of `B` are skipped: a transition or measurement matrix, which is mostly zeros, should be `B`.
#[inline]
pub(crate) fn add_product<const N: usize, const K: usize, const M: usize>(
    sum: &mut SMatrix<f64, N, M>,
    a: &SMatrix<f64, N, K>,
    b: &SMatrix<f64, M, K>,
) {
    for (j, column) in sum.data.0.iter_mut().enumerate() {
        // A local copy stays in registers.
        let mut local = *column;
        for (a_k, b_k) in a.data.0.iter().zip(&b.data.0) {
            if b_k[j] != 0.0 {
                add_scaled(&mut local, a_k, b_k[j]);
            }
        }
        *column = local;
    }
}

/// Adds `column` times `factor` to `sum`.
#[inline]
fn add_scaled<const N: usize>(sum: &mut [f64; N], column: &[f64; N], factor: f64) {
    for (sum, x) in sum.iter_mut().zip(column) {
        *sum += x * factor;
    }
}

/// `lower` with its lower triangle mirrored into the upper one.
#[inline]
pub(crate) fn mirrored<const N: usize>(mut lower: SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    for j in 1..N {
        for i in 0..j {
            lower.data.0[j][i] = lower.data.0[i][j];
        }
    }
    lower
}

/// Whether every element is finite.
#[inline]
pub(crate) fn is_finite<const R: usize, const C: usize>(matrix: &SMatrix<f64, R, C>) -> bool {
    // Zero times a number that is not finite is NaN; sums, unlike a search, are vectorized.
    let mut sums = [0.0; R];
    for column in &matrix.data.0 {
        for (sum, x) in sums.iter_mut().zip(column) {
            *sum += x * 0.0;
        }
    }
    sums.iter().sum::<f64>() == 0.0
}

/// The Cholesky factor of a symmetric matrix `S = L Lᵀ`.
pub(crate) struct Factor<const M: usize> {
    /// `L`, with the elements of `S` above the diagonal left in place.
    lower: SMatrix<f64, M, M>,
    /// The inverse diagonal of `L`.
    inverse_diagonal: SVector<f64, M>,
}

impl<const M: usize> Factor<M> {
    /// The factor of `s`, of which the lower triangle is used; `None` if it is not positive definite.
    #[inline]
    pub(crate) fn of(s: &SMatrix<f64, M, M>) -> Option<Self> {
        let mut lower = *s;
        let mut inverse_diagonal = SVector::zeros();
        for j in 0..M {
            let mut column = lower.data.0[j];
            for before in &lower.data.0[..j] {
                add_scaled(&mut column, before, -before[j]);
            }
            // False for NaN too.
            if column[j] > 0.0 {
                let inverse = 1.0 / ComplexField::sqrt(column[j]);
                inverse_diagonal[j] = inverse;
                lower.data.0[j] = column.map(|x| x * inverse);
            } else {
                return None;
            }
        }
        Some(Self { lower, inverse_diagonal })
    }

    /// `A S⁻¹`.
    #[inline]
    pub(crate) fn divide<const N: usize>(&self, mut a: SMatrix<f64, N, M>) -> SMatrix<f64, N, M> {
        // Column by column: first the columns of A L⁻ᵀ, then those of its product with L⁻¹.
        for j in 0..M {
            let mut column = a.data.0[j];
            for (done, l_k) in a.data.0.iter().zip(&self.lower.data.0).take(j) {
                add_scaled(&mut column, done, -l_k[j]);
            }
            a.data.0[j] = column.map(|x| x * self.inverse_diagonal[j]);
        }
        for j in (0..M).rev() {
            let mut column = a.data.0[j];
            for (done, l_jk) in a.data.0.iter().zip(&self.lower.data.0[j]).skip(j + 1) {
                add_scaled(&mut column, done, -l_jk);
            }
            a.data.0[j] = column.map(|x| x * self.inverse_diagonal[j]);
        }
        a
    }

    /// `L⁻¹ v`.
    #[inline]
    pub(crate) fn whiten(&self, mut v: SVector<f64, M>) -> SVector<f64, M> {
        for j in 0..M {
            v[j] *= self.inverse_diagonal[j];
            for i in j + 1..M {
                v[i] -= self.lower.data.0[j][i] * v[j];
            }
        }
        v
    }

    /// The diagonal of `L⁻¹`.
    pub(crate) const fn inverse_diagonal(&self) -> &SVector<f64, M> {
        &self.inverse_diagonal
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Matrix3x2, Matrix4};

    #[test]
    fn congruence_is_the_plain_product_and_exactly_symmetric() {
        let a = Matrix3x2::new(0.1, 0.7, -1.3, 0.3, 2.9, -0.11);
        let p = nalgebra::Matrix2::new(0.9, 0.37, 0.37, 1.7);
        let got = congruence(&a, &p);
        assert_eq!(got, got.transpose());
        assert!((got - a * p * a.transpose()).norm() < 1e-15);
    }

    #[test]
    fn factor_divides_and_whitens() {
        let root = Matrix3::new(2.0, 0.0, 0.0, 0.3, 1.5, 0.0, -0.7, 0.4, 0.9);
        let s = root * root.transpose();
        let factor = Factor::of(&s).unwrap();
        let a = Matrix4::from_fn(|i, j| (1.7 * i as f64 - 0.6 * j as f64).cos());
        let a = a.fixed_columns::<3>(0).into_owned();
        assert!((factor.divide(a) * s - a).norm() < 1e-14);
        let v = nalgebra::Vector3::new(1.0, -2.0, 3.0);
        assert!((root * factor.whiten(v) - v).norm() < 1e-14);
        for i in 0..3 {
            rins_testing::assert_close!(factor.inverse_diagonal()[i] * root[(i, i)], 1.0, 1e-14);
        }
    }

    #[test]
    fn only_a_positive_definite_matrix_has_a_factor() {
        assert!(Factor::of(&Matrix3::<f64>::zeros()).is_none());
        assert!(Factor::of(&Matrix3::from_element(1.0)).is_none());
        assert!(Factor::of(&Matrix3::from_diagonal_element(f64::NAN)).is_none());
        assert!(Factor::of(&Matrix3::new(1.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 1.0)).is_none());
    }

    #[test]
    fn mirror_reads_the_lower_triangle_only() {
        let mut lower = Matrix3::new(1.0, f64::NAN, f64::NAN, 2.0, 3.0, f64::NAN, 4.0, 5.0, 6.0);
        lower = mirrored(lower);
        assert_eq!(lower, Matrix3::new(1.0, 2.0, 4.0, 2.0, 3.0, 5.0, 4.0, 5.0, 6.0));
    }

    #[test]
    fn one_element_that_is_not_finite_is_seen_anywhere() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for index in 0..16 {
                let mut matrix = Matrix4::from_element(f64::MAX);
                assert!(is_finite(&matrix));
                matrix[index] = value;
                assert!(!is_finite(&matrix));
            }
        }
    }
}
