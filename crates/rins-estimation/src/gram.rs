//! Gram matrices: sums of outer products of many columns.

use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::{Accum, Mat, Par};
use nalgebra::DMatrix;

/// The number of columns in a block.
const COLUMNS: usize = 384;

/// `Σ Z Zᵀ` over matrices `Z` of few columns, calculated block by block.
pub(crate) struct Gram {
    block: Mat<f64>,
    filled: usize,
    sum: Mat<f64>,
}

impl Gram {
    pub(crate) fn new(rows: usize) -> Self {
        Self { block: Mat::zeros(rows, COLUMNS), filled: 0, sum: Mat::zeros(rows, rows) }
    }

    /// Adds the products of successive columns, each of which may have unused numbers at its end.
    pub(crate) fn add(&mut self, columns: &[f64], count: usize) {
        if self.filled + count > COLUMNS {
            self.empty();
        }
        for column in columns.chunks_exact(columns.len() / count) {
            let place = self.filled;
            for (to, from) in self.block.col_mut(place).iter_mut().zip(column) {
                *to = *from;
            }
            self.filled += 1;
        }
    }

    fn empty(&mut self) {
        let block = self.block.as_ref().subcols(0, self.filled);
        let (lower, full) = (BlockStructure::TriangularLower, BlockStructure::Rectangular);
        let (sum, par) = (&mut self.sum, Par::Seq);
        matmul(sum, lower, Accum::Add, block, full, block.transpose(), full, 1.0, par);
        self.filled = 0;
    }

    pub(crate) fn finish(mut self) -> DMatrix<f64> {
        self.empty();
        let n = self.sum.ncols();
        DMatrix::from_fn(n, n, |row, column| self.sum[(row.max(column), row.min(column))])
    }
}
