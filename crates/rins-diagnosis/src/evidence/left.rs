//! What is left to say of the parameters of candidates once those of the model have been estimated.

use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};

use crate::hypothesis::USUAL;

/// What is left to say of parameters when others have been estimated, or set to nothing.
///
/// Few of the products of thousands of candidates' parameters are ever asked for: each block is made when it is.
pub(crate) struct Left<'a> {
    /// The information on all parameters, in units of the priors' sigmas.
    pub(super) information: &'a DMatrix<f64>,
    /// What the estimated ones explain of it: `L⁻¹ A`, where `A` are their products with what is left, and `L Lᵀ` those with
    /// each other.
    pub(super) explained: DMatrix<f64>,
    /// The derivative of the log-likelihood by all that is left.
    pub(crate) score: DVector<f64>,
    /// The places that are left.
    pub(super) places: Vec<usize>,
    /// The logarithm of the probability of the data, but for a constant, if none of what is left is there.
    pub(crate) log_likelihood: f64,
}

impl Left<'_> {
    /// The information on all that is left.
    pub(crate) fn all(&self) -> DMatrix<f64> {
        let all = chosen(self.information, &self.places, &self.places);
        all - self.explained.tr_mul(&self.explained)
    }

    /// Information and score of some of the places that are left.
    pub(crate) fn block(&self, places: &[usize]) -> (DMatrix<f64>, DVector<f64>) {
        let (own, places): (Vec<usize>, Vec<usize>) =
            places.iter().filter_map(|&place| Some((self.position(place)?, place))).unzip();
        let score = DVector::from_iterator(own.len(), own.iter().map(|&place| self.score[place]));
        let information = DMatrix::from_fn(own.len(), own.len(), |row, column| {
            let explained =
                self.explained.column(own[row]).dot(&self.explained.column(own[column]));
            self.information[(places[row], places[column])] - explained
        });
        (information, score)
    }

    /// The estimate of some of the places that are left, in units of the priors' sigmas, and by how much the
    /// squares fall with it. None if they are not shown.
    pub(crate) fn estimate(&self, places: &[usize]) -> Option<(DVector<f64>, f64)> {
        let (information, score) = self.block(places);
        let estimate = Cholesky::new(information)?.solve(&score);
        let statistic = estimate.dot(&score);
        Some((estimate, statistic))
    }

    /// By how much the squares fall with some of the places that are left, a chi-square without an effect, and its degrees of freedom:
    /// the directions that are known to less than [`USUAL`] of what is usual.
    pub(crate) fn statistic(&self, places: &[usize]) -> (f64, usize) {
        let (information, score) = self.block(places);
        shown(information, &score)
    }

    /// The same of all that is left.
    pub(crate) fn statistic_of_all(&self) -> (f64, usize) {
        shown(self.all(), &self.score)
    }

    /// The candidates' places go on without gaps to the last; before them are those that were dropped.
    fn position(&self, place: usize) -> Option<usize> {
        let by_end = self
            .places
            .last()
            .and_then(|last| last.checked_sub(place))
            .and_then(|from_end| self.places.len().checked_sub(1 + from_end));
        by_end
            .filter(|&at| self.places[at] == place)
            .or_else(|| self.places.iter().position(|p| *p == place))
    }
}

fn shown(information: DMatrix<f64>, score: &DVector<f64>) -> (f64, usize) {
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(information);
    let along = eigenvectors.tr_mul(score);
    let each = eigenvalues.iter().zip(along.iter());
    let is_shown = |(value, _): &(&f64, &f64)| **value * USUAL * USUAL > 1.0;
    let squares = each.filter(is_shown).map(|(value, along)| along * along / value);
    squares.fold((0.0, 0), |(sum, dof), square| (sum + square, dof + 1))
}

pub(super) fn chosen(matrix: &DMatrix<f64>, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), columns.len(), |row, column| matrix[(rows[row], columns[column])])
}
