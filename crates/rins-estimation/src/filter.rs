//! The sequential solution: a filter whose states are navigation and the parameters.
//!
//! The covariance is stored in blocks. The parameters are constant, so that the prediction changes only the rows of
//! navigation.

use nalgebra::{Cholesky, DMatrix, DVector, SMatrix, SVector};

use crate::epoch::Epoch;
use crate::evidence::Indefinite;
use crate::gains::ROWS;
use crate::linear::Linear;
use crate::noise_parameters::Noise;
use crate::space::Space;
use crate::step::{CARRIED_OF, NAVIGATION, SHOWN, SHOWN_OF, Step};

/// An error-state filter over the epochs of a linearized run, with the parameters as augmented states.
///
/// Its final estimate is the batch solution of the same model: each verifies the other.
pub struct Filter<'a> {
    space: Space,
    linear: &'a Linear,
    epoch: usize,
    state: DVector<f64>,
    parameters: DVector<f64>,
    /// The covariances of the states, of the states with the parameters, and of the parameters.
    states: DMatrix<f64>,
    across: DMatrix<f64>,
    covariance: DMatrix<f64>,
}

impl std::fmt::Debug for Filter<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Filter").field("epoch", &self.epoch).finish_non_exhaustive()
    }
}

impl<'a> Filter<'a> {
    /// A filter before the first epoch. `expected` and `sigmas` are the means of the priors, relative to the point of
    /// linearization, and their sigmas.
    ///
    /// # Panics
    /// If there is not one of each for every parameter.
    pub fn new(linear: &'a Linear, noise: &Noise, sigmas: &[f64], expected: &[f64]) -> Self {
        assert_eq!(sigmas.len(), linear.parameters, "a sigma for each parameter");
        assert_eq!(expected.len(), linear.parameters, "an expected value for each parameter");
        let space = Space::new(linear, noise);
        let n = space.states();
        Self {
            states: space.start(),
            space,
            linear,
            epoch: 0,
            state: DVector::zeros(n),
            parameters: DVector::from_column_slice(expected),
            across: DMatrix::zeros(n, sigmas.len()),
            covariance: DMatrix::from_fn(sigmas.len(), sigmas.len(), |row, column| {
                if row == column { sigmas[row] * sigmas[row] } else { 0.0 }
            }),
        }
    }

    /// The parameters relative to the point of linearization.
    pub const fn parameters(&self) -> &DVector<f64> {
        &self.parameters
    }

    /// Their covariance.
    pub const fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    /// Processes the next epoch that is not excluded. The result is its whitened innovation, or `None` after the last epoch.
    ///
    /// # Errors
    /// [`Indefinite`] if the innovation covariance is not positive definite; the filter must not be used further.
    pub fn step(&mut self) -> Result<Option<SVector<f64, SHOWN>>, Indefinite> {
        while let Some(epoch) = self.linear.epochs.get(self.epoch).filter(|epoch| epoch.left_out) {
            self.pass_over(&self.space.step(epoch));
            self.epoch += 1;
        }
        let Some(epoch) = self.linear.epochs.get(self.epoch) else { return Ok(None) };
        let inputs = inputs(epoch, self.linear.parameters);
        if self.linear.starts_anew(self.epoch) {
            self.start(&inputs);
        }
        let step = self.space.step(epoch);
        let innovation = self.go(&step, &inputs).ok_or(Indefinite { epoch: self.epoch })?;
        self.epoch += 1;
        Ok(Some(innovation))
    }

    /// Propagates the colored noise over an excluded epoch; navigation starts again afterwards.
    fn pass_over(&mut self, step: &Step) {
        for (place, &decay) in step.decay.iter().enumerate().skip(NAVIGATION) {
            self.state[place] *= decay;
            self.across.row_mut(place).scale_mut(decay);
            for (other, &other_decay) in step.decay.iter().enumerate().skip(NAVIGATION) {
                self.states[(other, place)] *= decay * other_decay;
            }
            self.states[(place, place)] += step.colour_noise[place];
        }
    }

    /// Initializes attitude and velocity from the epoch's readings, including their dependence on the parameters.
    fn start(&mut self, inputs: &Inputs) {
        let mut start = DMatrix::zeros(NAVIGATION, inputs.ncols());
        start.rows_mut(0, 3).copy_from(&-inputs.rows(6, 3));
        if !self.linear.shows_angle() {
            start.row_mut(2).fill(0.0);
        }
        let by_parameters = start.columns(1, self.parameters.len());
        self.space.forget_navigation(&mut self.states);
        let state = start.column(0) + by_parameters * &self.parameters;
        self.state.rows_mut(0, NAVIGATION).copy_from(&state);
        // Colored noise and parameters are correlated after a gap.
        let with_colours = by_parameters * self.across.transpose();
        for column in NAVIGATION..self.states.ncols() {
            for row in 0..NAVIGATION {
                self.states[(row, column)] = with_colours[(row, column)];
                self.states[(column, row)] = with_colours[(row, column)];
            }
        }
        let across = by_parameters * &self.covariance;
        let mut corner = self.states.view_mut((0, 0), (NAVIGATION, NAVIGATION));
        corner += &across * by_parameters.transpose();
        self.across.rows_mut(0, NAVIGATION).copy_from(&across);
    }

