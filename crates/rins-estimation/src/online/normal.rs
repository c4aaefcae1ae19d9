//! The normal equations of the parameters, which the whitened innovations add to.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::step::SHOWN;

/// The information on the parameters in the epochs so far, and the score at the point of linearization.
#[derive(Clone, Debug)]
pub(super) struct Normal {
    pub(super) information: DMatrix<f64>,
    pub(super) score: DVector<f64>,
    /// The sum of the squared whitened innovations at the point of linearization.
    pub(super) square: f64,
    /// The sigmas of the priors.
    sigmas: DVector<f64>,
}

/// The solution of the normal equations with the priors.
#[derive(Clone, Debug)]
pub(super) struct Solution {
    /// The estimate relative to the point of linearization.
    pub(super) step: DVector<f64>,
    /// The 1σ of each parameter.
    pub(super) sigmas: DVector<f64>,
}

impl Normal {
    pub(super) fn new(sigmas: &[f64]) -> Self {
        let p = sigmas.len();
        Self {
            information: DMatrix::zeros(p, p),
            score: DVector::zeros(p),
            square: 0.0,
            sigmas: DVector::from_column_slice(sigmas),
        }
    }

    /// Adds the whitened columns of an epoch: a row for each measurement, with the residuals first.
    pub(super) fn add(&mut self, whitened: &[f64]) {
        let p = self.score.len();
        for row in whitened.chunks_exact(whitened.len() / SHOWN) {
            let (residual, by) = (row[0], &row[1..=p]);
            self.square += residual * residual;
            for (place, factor) in by.iter().enumerate() {
                self.score[place] -= factor * residual;
                // The lower triangle.
                let mut column = self.information.column_mut(place);
                let below = column.as_mut_slice()[place..].iter_mut().zip(&by[place..]);
                below.for_each(|(sum, other)| *sum += factor * other);
            }
        }
    }

    /// The sum of the squared whitened innovations at an estimate relative to the point of linearization.
    pub(super) fn square_at(&self, step: &DVector<f64>) -> f64 {
        let mut change = DVector::zeros(step.len());
        change.sygemv(1.0, &self.information, step, 0.0);
        self.square + step.dot(&change) - 2.0 * self.score.dot(step)
    }

    /// The information with the priors, in units of their sigmas, as its Cholesky factor; `None` if it is not finite.
    fn factor(&self) -> Option<Cholesky<f64, Dyn>> {
        let mut scaled = self.information.clone();
        for (place, mut column) in scaled.column_iter_mut().enumerate() {
            let sigma = self.sigmas[place];
            for (number, other) in column.iter_mut().zip(&self.sigmas) {
                *number *= sigma * other;
            }
            column[place] += 1.0;
        }
        Cholesky::new(scaled)
    }

    /// The estimate with priors of these means relative to the point of linearization; `None` if the information is not finite.
    pub(super) fn solve(&self, expected: &DVector<f64>) -> Option<Solution> {
        let factor = self.factor()?;
        let right = self.score.component_mul(&self.sigmas) + expected.component_div(&self.sigmas);
        let step = factor.solve(&right).component_mul(&self.sigmas);
        let p = step.len();
        let inverse = factor.l_dirty().solve_lower_triangular(&DMatrix::identity(p, p))?;
        let sigmas = DVector::from_fn(p, |place, _| inverse.column(place).norm());
        Some(Solution { step, sigmas: sigmas.component_mul(&self.sigmas) })
    }

    /// The covariance of the parameters; `None` if the information is not finite.
    pub(super) fn covariance(&self) -> Option<DMatrix<f64>> {
        let scale = DMatrix::from_diagonal(&self.sigmas);
        Some(&scale * self.factor()?.inverse() * &scale)
    }
}
