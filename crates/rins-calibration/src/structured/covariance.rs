//! A covariance of navigation errors and constants.

use core::array;

use rins_lanes::Real;

/// The covariance of `N` states: nine navigation errors, then constants.
///
/// Both elements of each symmetric pair are stored, since operations process whole rows. The second is either a copy of the
/// first or the result of the same operations on the same numbers.
#[derive(Clone, Copy, Debug)]
pub struct Covariance<T, const N: usize> {
    pub(super) rows: [[T; N]; N],
}

impl<T: Real, const N: usize> Covariance<T, N> {
    /// The covariance with these elements; only the lower triangle is queried.
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

    /// Copies three updated rows into their columns, apart from the block where these intersect.
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
                    // In a row that was not updated the fourth column already is a copy.
                    let columns: [T; 4] = array::from_fn(|k| self.rows[pairs + k][other]);
                    self.rows[other][pairs..pairs + 4].copy_from_slice(&columns);
                }
            }
        }
    }

    /// Sets the block where three rows intersect their columns; only its lower triangle is read.
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

    /// The first of four columns in whole pairs that contain the three from `first` on.
    ///
    /// The rows of one run are read in pairs. Reading a pair of which only one number was written just before waits for the
    /// cache, which takes longer than writing the other one again.
    const fn pairs(first: usize) -> usize {
        let pairs = first / 2 * 2;
        if pairs + 4 > N { N - 4 } else { pairs }
    }
}
