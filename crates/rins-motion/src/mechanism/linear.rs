//! The linear error model on the round, rotating Earth, propagated exactly in time.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use rins_frames::{Body, Dcm, InFrame, Rates, Site, Table};

use super::errors::{ConstantTurn, NavErrors, SensorErrors};
use crate::strapdown::VerticalChannel;

/// Attitude, velocity, latitude, longitude, height.
const STATES: usize = 9;
const ATTITUDE: usize = 0;
const VELOCITY: usize = 3;
const VERTICAL: usize = VELOCITY + 2;
const LATITUDE: usize = 6;
const LONGITUDE: usize = 7;
const HEIGHT: usize = 8;

/// 1, cos ζ, sin ζ, cos 2ζ, sin 2ζ: a product of two rotations by the table angle has no higher harmonics.
const HARMONICS: usize = 5;

const AUGMENTED: usize = STATES + HARMONICS;

type State = SVector<f64, STATES>;

/// The optional parts of the model, whose effects can be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Terms {
    /// The Earth's rate: in the rotation of the level, and in the output of the gyros.
    pub earth_rate: Term,
    /// The rotation of the level due to the velocity over the Earth, which closes the Schuler loop.
    pub transport_rate: Term,
    /// The Coriolis acceleration.
    pub coriolis: Term,
}

/// Whether the model includes a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Term {
    /// It is included.
    Kept,
    /// It is neglected.
    Neglected,
}

impl Terms {
    /// The full model.
    pub const ALL: Self =
        Self { earth_rate: Term::Kept, transport_rate: Term::Kept, coriolis: Term::Kept };

    /// A flat Earth that does not rotate: the model of eqs. (6) to (9).
    pub const NONE: Self = Self {
        earth_rate: Term::Neglected,
        transport_rate: Term::Neglected,
        coriolis: Term::Neglected,
    };
}

/// The linear errors of a navigator on a table with a constant rate.
///
/// The equations are `φ' = -ω_in × φ + δω_in - C_b^n δω_ib^b` and `δv' = f^n × φ + C_b^n δf^b - 2 ω_ie × δv + δg` about a
/// true state at rest, with constant biases and matrix errors of both triads (eqs. (1), (7), (12), (13); (13) with the sign
/// `+(ρ + 2Ω)_x δv_z` of its vertical coupling). In n all coefficients are constant, and constant sensor errors cause only
/// the harmonics 0, 1 and 2 of the table angle. With these as additional states the model is time-invariant, and one matrix
/// exponential propagates it exactly over any time.
#[derive(Clone, Copy, Debug)]
pub struct LinearModel {
    turn: ConstantTurn,
    vertical: VerticalChannel,
    terms: Terms,
}

impl LinearModel {
    /// The full model.
    pub fn new(turn: ConstantTurn, vertical: VerticalChannel) -> Self {
        Self::with_terms(turn, vertical, Terms::ALL)
    }

    /// The model with a selection of its parts.
    pub fn with_terms(turn: ConstantTurn, vertical: VerticalChannel, terms: Terms) -> Self {
        Self { turn, vertical, terms }
    }

    /// The errors after `time` \[s\] for these initial errors and sensor errors.
    pub fn propagate(&self, initial: &NavErrors, sensors: &SensorErrors, time: f64) -> NavErrors {
        let mut rates = SMatrix::<f64, AUGMENTED, AUGMENTED>::zeros();
        rates.fixed_view_mut::<STATES, STATES>(0, 0).copy_from(&self.dynamics());
        rates.fixed_view_mut::<STATES, HARMONICS>(0, STATES).copy_from(&self.driven(sensors));
        for harmonic in [1, 2] {
            let cos = STATES + 2 * harmonic - 1;
            let rate = self.turn.rate * harmonic as f64;
            rates[(cos, cos + 1)] = -rate;
            rates[(cos + 1, cos)] = rate;
        }
        let mut start = SVector::<f64, AUGMENTED>::zeros();
        start.fixed_rows_mut::<STATES>(0).copy_from(&to_state(initial));
        start.fixed_rows_mut::<HARMONICS>(STATES).copy_from(&harmonics(0.0));
        let units = self.units();
        let rates = SMatrix::<f64, AUGMENTED, AUGMENTED>::from_fn(|row, column| {
            rates[(row, column)] * units[column] / units[row]
        });
        let end = (rates * time).exp() * start.component_div(&units);
        let end = end.component_mul(&units);
        from_state(&end.fixed_rows::<STATES>(0).into_owned())
    }

    /// Units of the states in which all rates have similar magnitude: the Earth's radius, and the velocity that g causes in
    /// the time in which a Schuler pendulum turns by one radian.
    ///
    /// In meters a matrix exponential loses eight digits of an attitude relative to a height.
    fn units(&self) -> SVector<f64, AUGMENTED> {
        let site = self.turn.station.site;
        let radius = site.meridian_radius();
        let mut units = SVector::<f64, AUGMENTED>::repeat(1.0);
        units.fixed_rows_mut::<3>(VELOCITY).fill((site.normal_gravity() * radius).sqrt());
        units[HEIGHT] = radius;
        units
    }

