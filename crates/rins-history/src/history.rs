//! The runs of one IMU, or of several: whether their parameters are the same, and how they vary.

use nalgebra::DMatrix;
use rins_bayes::ln_tail;

use crate::conditions::{Conditions, Conduct};
use crate::error::HistoryError;
use crate::explanation::Explanation;
use crate::hypothesis::Catalogue;
use crate::information::{Amplitudes, Information, WIDE};
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
    /// The logarithm of the p-value, all other parameters being the same in all runs.
    pub ln_p: f64,
    /// The logarithm of the p-value if the more significant parameters are not the same in all runs: correlated estimates may make
    /// several parameters differ where one does.
    pub ln_p_beside: f64,
    /// The value and the 1σ of the parameter from each run; `None` where the run does not observe it.
    pub values: Vec<Option<(f64, f64)>>,
}

/// A parameter that differs with a larger p-value differs by chance.
const LARGE: f64 = 0.05;

/// How much a parameter differs between runs.
#[derive(Clone, Copy)]
struct Difference {
    chi_square: f64,
    dof: usize,
}

impl Difference {
    fn ln_p(&self) -> f64 {
        if self.dof > 0 { ln_tail(self.chi_square, self.dof) } else { 0.0 }
    }
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

    /// The test of each parameter whether it is the same in all runs.
    pub fn homogeneity(&self) -> Vec<Homogeneity> {
        let (information, _) = self.parts();
        let all: Vec<usize> = (0..self.quantities.len()).collect();
        let alone = self.differences(&information, &[], &all);
        let mut beside: Vec<f64> = vec![0.0; all.len()];
        let mut free: Vec<usize> = Vec::new();
        // With none free, the tests are those of each alone.
        let (mut rest, mut tests) = (all, alone.clone());
        loop {
            let least = rest.iter().zip(&tests).min_by(|a, b| a.1.ln_p().total_cmp(&b.1.ln_p()));
            let Some((&place, test)) = least else { break };
            if test.ln_p() > LARGE.ln() {
                rest.iter().zip(&tests).for_each(|(&at, test)| beside[at] = test.ln_p());
                break;
            }
            beside[place] = test.ln_p();
            free.push(place);
            rest.retain(|&at| at != place);
            tests = self.differences(&information, &free, &rest);
        }
        let of = |((place, quantity), test): ((usize, &Quantity), &Difference)| Homogeneity {
            id: quantity.id.clone(),
            chi_square: test.chi_square,
            dof: test.dof,
            ln_p: test.ln_p(),
            ln_p_beside: beside[place],
            values: self.runs.iter().map(|run| run.value(place)).collect(),
        };
        self.quantities.iter().enumerate().zip(&alone).map(of).collect()
    }

    /// How much some parameters differ between runs, those that are `free` differing too, each of the others being the same.
    fn differences(
        &self,
        information: &Information,
        free: &[usize],
        of: &[usize],
    ) -> Vec<Difference> {
        // A value of its own in all runs but the first.
        let runs = self.runs.len();
        let own = |run: usize, column: usize| f64::from(u8::from(run == column + 1));
        let columns = DMatrix::from_fn(runs, runs - 1, own);
        let of_parameter = |&quantity: &usize| Amplitudes { quantity, columns: columns.clone() };
        let gram = information.gram(free.iter().map(of_parameter));
        let solved = gram.solved(&vec![WIDE; free.len()]);
        let difference = |quantity: &usize| {
            let Some(solved) = &solved else { return Difference { chi_square: 0.0, dof: 0 } };
            let (own, score) = information.beside(&of_parameter(quantity), solved);
            let eigen = own.symmetric_eigen();
            let least = UNSEEN * eigen.eigenvalues.max();
            let along = eigen.eigenvectors.tr_mul(&score);
            let seen = eigen.eigenvalues.iter().zip(along.iter());
            let seen = seen.filter(|(value, _)| **value > least && **value > 0.0);
            let (chi_square, dof) = seen.fold((0.0, 0), |(sum, dof), (value, along)| {
                (sum + along * along / value, dof + 1)
            });
            Difference { chi_square, dof }
        };
        of.iter().map(difference).collect()
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
