//! What each approximation behind eqs. (6) to (9) costs.

use super::closed_form::{ClosedForm, Sign};
use super::errors::{ConstantTurn, NavErrors, SensorErrors, SpinAxisErrors};
use super::flat::flat_navigation;
use super::linear::{LinearModel, Term, Terms};
use crate::strapdown::VerticalChannel;

/// What eqs. (6) to (9) leave out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Neglected {
    /// The Earth's rate, in the turn of the level and in what the gyros measure (eq. (3)).
    EarthRate,
    /// The transport rate, and with it the Schuler loop.
    TransportRate,
    /// The Coriolis acceleration (eq. (7)).
    Coriolis,
    /// All products of errors: above all that of `S_z ω t` with itself and with the misalignments.
    SecondOrder,
}

impl Neglected {
    /// All four.
    pub const ALL: [Self; 4] =
        [Self::EarthRate, Self::TransportRate, Self::Coriolis, Self::SecondOrder];
}

/// How far the errors after `time` \[s\] are off for leaving this out alone: without it, minus with it.
///
/// The first three are measured by [`LinearModel`] against the whole of it, the fourth on a flat
/// Earth that does not turn. Their sum is not quite what leaving out all of them costs, since
/// each also changes what the others act on. The vertical channel is held.
pub fn cost(
    neglected: Neglected,
    turn: &ConstantTurn,
    errors: &SpinAxisErrors,
    time: f64,
) -> NavErrors {
    let none = NavErrors::none();
    let linear = |terms| {
        LinearModel::with_terms(*turn, VerticalChannel::Held, terms).propagate(
            &none,
            &SensorErrors::from(*errors),
            time,
        )
    };
    let without = match neglected {
        Neglected::EarthRate => Terms { earth_rate: Term::Neglected, ..Terms::ALL },
        Neglected::TransportRate => Terms { transport_rate: Term::Neglected, ..Terms::ALL },
        Neglected::Coriolis => Terms { coriolis: Term::Neglected, ..Terms::ALL },
        Neglected::SecondOrder => {
            let form = ClosedForm::new(*turn, *errors, Sign::Strapdown);
            let first_order = NavErrors {
                attitude: form.attitude_error(time),
                velocity: form.velocity_error(time).total(),
                ..none
            };
            return first_order - flat_navigation(turn, errors, &none, time);
        }
    };
    linear(without) - linear(Terms::ALL)
}
