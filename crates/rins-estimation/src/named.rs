//! Estimates along other axes than those of the first run, under the sensors' own names.

use nalgebra::DMatrix;
use rins_frames::SignedAxes;
use rins_terms::TermInstance;

use crate::estimate::{Estimate, Fit};

/// The place of an estimate in the model of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InRun {
    /// The index of the term in the model.
    pub term: usize,
    /// The index of the parameter in that term.
    pub parameter: usize,
    /// The factor that converts the estimate to the model's value: 1 or -1.
    pub sign: f64,
}

impl Estimate {
    /// The same estimate along the sensors' own axes, if it is along those of a run with `axes`; `chosen` is its term.
    #[must_use]
    pub fn along_own(&self, chosen: &TermInstance, axes: &SignedAxes) -> Self {
        let mut own = self.clone();
        let (name, sign) = chosen.own(self.parameter.parameter, axes);
        if let Some((term, _)) = self.parameter.id.rsplit_once('.') {
            own.parameter.id = format!("{term}.{name}");
        }
        own.value *= sign;
        own.expected *= sign;
        own
    }
}

impl Fit {
    /// The place of an estimate in the model of a run, if the run has the parameter.
    ///
    /// # Panics
    /// If there is no such run.
    pub fn in_run(&self, estimate: &Estimate, run: usize) -> Option<InRun> {
        if estimate.run.is_some_and(|of| of != run) {
            return None;
        }
        let (model, axes) = (&self.models[run], self.run_axes[run].after(&self.axes.inverse()));
        let (term, parameter) = model.find_own(&estimate.parameter.id, &axes)?;
        let (_, sign) = model.terms[term].own(parameter, &axes);
        Some(InRun { term, parameter, sign })
    }

    /// The same fit with the parameters named, signed and ordered along other axes, which are given relative to the
    /// sensors' own axes: [`SignedAxes::IDENTITY`] means along the sensors' own axes.
    ///
    /// The models and the linearized runs keep the axes of their runs.
    #[must_use]
    pub fn along(mut self, axes: SignedAxes) -> Self {
        let renamed: Vec<(String, f64, usize)> =
            self.parameters.iter().map(|estimate| self.renamed(estimate, &axes)).collect();
        let mut order: Vec<usize> = (0..self.parameters.len()).collect();
        let parameters = &self.parameters;
        // The parameters of a term stay together; only their order within the term changes.
        let group = |place: &usize| (parameters[*place].run, parameters[*place].parameter.term);
        for block in order.chunk_by_mut(|a, b| group(a) == group(b)) {
            block.sort_by_key(|&place| renamed[place].2);
        }
        self.parameters = order
            .iter()
            .map(|&place| {
                let (mut estimate, (id, sign, _)) =
                    (self.parameters[place].clone(), &renamed[place]);
                estimate.parameter.id.clone_from(id);
                estimate.value *= sign;
                estimate.expected *= sign;
                estimate
            })
            .collect();
        let signed = |matrix: &DMatrix<f64>| {
            DMatrix::from_fn(order.len(), order.len(), |row, column| {
                let (row, column) = (order[row], order[column]);
                renamed[row].1 * renamed[column].1 * matrix[(row, column)]
            })
        };
        self.covariance = signed(&self.covariance);
        self.evidence.information = signed(&self.evidence.information);
        let score = order.iter().map(|&place| renamed[place].1 * self.evidence.score[place]);
        self.evidence.score = nalgebra::DVector::from_iterator(order.len(), score);
        self.axes = axes;
        self
    }

    /// The id of an estimate along other axes, the factor that converts its value to them, and its rank among the
    /// parameters of its term there.
    fn renamed(&self, estimate: &Estimate, axes: &SignedAxes) -> (String, f64, usize) {
        let mut runs = 0..self.models.len();
        let found = runs.find_map(|run| Some((run, self.in_run(estimate, run)?)));
        let (run, InRun { term, parameter, sign }) =
            found.expect("every estimate is of a run's model");
        let to_run = self.run_axes[run].after(&axes.inverse());
        let chosen = &self.models[run].terms[term];
        let (_, own_sign) = chosen.own(parameter, &to_run);
        let order = chosen.term.own_order(&to_run);
        let rank = order.iter().position(|place| *place == parameter).unwrap_or(parameter);
        (self.models[run].own_id(term, parameter, &to_run), sign * own_sign, rank)
    }
}
