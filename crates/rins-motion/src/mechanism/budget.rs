//! The effect of each approximation of eqs. (6) to (9).

use super::closed_form::{ClosedForm, Sign};
use super::errors::{ConstantTurn, NavErrors, SensorErrors, SpinAxisErrors};
use super::flat::flat_navigation;
use super::linear::{LinearModel, Term, Terms};
use crate::strapdown::VerticalChannel;

/// The effects that eqs. (6) to (9) neglect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Neglected {
    /// The Earth's rate, in the rotation of the level and in the output of the gyros (eq. (3)).
    EarthRate,
    /// The transport rate, and with it the Schuler loop.
    TransportRate,
    /// The Coriolis acceleration (eq. (7)).
    Coriolis,
    /// All products of errors: mainly those of `S_z ω t` with itself and with the misalignments.
    SecondOrder,
}

impl Neglected {
    /// All four.
    pub const ALL: [Self; 4] =
        [Self::EarthRate, Self::TransportRate, Self::Coriolis, Self::SecondOrder];
}

/// The effect of neglecting this alone on the errors after `time` \[s\]: without it, minus with it.
///
/// The first three are differences of [`LinearModel`] from the full model; the fourth refers to a flat Earth that does not
/// rotate. Their sum is not exactly the effect of neglecting all of them, because they interact. The vertical channel is
/// held.
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