    fn go(&mut self, step: &Step, inputs: &Inputs) -> Option<SVector<f64, SHOWN>> {
        let (n, p) = (self.state.len(), self.parameters.len());
        // Linear functions of the states: the propagated navigation states, the measurement, and the parameters'
        // contributions to both.
        let following = step.following(n);
        let (carry, shown) = (following.select_rows(&CARRIED_OF), following.select_rows(&SHOWN_OF));
        let input = inputs.view((0, 1), (NAVIGATION, p));
        let mut shown_inputs = inputs.select_rows(&[6, 7, 8, 3, 4, 5]);
        if !self.linear.shows_angle() {
            shown_inputs.row_mut(2).fill(0.0);
        }
        let shown_input = shown_inputs.columns(1, p);
        let offset = shown_inputs.column(0);
        // Covariances of the measurement with states and parameters, and of the propagated navigation states.
        let shown_states = &shown * &self.states + shown_input * self.across.transpose();
        let shown_parameters = &shown * &self.across + shown_input * &self.covariance;
        let carried_states = &carry * &self.states + input * self.across.transpose();
        let carried_parameters = &carry * &self.across + input * &self.covariance;

        let s = &shown_states * shown.transpose() + &shown_parameters * shown_input.transpose();
        let s = SMatrix::<f64, SHOWN, SHOWN>::from_iterator(s.iter().copied()) + step.shown;
        let l = Cholesky::new((s + s.transpose()) * 0.5)?.l();
        let mut innovation = -(&shown * &self.state + shown_input * &self.parameters + offset);
        l.solve_lower_triangular_mut(&mut innovation);

        let mut gain = DMatrix::zeros(SHOWN, n);
        let of_carried =
            &shown * carried_states.transpose() + shown_input * carried_parameters.transpose();
        gain.columns_mut(0, NAVIGATION).copy_from(&of_carried);
        for (place, decay) in step.decay.iter().enumerate().skip(NAVIGATION) {
            gain.set_column(place, &(shown_states.column(place) * *decay));
        }
        gain += step.cross.transpose();
        l.solve_lower_triangular_mut(&mut gain);
        let mut gain_parameters = shown_parameters;
        l.solve_lower_triangular_mut(&mut gain_parameters);

        let carried =
            &carry * &self.state + input * &self.parameters + inputs.view((0, 0), (NAVIGATION, 1));
        self.state.rows_mut(0, NAVIGATION).copy_from(&carried);
        let corner = &carried_states * carry.transpose() + &carried_parameters * input.transpose();
        for (place, &decay) in step.decay.iter().enumerate().skip(NAVIGATION) {
            self.state[place] *= decay;
            self.across.row_mut(place).scale_mut(decay);
            for (other, &other_decay) in step.decay.iter().enumerate().skip(NAVIGATION) {
                self.states[(other, place)] *= decay * other_decay;
            }
            self.states[(place, place)] += step.colour_noise[place];
            for row in 0..NAVIGATION {
                let value = carried_states[(row, place)] * decay + step.noise[(place, row)];
                self.states[(row, place)] = value;
                self.states[(place, row)] = value;
            }
        }
        let noise = step.noise.rows(0, NAVIGATION);
        let corner = (&corner + corner.transpose()) * 0.5 + noise;
        self.states.view_mut((0, 0), (NAVIGATION, NAVIGATION)).copy_from(&corner);
        self.across.rows_mut(0, NAVIGATION).copy_from(&carried_parameters);

        self.state += gain.transpose() * &innovation;
        self.parameters += gain_parameters.transpose() * &innovation;
        self.states -= gain.transpose() * &gain;
        self.across -= gain.transpose() * &gain_parameters;
        self.covariance -= gain_parameters.transpose() * &gain_parameters;
        Some(SVector::from_iterator(innovation.iter().copied()))
    }
}

/// The gains of the columns in an epoch, a row for each gain.
type Inputs = DMatrix<f64>;

fn inputs(epoch: &Epoch, parameters: usize) -> Inputs {
    let columns: Vec<_> = (0..=parameters).map(|column| epoch.gains.column(column)).collect();
    DMatrix::from_fn(ROWS, columns.len(), |row, column| columns[column][row])
}
