//! Covariances in numbers of 200 bits, for sigmas to be compared with.

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use nalgebra::{RowSVector, SMatrix};

type Number = FBig<HalfEven>;

/// A matrix, row by row.
type Rows = Vec<Vec<Number>>;

/// Thrice those of an `f64`, and some.
const BITS: usize = 200;

fn number(x: f64) -> Number {
    Number::try_from(x).expect("a finite number").with_precision(BITS).value()
}

/// A filter's covariance by the textbook's plain form, in numbers long enough for it.
#[derive(Clone, Debug)]
pub struct LongCovariance<const N: usize>(Rows);

impl<const N: usize> LongCovariance<N> {
    /// The covariance with these elements.
    pub fn new(element: impl Fn(usize, usize) -> f64) -> Self {
        Self((0..N).map(|i| (0..N).map(|j| number(element(i, j))).collect()).collect())
    }

    /// The covariance of what depends on these sources, of such variances.
    pub fn of_sources<const K: usize>(by: &SMatrix<f64, N, K>, variances: &[f64; K]) -> Self {
        let element = |i: usize, j: usize| {
            let mut sum = number(0.0);
            for k in 0..K {
                sum += number(by[(i, k)]) * number(variances[k]) * number(by[(j, k)]);
            }
            sum
        };
        Self((0..N).map(|i| (0..N).map(|j| element(i, j)).collect()).collect())
    }

    /// `Φ P Φᵀ + Q`.
    pub fn predict(&mut self, transition: &SMatrix<f64, N, N>, noise: &SMatrix<f64, N, N>) {
        let mut p = product(&transposed(&product(&self.0, transition)), transition);
        for (i, row) in p.iter_mut().enumerate() {
            for (j, element) in row.iter_mut().enumerate() {
                *element += number(noise[(i, j)]);
            }
        }
        self.0 = p;
    }

    /// What is left of it after rows `H` with noise `R`, of which the state's error has the covariance `C`.
    pub fn update<const M: usize>(
        &mut self,
        h: &SMatrix<f64, M, N>,
        r: &SMatrix<f64, M, M>,
        c: &SMatrix<f64, N, M>,
    ) {
        // P Hᵀ + C, a row for each state; (H C)ᵀ, and S = H (P Hᵀ + C) + (H C)ᵀ + R.
        let mut with = product(&self.0, h);
        for (i, row) in with.iter_mut().enumerate() {
            for (j, element) in row.iter_mut().enumerate() {
                *element += number(c[(i, j)]);
            }
        }
        let crossed: Rows = transposed(
            &(0..N).map(|i| (0..M).map(|j| number(c[(i, j)])).collect()).collect::<Rows>(),
        );
        let crossed = product(&crossed, h);
        let mut s = product(&transposed(&with), h);
        for i in 0..M {
            for j in 0..M {
                // The first product is the other way round.
                let more = &crossed[j][i] + number(r[(i, j)]);
                s[i][j] += more;
            }
        }
        // What each row of S explains of the rows below it and of the state is taken away.
        for row in 0..M {
            for i in row + 1..M {
                let share = &s[i][row] / &s[row][row];
                let explained: Vec<Number> = s[row].iter().map(|x| &share * x).collect();
                for (left, explained) in s[i].iter_mut().zip(explained) {
                    *left -= explained;
                }
                for state in &mut with {
                    let explained = &share * &state[row];
                    state[i] -= explained;
                }
            }
            for i in 0..N {
                let share = &with[i][row] / &s[row][row];
                for (left, other) in self.0[i].iter_mut().zip(&with) {
                    *left -= &share * &other[row];
                }
            }
        }
    }

    /// The variance of a combination of states.
    pub fn variance_of(&self, combination: &RowSVector<f64, N>) -> f64 {
        let half = product(&self.0, combination);
        product(&transposed(&half), combination)[0][0].to_f64().value()
    }
}

/// `A Bᵀ`, passing over the zeros of `B`.
fn product<const K: usize, const M: usize>(a: &[Vec<Number>], b: &SMatrix<f64, M, K>) -> Rows {
    let element = |row: &[Number], column: usize| {
        let mut sum = number(0.0);
        for (k, x) in row.iter().enumerate() {
            if b[(column, k)].abs() > 0.0 {
                sum += x * number(b[(column, k)]);
            }
        }
        sum
    };
    a.iter().map(|row| (0..M).map(|column| element(row, column)).collect()).collect()
}

fn transposed(a: &[Vec<Number>]) -> Rows {
    (0..a[0].len()).map(|j| a.iter().map(|row| row[j].clone()).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix1, Matrix2, RowVector2, Vector2};

    #[test]
    fn what_an_f64_would_round_away_is_kept() {
        let mut p = LongCovariance::<2>::new(|i, j| if i == j { 1e30 } else { 0.0 });
        p.predict(&Matrix2::new(1.0, 1.0, 0.0, 1.0), &Matrix2::zeros());
        let sum = RowVector2::new(1.0, 0.0);
        p.update(&sum, &Matrix1::new(1.0), &Vector2::zeros());
        crate::assert_close!(p.variance_of(&sum), 1.0, 1e-15);
        crate::assert_close!(p.variance_of(&RowVector2::new(0.0, 1.0)) / 5e29, 1.0, 1e-15);
    }

    #[test]
    fn noise_that_moved_the_state_is_seen_through() {
        // The same as in the documentation of the filter's measurement: the error is the noise itself.
        let mut p = LongCovariance::<1>::of_sources(&Matrix1::new(2.0), &[1.0]);
        p.update(&Matrix1::new(0.0), &Matrix1::new(5.0), &Matrix1::new(-4.0));
        crate::assert_close!(p.variance_of(&Matrix1::new(1.0)), 4.0 - 16.0 / 5.0, 1e-15);
    }
}
