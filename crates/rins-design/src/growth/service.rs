//! A system in service, and its navigation errors after some time.

use nalgebra::{Const, DMatrix, Dyn, Matrix2, OMatrix, SMatrix};
use rins_motion::Segment;
use rins_terms::{Model, Surroundings};

/// The number of states: three of the attitude, two of the velocity, two of the position.
pub const GROWTH_STATES: usize = 7;

/// The place of the position error north \[m\] among the states; that east is the next one.
pub(super) const NORTH: usize = 5;

pub(super) type Square = SMatrix<f64, GROWTH_STATES, GROWTH_STATES>;

/// A column of states for each parameter.
pub(super) type Columns = OMatrix<f64, Const<GROWTH_STATES>, Dyn>;

/// A system in service: where it is, how its table turns, and the errors that it has.
#[derive(Clone, Copy, Debug)]
pub struct Service<'a> {
    /// The site, and the attitude of the axis frame.
    pub surroundings: Surroundings,
    /// The motion of the table, which repeats: rates, each reached at once, and how long they last.
    pub cycle: &'a [Segment],
    /// The error model, at the values about which it is linear.
    pub model: &'a Model,
    /// The parameters of it whose errors grow, as term and place within it.
    pub parameters: &'a [(usize, usize)],
    /// The white noise of gyros \[rad/√s\] and accelerometers \[m/s/√s\].
    pub noise: [f64; 2],
}

/// The navigation errors after some time in service.
///
/// States are in the order `φ` east, north, up \[rad\], `δv` east, north \[m/s\], `δr` north, east \[m\].
#[derive(Clone, Debug, PartialEq)]
pub struct Growth {
    /// The time since the start \[s\].
    pub time: f64,
    /// The states per unit of each parameter, 7 × n, in SI units.
    pub by_parameter: OMatrix<f64, Const<GROWTH_STATES>, Dyn>,
    /// The states per unit of each state at the start.
    pub by_start: Square,
    /// The covariance of the states by the white noise.
    pub by_noise: Square,
}

impl Growth {
    /// The position error east and north \[m\] by errors of the parameters \[SI units\], from an exact start.
    ///
    /// # Panics
    /// If there is not one error for each parameter.
    pub fn position(&self, errors: &[f64]) -> [f64; 2] {
        assert_eq!(errors.len(), self.by_parameter.ncols(), "an error for each parameter");
        let of = |state: usize| {
            self.by_parameter.row(state).iter().zip(errors).map(|(by, error)| by * error).sum()
        };
        [of(NORTH + 1), of(NORTH)]
    }

    /// The covariance of the states (7 × 7), given those of the parameters (n × n) and of the states at the start, in SI units.
    ///
    /// # Panics
    /// If the covariance is not of the parameters.
    pub fn covariance(&self, parameters: &DMatrix<f64>, start: &Square) -> Square {
        let of_parameters = &self.by_parameter * parameters * self.by_parameter.transpose();
        let of_start = self.by_start * start * self.by_start.transpose();
        of_start + self.by_noise + of_parameters
    }

    /// The covariance of the position error north and east \[m²\] in a covariance of the states.
    pub fn of_position(covariance: &Square) -> Matrix2<f64> {
        covariance.fixed_view::<2, 2>(NORTH, NORTH).into_owned()
    }

    /// The root mean square of the radial position error \[m\] for a covariance of the states.
    pub fn radial(covariance: &Square) -> f64 {
        Self::of_position(covariance).trace().max(0.0).sqrt()
    }
}
