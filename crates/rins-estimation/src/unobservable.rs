//! Parameters that the data do not show keep the values that were expected of them.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::estimate::Fit;
use crate::identifiability::Identifiability;

impl Identifiability {
    /// The places of the unobservable parameters: those of which the data tell less than twice what was known before, neither
    /// alone nor in a combination.
    pub fn unobservable(&self) -> Vec<usize> {
        let is_unobservable = |&place: &usize| {
            !self.parameters[place].identifiable && self.parameters[place].aliases.is_empty()
        };
        (0..self.parameters.len()).filter(is_unobservable).collect()
    }
}

impl Fit {
    /// The same with the parameters at `places` at their expected values, known to the priors' 1σ.
    ///
    /// What the data say beyond that of a parameter that they hardly show is mostly what noise and linearisation say. The other
    /// estimates are those that belong to these values: conditional means, with a covariance that holds the prior's
    /// uncertainty of the parameters at `places` (consider parameters; Schmidt 1966). The models have all these values; what is linear
    /// stays where it was.
    ///
    /// # Panics
    /// If a place is none of a parameter.
    #[must_use]
    pub fn with_prior_values_at(mut self, places: &[usize]) -> Self {
        if places.is_empty() {
            return self;
        }
        let others: Vec<usize> =
            (0..self.parameters.len()).filter(|place| !places.contains(place)).collect();
        let block = |rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |row, column| {
                self.covariance[(rows[row], columns[column])]
            })
        };
        // A covariance that was positive definite has such blocks.
        let Some(own) = Cholesky::new(block(places, places)) else { return self };
        let across = block(places, &others);
        // By how much the others move for each unit of these.
        let follow = own.solve(&across).transpose();
        let moved = DVector::from_iterator(
            places.len(),
            places
                .iter()
                .map(|&place| self.parameters[place].expected - self.parameters[place].value),
        );
        let prior = DMatrix::from_diagonal(&DVector::from_iterator(
            places.len(),
            places.iter().map(|&place| self.parameters[place].parameter.sigma.powi(2)),
        ));
        let shared = &follow * &prior;
        let rest = block(&others, &others) - &follow * &across + &shared * follow.transpose();
        let mut step = DVector::zeros(self.parameters.len());
        for (&place, by) in places.iter().zip(&moved) {
            step[place] = *by;
        }
        for (&place, by) in others.iter().zip(&(&follow * &moved)) {
            step[place] = *by;
        }
        for (row, &to_row) in places.iter().enumerate() {
            for (column, &to_column) in places.iter().enumerate() {
                self.covariance[(to_row, to_column)] = prior[(row, column)];
            }
        }
        for (row, &to_row) in others.iter().enumerate() {
            for (column, &to_column) in others.iter().enumerate() {
                self.covariance[(to_row, to_column)] = rest[(row, column)];
            }
            for (column, &to_column) in places.iter().enumerate() {
                self.covariance[(to_row, to_column)] = shared[(row, column)];
                self.covariance[(to_column, to_row)] = shared[(row, column)];
            }
        }
        self.move_by(&step);
        for &place in places {
            // The sum of an estimate and its way back is that but for rounding.
            self.parameters[place].value = self.parameters[place].expected;
        }
        self.put_into_models();
        self
    }

    /// Moves the estimates, and what the data say is about where they are.
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
