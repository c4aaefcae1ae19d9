//! The correction by three measurement rows.

use rins_lanes::{Real, Vector};

use super::covariance::Covariance;

/// Three rows over all states.
pub(super) type Rows<T, const N: usize> = [[T; N]; 3];

/// The gain of three measurement rows.
#[derive(Debug)]
pub(super) struct Correction<'a, T, const N: usize> {
    /// The transpose of `(P Hᵀ + C) L⁻ᵀ` with the Cholesky factor `L` of `S`: the correction of the states per unit of each
    /// whitened innovation.
    shown: &'a Rows<T, N>,
    /// The Cholesky factor's subdiagonal elements: (1,0), (2,0) and (2,1).
    below: [T; 3],
    /// The inverse of its diagonal; NaN if `S` is not positive definite.
    pub(super) inverse_scales: [T; 3],
}

impl<'a, T: Real, const N: usize> Correction<'a, T, N> {
    /// The correction for the covariance `with_state` of the innovation with the state's error, `(P Hᵀ + C)ᵀ`, which it
    /// overwrites, and the innovation covariance `innovation`: (0,0), (1,0), (1,1), (2,0), (2,1), (2,2).
    #[inline(always)]
    pub(super) fn new(with_state: &'a mut Rows<T, N>, innovation: [T; 6]) -> Self {
        let [s00, s10, s11, s20, s21, s22] = innovation;
        let one = s00.constant(1.0);
        // The pivots depend on each other by divisions only, so that no square root, which takes longer, waits for another.
        let r0 = one / s00;
        let (m10, m20) = (s10 * r0, s20 * r0);
        let r1 = one / (s11 - s10 * m10);
        let t21 = s21 - s20 * m10;
        let r2 = one / (s22 - s20 * m20 - t21 * t21 * r1);
        let (i0, i1, i2) = (r0.sqrt(), r1.sqrt(), r2.sqrt());
        let (l10, l20, l21) = (s10 * i0, s20 * i0, t21 * i1);
        let [first, second, third] = with_state;
        for j in 0..N {
            let x0 = first[j] * i0;
            let x1 = (second[j] - x0 * l10) * i1;
            third[j] = (third[j] - x0 * l20 - x1 * l21) * i2;
            first[j] = x0;
            second[j] = x1;
        }
        Self { shown: with_state, below: [l10, l20, l21], inverse_scales: [i0, i1, i2] }
    }

    /// Whitens the innovation: `L⁻¹ x`.
    #[inline(always)]
    pub(super) fn whiten(&self, x: &Vector<T>) -> Vector<T> {
        let ([l10, l20, l21], [i0, i1, i2]) = (self.below, self.inverse_scales);
        let x0 = x[0] * i0;
        let x1 = (x[1] - x0 * l10) * i1;
        Vector([x0, x1, (x[2] - x0 * l20 - x1 * l21) * i2])
    }

    /// Adds the correction of each state by the whitened innovation.
    #[inline(always)]
    pub(super) fn add_to(&self, state: &mut [T; N], whitened: &Vector<T>) {
        for j in 0..N {
            state[j] = state[j]
                + (self.shown[0][j] * whitened[0]
                    + self.shown[1][j] * whitened[1]
                    + self.shown[2][j] * whitened[2]);
        }
    }

    /// Subtracts the information of the measurement from the covariance.
    #[inline(always)]
    pub(super) fn reduce(&self, p: &mut Covariance<T, N>) {
        let [a, b, c] = self.shown;
        if self.below[0].lanes() > 1 {
            // Two rows in parallel share the loaded gains of a column.
            let pairs = N / 2;
            for pair in 0..pairs {
                let (row, next) = (2 * pair, 2 * pair + 1);
                let (x, y, z) = (a[row], b[row], c[row]);
                let (u, v, w) = (a[next], b[next], c[next]);
                for column in 0..next {
                    let (a, b, c) = (a[column], b[column], c[column]);
                    let first = p.rows[row][column] - (x * a + y * b + z * c);
                    let second = p.rows[next][column] - (u * a + v * b + w * c);
                    p.rows[row][column] = first;
                    p.rows[next][column] = second;
                    p.rows[column][row] = first;
                    p.rows[column][next] = second;
                }
                p.rows[next][next] = p.rows[next][next] - (u * u + v * v + w * w);
            }
            if 2 * pairs < N {
                let (x, y, z) = (a[N - 1], b[N - 1], c[N - 1]);
                for column in 0..N {
                    let left =
                        p.rows[N - 1][column] - (x * a[column] + y * b[column] + z * c[column]);
                    p.rows[N - 1][column] = left;
                    p.rows[column][N - 1] = left;
                }
            }
        } else {
            // A whole row at once is as fast as half of it, and both elements of a pair are identical.
            for (row, numbers) in p.rows.iter_mut().enumerate() {
                let (x, y, z) = (a[row], b[row], c[row]);
                for column in 0..N {
                    let known = x * a[column] + y * b[column] + z * c[column];
                    numbers[column] = numbers[column] - known;
                }
            }
        }
    }
}
