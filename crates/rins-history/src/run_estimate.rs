//! What one run says of the parameters.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::conditions::Conditions;
use crate::error::HistoryError;

/// A parameter whose value may vary between runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Its id, such as `gyro.scale.z`.
    pub id: String,
    /// The typical range of its variations between runs, smallest and largest, in the unit of its values.
    pub typical: (f64, f64),
}

/// The estimate of the parameters from one run: the logarithm of its likelihood is `s·θ - ½ θ·I θ`.
#[derive(Clone, Debug, PartialEq)]
pub struct RunEstimate {
    /// The conditions of the run.
    pub conditions: Conditions,
    /// The information `I` on all parameters.
    pub information: DMatrix<f64>,
    /// The score `s`.
    pub score: DVector<f64>,
}

impl RunEstimate {
    /// The estimate with these values and this covariance of some of `n` parameters, by their places; the run says nothing of the others.
    ///
    /// # Errors
    /// [`HistoryError::Shape`] if the sizes disagree or a place is twice or beyond `n`, [`HistoryError::Covariance`] if the covariance is
    /// not positive definite, [`HistoryError::NotFinite`] if a value is not finite.
    pub fn measured(
        conditions: Conditions,
        (n, places): (usize, &[usize]),
        values: &[f64],
        covariance: &DMatrix<f64>,
    ) -> Result<Self, HistoryError> {
        let size = places.len();
        let once = (0..size).all(|at| places[at] < n && !places[..at].contains(&places[at]));
        if !once || values.len() != size || covariance.shape() != (size, size) {
            return Err(HistoryError::Shape);
        }
        if !values.iter().chain(covariance.iter()).all(|x| x.is_finite()) {
            return Err(HistoryError::NotFinite);
        }
        // Of numbers of any units: correlations have an inverse where variances that differ by 1e30 have none.
        let sigmas = covariance.diagonal().map(f64::sqrt);
        let correlation =
            DMatrix::from_fn(size, size, |a, b| covariance[(a, b)] / (sigmas[a] * sigmas[b]));
        let factor = Cholesky::new(correlation).ok_or(HistoryError::Covariance)?;
        let own = factor.inverse();
        let mut information = DMatrix::zeros(n, n);
        let mut score = DVector::zeros(n);
        for (a, &row) in places.iter().enumerate() {
            for (b, &column) in places.iter().enumerate() {
                let entry = own[(a, b)] / (sigmas[a] * sigmas[b]);
                information[(row, column)] = entry;
                score[row] += entry * values[b];
            }
        }
        Ok(Self { conditions, information, score })
    }

    /// The value of a parameter with its 1σ, if this run observes it: all others are estimated too.
    pub fn value(&self, place: usize) -> Option<(f64, f64)> {
        let seen: Vec<usize> =
            (0..self.score.len()).filter(|&at| self.information[(at, at)] > 0.0).collect();
        let at = seen.iter().position(|&other| other == place)?;
        let roots: Vec<f64> = seen.iter().map(|&at| self.information[(at, at)].sqrt()).collect();
        let size = seen.len();
        let unit = DMatrix::from_fn(size, size, |a, b| {
            self.information[(seen[a], seen[b])] / (roots[a] * roots[b])
        });
        let factor = Cholesky::new(unit)?;
        let score = DVector::from_fn(size, |a, _| self.score[seen[a]] / roots[a]);
        let mut pick = DVector::zeros(size);
        pick[at] = 1.0;
        let row = factor.solve(&pick);
        let sigma = row[at].sqrt() / roots[at];
        Some((row.dot(&score) / roots[at], sigma))
            .filter(|(value, sigma)| value.is_finite() && sigma.is_finite() && *sigma > 0.0)
    }
}
