//! A covariance of navigation errors and constants.

use rins_lanes::Real;

/// The covariance of `N` states: nine navigation errors, then constants.
///
/// Both of each symmetric pair are kept, since whole rows are worked on; the second is either a copy
/// of the first or comes of the same operations on the same numbers.
#[derive(Clone, Copy, Debug)]
pub struct Covariance<T, const N: usize> {
    pub(super) rows: [[T; N]; N],
}

impl<T: Real, const N: usize> Covariance<T, N> {
    /// The covariance with these elements, of which the lower triangle is asked for.
    pub fn from_fn(like: T, mut element: impl FnMut(usize, usize) -> T) -> Self {
        let mut rows = [[like.constant(0.0); N]; N];
        for row in 0..N {
            for column in 0..=row {
                let value = element(row, column);
                rows[row][column] = value;
                rows[column][row] = value;
            }
        }
        Self { rows }
    }

    /// One element.
    #[inline(always)]
    pub const fn get(&self, row: usize, column: usize) -> T {
        self.rows[row][column]
    }

    /// Copies three rows that have moved into their columns; the block where they cross has no say.
    #[inline(always)]
    pub(super) fn mirror(&mut self, first: usize) {
        for others in [0..first, first + 3..N] {
            for other in others {
                for k in first..first + 3 {
                    self.rows[other][k] = self.rows[k][other];
                }
            }
        }
    }

    /// Sets the block where three rows cross their columns; its lower triangle is read.
    #[inline(always)]
    pub(super) fn set_crossing(&mut self, first: usize, block: &[[T; 3]; 3]) {
        for row in 0..3 {
            for column in 0..=row {
                self.rows[first + row][first + column] = block[row][column];
                self.rows[first + column][first + row] = block[row][column];
            }
        }
    }
}
