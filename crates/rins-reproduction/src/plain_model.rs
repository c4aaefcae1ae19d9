//! A strapdown model independent of the navigator, with variants of single modeling choices.
//!
//! It integrates the differential equations of attitude, velocity and latitude by the Runge-Kutta
//! method, from closed forms of rates and forces: without increments, coning and sculling.

use nalgebra::{Matrix3, Vector2, Vector3};
use rins_frames::{EARTH_RATE, Site, cross_matrix};
use rins_motion::mechanism::{ConstantTurn, SpinAxisErrors};

/// A modeling choice in which models of the paper's run may differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Choice {
    /// As in the navigator: the WGS84 ellipsoid at the station, with position-dependent gravity.
    Ellipsoid,
    /// The height above the ellipsoid is zero.
    NoHeight,
    /// Gravity is 9.8 m/s².
    RoundGravity,
    /// The Earth is a sphere of 6371 km.
    Sphere,
    /// The radii, gravity and the Earth rate do not change with the computed latitude.
    FixedLatitude,
    /// The local level does not rotate about the vertical with the transport rate: wander azimuth.
    WanderAzimuth,
    /// The errors multiply the table rate only, without the Earth rate: eq. (3).
    TableRateAlone,
    /// The errors multiply the measured rate.
    MeasuredRate,
    /// Euler's method with steps of 20 ms for all three, minus its result for perfect sensors.
    Euler,
    /// The rotation of the level is omitted from the gyros' rates: no transport rate.
    NoTransportRate,
}

impl Choice {
    /// The choices that differ from the navigator's.
    pub(crate) const OTHERS: [Self; 9] = [
        Self::NoHeight,
        Self::RoundGravity,
        Self::Sphere,
        Self::FixedLatitude,
        Self::WanderAzimuth,
        Self::TableRateAlone,
        Self::MeasuredRate,
        Self::NoTransportRate,
        Self::Euler,
    ];

    /// Its name, in the words of a list.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Ellipsoid => "as the navigator has it",
            Self::NoHeight => "height 0 in place of 400 m",
            Self::RoundGravity => "gravity 9.8 m/s²",
            Self::Sphere => "a spherical Earth of 6371 km",
            Self::FixedLatitude => "Earth's rate and gravity of the start all the time",
            Self::WanderAzimuth => "a wander-azimuth level",
            Self::TableRateAlone => "errors multiply the table's rate alone, eq. (3)",
            Self::MeasuredRate => "errors multiply the measured rate",
            Self::Euler => "first-order integration at 50 Hz",
            Self::NoTransportRate => "no transport rate, and so no Schuler loop",
        }
    }
}

/// The interval of the integration \[s\].
const INTERVAL: f64 = 0.02;

/// The integrated state: `C_b^n`, the velocity east and north, the latitude.
#[derive(Clone, Copy)]
struct State {
    c_nb: Matrix3<f64>,
    velocity: Vector2<f64>,
    latitude: f64,
}

impl State {
    fn moved(&self, rate: &Self, interval: f64) -> Self {
        Self {
            c_nb: self.c_nb + rate.c_nb * interval,
            velocity: self.velocity + rate.velocity * interval,
            latitude: self.latitude + rate.latitude * interval,
        }
    }
}

struct Model {
    turn: ConstantTurn,
    /// The third column of the gyros' matrix.
    errors: Vector3<f64>,
    choice: Choice,
}

/// The velocity east and north after `time` \[m/s\], from zero velocity and the true attitude.
pub(crate) fn velocity(
    turn: &ConstantTurn,
    errors: &SpinAxisErrors,
    choice: Choice,
    time: f64,
) -> Vector2<f64> {
    let SpinAxisErrors { misalignment_xz, misalignment_yz, scale_z } = *errors;
    let errors = Vector3::new(misalignment_xz, misalignment_yz, scale_z);
    let mut turn = *turn;
    if choice == Choice::NoHeight {
        let site = Site { height: 0.0, ..turn.station.site };
        turn.station = rins_motion::Station::with_normal_gravity(site);
    }
    if choice == Choice::RoundGravity {
        turn.station.gravity = 9.8;
    }
    let run = |errors| Model { turn, errors, choice }.integrated(time);
    match choice {
        Choice::Euler => run(errors) - run(Vector3::zeros()),
        _ => run(errors),
    }
}

