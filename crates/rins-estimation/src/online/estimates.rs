//! The estimates by the samples so far, and the compensation with them.

use nalgebra::DMatrix;
use rins_frames::{Dcm, Increments, Table};
use rins_imu::Compensation;
use rins_terms::{FreeParameter, Model};

use super::filter::{OnlineFilter, Totals};
use super::setup::OnlineSetup;
use crate::estimate::Estimate;
use crate::identifiability::{Identifiability, Unknown};
use crate::step::SHOWN;
use crate::unobservable::at_prior_values;

/// A parameter is compensated if its 1σ is less than this part of that of its prior.
const IDENTIFIED: f64 = 0.5;

impl OnlineFilter {
    /// Sets the estimates and the compensation to the solution.
    pub(super) fn take_solution(&mut self) {
        let step = &self.solution.step;
        self.model.clone_from(&self.main.model);
        for (place, &(term, parameter)) in self.common.free.iter().enumerate() {
            self.model.terms[term].values[parameter] += step[place];
        }
        // The derivative by an attitude refers to a rotation after that attitude.
        if let Some(places) = self.attitude {
            let turn = |angles: [f64; 3]| Dcm::<Table, Table>::from_rotation_vector(&angles.into());
            let value = |place: usize| {
                let (term, parameter) = self.common.free[place];
                self.main.model.terms[term].values[parameter]
            };
            let turned = turn(places.map(value)) * turn(places.map(|place| step[place]));
            for (place, angle) in places.into_iter().zip(&turned.rotation_vector()) {
                let (term, parameter) = self.common.free[place];
                self.model.terms[term].values[parameter] = *angle;
            }
        }
        let mut identified = self.model.clone();
        for (place, &(term, parameter)) in self.common.free.iter().enumerate() {
            if !self.is_identified(place) {
                identified.terms[term].values[parameter] = self.common.expected[place];
            }
        }
        // Errors as large as the reading itself cannot be compensated: the last compensation stays.
        if let Ok(compensation) = identified.split().0.compensation() {
            self.compensation = compensation;
        }
    }

    /// Whether the samples so far determine a parameter: its 1σ is less than half that of its prior.
    ///
    /// # Panics
    /// If there is no such parameter.
    pub fn is_identified(&self, place: usize) -> bool {
        self.solution.sigmas[place] < IDENTIFIED * self.common.sigmas[place]
    }

    /// The increments corrected by the bias, scale and misalignment errors that are identified by the samples so far. The others keep
    /// the means of their priors.
    #[must_use]
    pub fn compensate(&self, increments: &Increments) -> Increments {
        self.compensation.compensate(increments)
    }

    /// The compensation of [`compensate`](Self::compensate).
    pub const fn compensation(&self) -> &Compensation {
        &self.compensation
    }

    /// The estimates, in the order of the model.
    pub fn estimates(&self) -> Vec<Estimate> {
        let estimate = |(place, parameter): (usize, &FreeParameter)| Estimate {
            parameter: parameter.clone(),
            run: None,
            expected: self.common.expected[place],
            value: self.model.terms[parameter.term].values[parameter.parameter],
            sigma: self.solution.sigmas[place],
        };
        self.parameters.iter().enumerate().map(estimate).collect()
    }

    /// Their covariance, in SI units.
    pub fn covariance(&self) -> DMatrix<f64> {
        let variances = || DMatrix::from_diagonal(&self.solution.sigmas.map(|sigma| sigma * sigma));
        // The last update had the same information.
        self.main.normal.covariance().unwrap_or_else(variances)
    }

    /// The observability of the parameters by the epochs so far.
    pub fn identifiability(&self) -> Identifiability {
        let unknown = |parameter: &FreeParameter| Unknown {
            id: parameter.id.clone(),
            model_id: self.model.id(parameter.term, parameter.parameter),
            run: None,
            unit: parameter.unit,
            sigma: parameter.sigma,
        };
        let mut information = self.main.normal.information.clone();
        information.fill_upper_triangle_with_lower_triangle();
        Identifiability::of(&information, self.parameters.iter().map(unknown).collect())
    }

    /// The estimates and their covariance with the parameters at `places` at the means of their priors, as
    /// [`Fit::with_prior_values_at`](crate::Fit::with_prior_values_at) gives them.
    ///
    /// # Panics
    /// If a place is not that of a parameter.
    pub fn with_prior_values_at(&self, places: &[usize]) -> (Vec<Estimate>, DMatrix<f64>) {
        let (mut estimates, mut covariance) = (self.estimates(), self.covariance());
        if let Some(step) = at_prior_values(&estimates, &mut covariance, places) {
            for (place, estimate) in estimates.iter_mut().enumerate() {
                estimate.value += step[place];
                estimate.sigma = covariance[(place, place)].max(0.0).sqrt();
            }
        }
        (estimates, covariance)
    }

    /// The model with the estimates as values.
    pub const fn model(&self) -> &Model {
        &self.model
    }

    /// The setup.
    pub const fn setup(&self) -> &OnlineSetup {
        &self.common.setup
    }

    /// The time of the last sample \[s\].
    pub const fn time(&self) -> Option<f64> {
        self.last
    }

    /// The number of samples taken, and of epochs processed.
    pub const fn counts(&self) -> (usize, usize) {
        (self.totals.samples, self.totals.epochs)
    }

    /// The mean squared whitened innovation at the estimate, which is 1 if the model describes the run; `None` before the first
    /// epoch.
    pub fn innovation_variance(&self) -> Option<f64> {
        let Totals { epochs, .. } = self.totals;
        let square = self.main.normal.square_at(&self.solution.step);
        (epochs > 0).then(|| square / (SHOWN * epochs) as f64)
    }
}
