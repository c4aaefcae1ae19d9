//! The runs of one IMU, or of several: whether their parameters are the same, and how they vary.

use nalgebra::DMatrix;
use rins_bayes::ln_tail;

use crate::conditions::{Conditions, Conduct};
use crate::error::HistoryError;
use crate::explanation::Explanation;
use crate::hypothesis::Catalogue;
use crate::information::{Amplitudes, Information};
use crate::run_estimate::{Quantity, RunEstimate};
use crate::search::search;

/// Estimates of the same parameters from several runs.
#[derive(Clone, Debug)]
pub struct History {
    quantities: Vec<Quantity>,
    runs: Vec<RunEstimate>,
}

/// The test whether a parameter is the same in all runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Homogeneity {
    /// The id of the parameter.
    pub id: String,
    /// The chi-square statistic of the differences between runs.
    pub chi_square: f64,
    /// Its degrees of freedom.
    pub dof: usize,
    /// The logarithm of the p-value, of this parameter alone.
    pub ln_p: f64,
    /// The value and the 1σ of the parameter from each run; `None` where the run does not observe it.
    pub values: Vec<Option<(f64, f64)>>,
}

/// A direction of which the information is less than this part of the largest is not observed.
const UNSEEN: f64 = 1e-9;

impl History {
    /// The history of these parameters over these runs.
    ///
    /// # Errors
    /// [`HistoryError::FewRuns`] for fewer than two runs, [`HistoryError::Typical`] for a typical range that is not positive and finite,
    /// [`HistoryError::Shape`] or [`HistoryError::NotFinite`] for a run whose information is not of these parameters, or not finite.
    pub fn new(quantities: Vec<Quantity>, runs: Vec<RunEstimate>) -> Result<Self, HistoryError> {
        if runs.len() < 2 {
            return Err(HistoryError::FewRuns { runs: runs.len() });
        }
        for Quantity { id, typical: (low, high) } in &quantities {
            if !(*low > 0.0 && low <= high && high.is_finite()) {
                return Err(HistoryError::Typical { id: id.clone(), low: *low, high: *high });
            }
        }
        let n = quantities.len();
        for run in &runs {
            if run.information.shape() != (n, n) || run.score.len() != n {
                return Err(HistoryError::Shape);
            }
            if !run.information.iter().chain(run.score.iter()).all(|x| x.is_finite()) {
                return Err(HistoryError::NotFinite);
            }
        }
        Ok(Self { quantities, runs })
    }

    /// The parameters.
    pub fn quantities(&self) -> &[Quantity] {
        &self.quantities
    }

    /// The runs.
    pub fn runs(&self) -> &[RunEstimate] {
        &self.runs
    }

    /// The test of each parameter whether it is the same in all runs, the others being so.
    pub fn homogeneity(&self) -> Vec<Homogeneity> {
        let (information, _) = self.parts();
        let means = information.gram(std::iter::empty());
        let solved = means.solved(&[]);
        let of = |(quantity, of): (usize, &Quantity)| {
            let values = self.runs.iter().map(|run| run.value(quantity)).collect();
            let statistic = solved.as_ref().map(|solved| {
                // A value of its own in all runs but the first.
                let runs = self.runs.len();
                let own = |run: usize, column: usize| f64::from(u8::from(run == column + 1));
                let columns = DMatrix::from_fn(runs, runs - 1, own);
                let further = Amplitudes { quantity, columns };
                let (own, score) = information.beside(&further, solved);
                let eigen = own.symmetric_eigen();
                let least = UNSEEN * eigen.eigenvalues.max();
                let along = eigen.eigenvectors.tr_mul(&score);
                let seen = eigen.eigenvalues.iter().zip(along.iter());
                let seen = seen.filter(|(value, _)| **value > least && **value > 0.0);
                seen.fold((0.0, 0), |(sum, dof), (value, along)| {
                    (sum + along * along / value, dof + 1)
                })
            });
            let (chi_square, dof) = statistic.unwrap_or((0.0, 0));
            let ln_p = if dof > 0 { ln_tail(chi_square, dof) } else { 0.0 };
            Homogeneity { id: of.id.clone(), chi_square, dof, ln_p, values }
        };
        self.quantities.iter().enumerate().map(of).collect()
    }

    /// How the parameters vary: the most probable hypothesis, and what else would explain the runs.
    pub fn explain(&self) -> Explanation {
        let (information, conduct) = self.parts();
        let typical: Vec<(f64, f64)> = self.quantities.iter().map(|one| one.typical).collect();
        let catalogue = Catalogue::of(&conduct, &information, &typical);
        let best = search(&information, &catalogue);
        let ids = self.quantities.iter().map(|one| one.id.clone()).collect();
        Explanation::of(ids, (information, conduct, catalogue), best)
    }

    /// The history of the runs at these places.
    ///
    /// # Errors
    /// [`HistoryError::FewRuns`] for fewer than two.
    pub fn of_runs(&self, places: &[usize]) -> Result<Self, HistoryError> {
        let runs = places.iter().filter_map(|&place| self.runs.get(place).cloned()).collect();
        Self::new(self.quantities.clone(), runs)
    }

    fn parts(&self) -> (Information, Conduct) {
        let units = self.quantities.iter().map(|one| one.typical.1).collect();
        let all: Vec<Conditions> = self.runs.iter().map(|run| run.conditions).collect();
        let measured = all.len();
        (Information::of(&self.runs, units), Conduct { all, measured })
    }
}
