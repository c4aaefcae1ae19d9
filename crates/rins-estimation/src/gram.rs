//! Sums of products of many rows.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use nalgebra::DMatrix;

/// How many rows are taken together.
const ROWS: usize = 384;

/// `Σ ZᵀZ` over matrices `Z` of few rows, a block at a time.
pub(crate) struct Gram {
    rows: Mat<f64>,
    filled: usize,
    sum: Mat<f64>,
}

impl Gram {
    pub(crate) fn new(columns: usize) -> Self {
        Self { rows: Mat::zeros(ROWS, columns), filled: 0, sum: Mat::zeros(columns, columns) }
    }

    pub(crate) fn add(&mut self, rows: &DMatrix<f64>) {
        if self.filled + rows.nrows() > ROWS {
            self.empty();
        }
        for column in 0..rows.ncols() {
            for row in 0..rows.nrows() {
                self.rows[(self.filled + row, column)] = rows[(row, column)];
            }
        }
        self.filled += rows.nrows();
    }

    fn empty(&mut self) {
        let block = self.rows.as_ref().subrows(0, self.filled);
        matmul(&mut self.sum, Accum::Add, block.transpose(), block, 1.0, Par::Seq);
        self.filled = 0;
    }

    pub(crate) fn finish(mut self) -> DMatrix<f64> {
        self.empty();
        let n = self.sum.ncols();
        DMatrix::from_fn(n, n, |row, column| self.sum[(row, column)])
    }
}
