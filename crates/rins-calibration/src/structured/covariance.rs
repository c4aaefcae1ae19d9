//! A covariance of navigation errors and constants.

use core::array;

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
        let pairs = Self::pairs(first);
        for others in [0..first, first + 3..N] {
            for other in others {
                if self.rows[0][0].lanes() > 1 {
                    for k in first..first + 3 {
                        self.rows[other][k] = self.rows[k][other];
                    }
                } else {
                    // Of the row that has not moved the column is a copy already.
                    let columns: [T; 4] = array::from_fn(|k| self.rows[pairs + k][other]);
                    self.rows[other][pairs..pairs + 4].copy_from_slice(&columns);
                }
            }
        }
    }

    /// Sets the block where three rows cross their columns; its lower triangle is read.
    #[inline(always)]
    pub(super) fn set_crossing(&mut self, first: usize, block: &[[T; 3]; 3]) {
        let pairs = Self::pairs(first);
        for row in 0..3 {
            if self.rows[0][0].lanes() > 1 {
                for column in 0..=row {
                    self.rows[first + row][first + column] = block[row][column];
                    self.rows[first + column][first + row] = block[row][column];
                }
            } else {
                let numbers = &mut self.rows[first + row];
                let mut columns: [T; 4] = array::from_fn(|k| numbers[pairs + k]);
                for column in 0..3 {
                    columns[first - pairs + column] = block[row.max(column)][row.min(column)];
                }
                numbers[pairs..pairs + 4].copy_from_slice(&columns);
            }
        }
    }

    /// Where four columns in whole pairs begin, among them the three from `first` on.
    ///
    /// One run's rows are read in pairs. To read a pair of which only one was written just now takes
    /// until that has come as far as the cache, longer than to write its other one again.
    const fn pairs(first: usize) -> usize {
        let pairs = first / 2 * 2;
        if pairs + 4 > N { N - 4 } else { pairs }
    }
}