    /// The dynamics of the errors without sensor errors.
    fn dynamics(&self) -> SMatrix<f64, STATES, STATES> {
        let site = &self.turn.station.site;
        let (sin, cos) = site.latitude.sin_cos();
        let by_east = 1.0 / (site.transverse_radius() + site.height);
        let by_north = 1.0 / (site.meridian_radius() + site.height);
        let mut f = SMatrix::<f64, STATES, STATES>::zeros();
        let mut add = |row: usize, column: usize, block: &Matrix3<f64>| {
            let mut view = f.fixed_view_mut::<3, 3>(row, column);
            view += block;
        };

        let earth_rate = site.earth_rate();
        add(VELOCITY, ATTITUDE, &(-self.turn.station.gravity_vector()).cross_matrix());
        if self.terms.earth_rate == Term::Kept {
            add(ATTITUDE, ATTITUDE, &-earth_rate.cross_matrix());
        }
        if self.terms.coriolis == Term::Kept {
            add(VELOCITY, VELOCITY, &(earth_rate * -2.0).cross_matrix());
        }
        if self.terms.transport_rate == Term::Kept {
            let transport_rate =
                Matrix3::new(0.0, -by_north, 0.0, by_east, 0.0, 0.0, by_east * sin / cos, 0.0, 0.0);
            add(ATTITUDE, VELOCITY, &transport_rate);
        }
        if self.terms.earth_rate == Term::Kept {
            // ω_ie = Ω (0, cos L, sin L) at the computed latitude.
            f[(ATTITUDE + 1, LATITUDE)] = -earth_rate.components().z;
            f[(ATTITUDE + 2, LATITUDE)] = earth_rate.components().y;
        }
        f[(LATITUDE, VELOCITY + 1)] = by_north;
        f[(LONGITUDE, VELOCITY)] = by_east / cos;
        f[(HEIGHT, VERTICAL)] = 1.0;
        let (by_latitude, by_height) = gravity_slopes(site);
        f[(VERTICAL, LATITUDE)] = -by_latitude;
        f[(VERTICAL, HEIGHT)] = -by_height;
        if self.vertical == VerticalChannel::Held {
            f.row_mut(VERTICAL).fill(0.0);
            f.row_mut(HEIGHT).fill(0.0);
        }
        f
    }

    /// The contributions of the sensor errors to the rates, by harmonics of the table angle.
    ///
    /// A trigonometric polynomial of second degree is determined by five values: here at equidistant angles, where the
    /// harmonics are orthogonal.
    fn driven(&self, sensors: &SensorErrors) -> SMatrix<f64, STATES, HARMONICS> {
        const NODES: usize = 5;
        let mut by_harmonic = SMatrix::<f64, STATES, HARMONICS>::zeros();
        for node in 0..NODES {
            let angle = std::f64::consts::TAU * node as f64 / NODES as f64;
            let mut weights = harmonics(angle) * 2.0;
            weights[0] = 1.0;
            by_harmonic += self.driven_at(sensors, angle) * weights.transpose() / NODES as f64;
        }
        by_harmonic
    }

    /// The contributions of the sensor errors to the rates at one table angle.
    fn driven_at(&self, sensors: &SensorErrors, angle: f64) -> State {
        let table_from_body = Dcm::<Table, Body>::about_z(angle);
        let nav_from_body = self.turn.nav_from_table * table_from_body;
        let body_from_nav = nav_from_body.inverse();
        let spin = InFrame::new(0.0, 0.0, self.turn.rate);
        let earth_rate = match self.terms.earth_rate {
            Term::Kept => body_from_nav * self.turn.station.site.earth_rate(),
            Term::Neglected => InFrame::zeros(),
        };
        let truth = Rates {
            angular_rate: spin + earth_rate,
            specific_force: body_from_nav * -self.turn.station.gravity_vector(),
        };
        let error = sensors.of(&truth);
        let mut driven = State::zeros();
        let attitude = -(nav_from_body * error.angular_rate);
        let velocity = nav_from_body * error.specific_force;
        driven.fixed_rows_mut::<3>(ATTITUDE).copy_from(attitude.components());
        driven.fixed_rows_mut::<3>(VELOCITY).copy_from(velocity.components());
        if self.vertical == VerticalChannel::Held {
            driven[VERTICAL] = 0.0;
        }
        driven
    }
}

fn harmonics(angle: f64) -> SVector<f64, HARMONICS> {
    let ((sin, cos), (sin_2, cos_2)) = (angle.sin_cos(), (2.0 * angle).sin_cos());
    SVector::from([1.0, cos, sin, cos_2, sin_2])
}

fn to_state(errors: &NavErrors) -> State {
    let mut state = State::zeros();
    state.fixed_rows_mut::<3>(ATTITUDE).copy_from(errors.attitude.components());
    state.fixed_rows_mut::<3>(VELOCITY).copy_from(errors.velocity.components());
    state[LATITUDE] = errors.latitude;
    state[LONGITUDE] = errors.longitude;
    state[HEIGHT] = errors.height;
    state
}

fn from_state(state: &State) -> NavErrors {
    let vector = |first: usize| Vector3::new(state[first], state[first + 1], state[first + 2]);
    NavErrors {
        attitude: InFrame::from_components(vector(ATTITUDE)),
        velocity: InFrame::from_components(vector(VELOCITY)),
        latitude: state[LATITUDE],
        longitude: state[LONGITUDE],
        height: state[HEIGHT],
    }
}

/// The derivatives of normal gravity by latitude \[m/s²/rad\] and by height \[1/s²\].
fn gravity_slopes(site: &Site) -> (f64, f64) {
    // Central differences: their error is of third order, 1e-10 of the derivative, and rounding.
    const LATITUDE_STEP: f64 = 1e-5;
    const HEIGHT_STEP: f64 = 60.0;
    let gravity = |north: f64, up: f64| {
        Site { latitude: site.latitude + north, height: site.height + up, ..*site }.normal_gravity()
    };
    let (dl, dh) = (LATITUDE_STEP, HEIGHT_STEP);
    (
        (gravity(dl, 0.0) - gravity(-dl, 0.0)) / (2.0 * dl),
        (gravity(0.0, dh) - gravity(0.0, -dh)) / (2.0 * dh),
    )
}
