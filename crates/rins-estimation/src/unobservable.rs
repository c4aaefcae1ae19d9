//! Unobservable parameters keep the values of their priors.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::estimate::{Estimate, Fit};
use crate::identifiability::Identifiability;

impl Identifiability {
    /// The places of the unobservable parameters: the data reduce their uncertainty by less than a factor of two, alone and
    /// in every combination.
    pub fn unobservable(&self) -> Vec<usize> {
        let is_unobservable = |&place: &usize| {
            !self.parameters[place].identifiable && self.parameters[place].aliases.is_empty()
        };
        (0..self.parameters.len()).filter(is_unobservable).collect()
    }
}

/// The change of the estimates with this covariance if those at `places` have the means of their priors, as of
/// [`Fit::with_prior_values_at`]; the covariance becomes that of the changed estimates. `None` if nothing changes.
pub(crate) fn at_prior_values(
    parameters: &[Estimate],
    covariance: &mut DMatrix<f64>,
    places: &[usize],
) -> Option<DVector<f64>> {
    if places.is_empty() {
        return None;
    }
    let others: Vec<usize> =
        (0..parameters.len()).filter(|place| !places.contains(place)).collect();
    let block = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |row, column| {
            covariance[(rows[row], columns[column])]
        })
    };
    // These blocks of a positive definite covariance are positive definite.
    let own = Cholesky::new(block(places, places))?;
    let across = block(places, &others);
    // The change of the other estimates per unit change of these.
    let follow = own.solve(&across).transpose();
    let moved = DVector::from_iterator(
        places.len(),
        places.iter().map(|&place| parameters[place].expected - parameters[place].value),
    );
    let prior = DMatrix::from_diagonal(&DVector::from_iterator(
        places.len(),
        places.iter().map(|&place| parameters[place].parameter.sigma.powi(2)),
    ));
    let shared = &follow * &prior;
    let rest = block(&others, &others) - &follow * &across + &shared * follow.transpose();
    let mut step = DVector::zeros(parameters.len());
    for (&place, by) in places.iter().zip(&moved) {
        step[place] = *by;
    }
    for (&place, by) in others.iter().zip(&(&follow * &moved)) {
        step[place] = *by;
    }
    for (row, &to_row) in places.iter().enumerate() {
        for (column, &to_column) in places.iter().enumerate() {
            covariance[(to_row, to_column)] = prior[(row, column)];
        }
    }
    for (row, &to_row) in others.iter().enumerate() {
        for (column, &to_column) in others.iter().enumerate() {
            covariance[(to_row, to_column)] = rest[(row, column)];
        }
        for (column, &to_column) in places.iter().enumerate() {
            covariance[(to_row, to_column)] = shared[(row, column)];
            covariance[(to_column, to_row)] = shared[(row, column)];
        }
    }
    Some(step)
}

impl Fit {
    /// The same fit with the parameters at `places` at the means of their priors, with the priors' 1σ.
    ///
    /// The remaining information on a prior-dominated parameter is mostly noise and linearization error. The other estimates
    /// become the conditional means for these values, with a covariance that includes the prior uncertainty of the parameters
    /// at `places` (consider parameters; Schmidt 1966). The models have all these values; the linearized runs do not change.
    ///
    /// # Panics
    /// If a place is not that of a parameter.
    #[must_use]
    pub fn with_prior_values_at(mut self, places: &[usize]) -> Self {
        let Some(step) = at_prior_values(&self.parameters, &mut self.covariance, places) else {
            return self;
        };
        self.move_by(&step);
        for &place in places {
            // Avoids the rounding error of the sum.
            self.parameters[place].value = self.parameters[place].expected;
        }
        self.put_into_models();
        self
    }

    /// Changes the estimates, and shifts the evidence to them.
    fn move_by(&mut self, step: &DVector<f64>) {
        for (place, estimate) in self.parameters.iter_mut().enumerate() {
            estimate.value += step[place];
            estimate.sigma = self.covariance[(place, place)].max(0.0).sqrt();
        }
        let evidence = &mut self.evidence;
        let change = &evidence.information * step;
        evidence.square += step.dot(&change) - 2.0 * evidence.score.dot(step);
        evidence.score -= change;
    }

    fn put_into_models(&mut self) {
        for run in 0..self.models.len() {
            for place in 0..self.parameters.len() {
                if let Some(here) = self.in_run(&self.parameters[place], run) {
                    let value = here.sign * self.parameters[place].value;
                    self.models[run].terms[here.term].values[here.parameter] = value;
                }
            }
        }
    }
}