impl Model {
    fn integrated(&self, time: f64) -> Vector2<f64> {
        let mut state = State {
            c_nb: *self.turn.nav_from_body(0.0).matrix(),
            velocity: Vector2::zeros(),
            latitude: self.turn.station.site.latitude,
        };
        let steps = (time / INTERVAL).round();
        let mut step = 0.0;
        while step < steps {
            let now = step * INTERVAL;
            state = match self.choice {
                Choice::Euler => state.moved(&self.rates(&state, now), INTERVAL),
                _ => self.runge_kutta(&state, now),
            };
            // A step of Newton's iteration to the nearest rotation: the integration preserves orthonormality only to its order.
            let c = state.c_nb;
            state.c_nb = c * 1.5 - c * c.transpose() * c * 0.5;
            step += 1.0;
        }
        state.velocity
    }

    fn runge_kutta(&self, state: &State, now: f64) -> State {
        let half = 0.5 * INTERVAL;
        let one = self.rates(state, now);
        let two = self.rates(&state.moved(&one, half), now + half);
        let three = self.rates(&state.moved(&two, half), now + half);
        let four = self.rates(&state.moved(&three, INTERVAL), now + INTERVAL);
        state
            .moved(&one, INTERVAL / 6.0)
            .moved(&two, INTERVAL / 3.0)
            .moved(&three, INTERVAL / 3.0)
            .moved(&four, INTERVAL / 6.0)
    }

    /// `C' = C [ω_ib^b ×] - [ω_in^n ×] C`, `v' = C f^b - (2 ω_ie + ω_en) × v + g`, `L' = v_N / (R_M + h)`.
    fn rates(&self, state: &State, now: f64) -> State {
        let station = self.turn.station;
        let home = station.site;
        let place = match self.choice {
            Choice::FixedLatitude => home,
            _ => Site { latitude: state.latitude, ..home },
        };
        let (along, across) = match self.choice {
            Choice::Sphere => (6.371e6, 6.371e6),
            _ => (place.meridian_radius() + place.height, place.transverse_radius() + place.height),
        };
        let [east, north] = [state.velocity.x, state.velocity.y];
        let (sin, cos) = place.latitude.sin_cos();
        let earth_rate = Vector3::new(0.0, EARTH_RATE * cos, EARTH_RATE * sin);
        let azimuth_rate = match self.choice {
            Choice::WanderAzimuth => 0.0,
            _ => east * sin / cos / across,
        };
        let transport = match self.choice {
            Choice::NoTransportRate => Vector3::zeros(),
            _ => Vector3::new(-north / along, east / across, azimuth_rate),
        };
        // The true position is constant.
        let c_bn = self.turn.nav_from_body(now).matrix().transpose();
        let spin = Vector3::z() * self.turn.rate;
        let true_rate = c_bn * home.earth_rate().components() + spin;
        let seen = match self.choice {
            Choice::TableRateAlone => self.turn.rate,
            // x~ = x + E x~ along z: the measured rate is the true one over 1 - S.
            Choice::MeasuredRate => true_rate.z / (1.0 - self.errors.z),
            _ => true_rate.z,
        };
        let measured = true_rate + self.errors * seen;
        let force = c_bn * Vector3::z() * station.gravity;
        let gravity = station.gravity * place.normal_gravity() / home.normal_gravity();

        let velocity = Vector3::new(east, north, 0.0);
        let coriolis = (earth_rate * 2.0 + transport).cross(&velocity);
        let acceleration = state.c_nb * force - coriolis - Vector3::z() * gravity;
        State {
            c_nb: state.c_nb * cross_matrix(&measured)
                - cross_matrix(&(earth_rate + transport)) * state.c_nb,
            velocity: acceleration.xy(),
            latitude: north / along,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{ERRORS, grid, turn};
    use rins_testing::assert_close;

    #[test]
    fn it_agrees_with_the_navigator() {
        let navigated =
            grid(&[90.0], &[[30.0, 20.0, 40.0]], &[10.0]).unwrap()[0].navigated.velocity;
        let plain = velocity(&turn([30.0, 20.0, 40.0], 10.0), &ERRORS, Choice::Ellipsoid, 90.0);
        // The error of the Runge-Kutta method for a rotation of 0.2 degrees per step.
        assert_close!(plain.x, navigated.x, 1e-6);
        assert_close!(plain.y, navigated.y, 1e-6);
        let flat =
            velocity(&turn([30.0, 20.0, 40.0], 10.0), &ERRORS, Choice::NoTransportRate, 90.0);
        assert!((flat - plain).norm() > 1e-4);
    }
}
