//! Strapdown mechanisation: attitude, velocity and position from increments.

mod vicinity;

use nalgebra::Vector3;
use rins_frames::{Body, Dcm, InFrame, Increments, Nav, Site};

use self::vicinity::Vicinity;
use crate::station::Station;

/// Whether height and vertical velocity are integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VerticalChannel {
    /// They are; the channel then diverges, as `2 g/R` makes it.
    Free,
    /// They stay as they were at the start.
    Held,
}

/// Position, velocity and attitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NavState {
    /// Latitude, longitude and height.
    pub position: Site,
    /// Velocity over the Earth \[m/s\].
    pub velocity: InFrame<Nav>,
    /// Attitude, `C_b^n`.
    pub nav_from_body: Dcm<Nav, Body>,
}

/// A strapdown navigator on the WGS84 Earth.
///
/// Per interval it takes one angle and one velocity increment. Coning and sculling are compensated
/// with the increments before (‹savage1998a›, ‹savage1998b›: the one-sample form with the
/// previous sample), the rotation of the body over the interval in closed form, and that of the
/// local level and Coriolis acceleration at its middle.
///
/// What coning leaves: a cone of half-angle `a`, turned through `λ` per interval `T`, drifts by
/// `a² (λ - sin λ - sin λ (1 - cos λ) / 3) / 2T ≈ a² λ⁵ / 60T`; sculling likewise by
/// `a A λ⁴ / 60`, with `A` the amplitude of the specific force.
///
/// Within sight of a pole, where longitude and north lose their meaning, it must not be used.
///
/// ```
/// use rins_frames::units::DEG;
/// use rins_frames::{Dcm, InFrame, Rates, Site};
/// use rins_motion::{Navigator, Station, VerticalChannel};
/// let site = Site { latitude: 45.0 * DEG, longitude: 0.0, height: 0.0 };
/// let station = Station::with_normal_gravity(site);
/// // Level, pointing north, at rest, with an east accelerometer that reads 1 mm/s² too much.
/// let read = Rates {
///     angular_rate: InFrame::from_components(*site.earth_rate().components()),
///     specific_force: InFrame::new(1e-3, 0.0, station.gravity),
/// };
/// let mut navigator = Navigator::at_rest(&station, Dcm::identity(), VerticalChannel::Held);
/// for _ in 0..100 {
///     navigator.step(&read.over(0.01));
/// }
/// assert!((navigator.state().velocity.components().x - 1e-3).abs() < 1e-7);
/// ```
#[derive(Clone, Debug)]
pub struct Navigator {
    state: NavState,
    vertical: VerticalChannel,
    /// Measured over normal gravity at the station: the anomaly goes along.
    gravity_ratio: f64,
    vicinity: Vicinity,
    before: Option<Increments>,
    /// The last interval's mean acceleration over the Earth \[m/s²\], for the half-way velocity.
    acceleration: Vector3<f64>,
    force_gain: InFrame<Nav>,
}

impl Navigator {
    /// A navigator that starts at `state`, under the gravity measured at `station`.
    pub fn new(state: NavState, station: &Station, vertical: VerticalChannel) -> Self {
        Self {
            state,
            vertical,
            gravity_ratio: station.gravity / station.site.normal_gravity(),
            vicinity: Vicinity::around(&state.position),
            before: None,
            acceleration: Vector3::zeros(),
            force_gain: InFrame::zeros(),
        }
    }

    /// A navigator that stands still at `station` with this attitude.
    pub fn at_rest(
        station: &Station,
        nav_from_body: Dcm<Nav, Body>,
        vertical: VerticalChannel,
    ) -> Self {
        let state = NavState { position: station.site, velocity: InFrame::zeros(), nav_from_body };
        Self::new(state, station, vertical)
    }

    /// Position, velocity and attitude now.
    pub const fn state(&self) -> &NavState {
        &self.state
    }

    /// Position, velocity and attitude, to be corrected by a filter.
    pub const fn state_mut(&mut self) -> &mut NavState {
        &mut self.state
    }

    /// The specific force over the last interval, integrated and resolved in n: `∫ f^n dt` \[m/s\].
    pub const fn force_gain(&self) -> &InFrame<Nav> {
        &self.force_gain
    }

    /// The rate of n with respect to inertial space now, `ω_in^n` \[rad/s\].
    pub fn rate_of_nav_in_inertial(&self) -> InFrame<Nav> {
        let NavState { position, velocity, .. } = &self.state;
        position.earth_rate() + position.transport_rate(velocity)
    }

    /// Carries the state over one interval.
    ///
    /// The interval must be longer than zero; it may differ from that before. The first step
    /// knows no increments before, and so neither coning nor sculling: start at rest.
    pub fn step(&mut self, now: &Increments) {
        let interval = now.interval;
        let NavState { position, velocity, nav_from_body } = self.state;
        let half_way = InFrame::<Nav>::from_components(
            velocity.components() + self.acceleration * (0.5 * interval),
        );
        let earth = self.vicinity.at(&position);
        let v = half_way.components();
        let earth_rate = InFrame::<Nav>::new(0.0, earth.earth_rate.0, earth.earth_rate.1);
        let east_rate = v.x * earth.transverse_curvature;
        let transport_rate = InFrame::<Nav>::new(
            -v.y * earth.meridian_curvature,
            east_rate,
            east_rate * earth.tan_latitude,
        );

        // Velocity: the gain in the body frame at the start, seen from the level half-way.
        let nav_turn = (earth_rate + transport_rate) * interval;
        let gain_b = velocity_gain(now, self.before.as_ref());
        let gain_start = *(nav_from_body * gain_b).components();
        let gain = gain_start - nav_turn.components().cross(&gain_start) * 0.5;
        let gravity = Vector3::new(0.0, 0.0, -self.gravity_ratio * earth.gravity);
        let coriolis = (earth_rate * 2.0 + transport_rate).components().cross(v);
        let mut after = velocity.components() + gain + (gravity - coriolis) * interval;
        if self.vertical == VerticalChannel::Held {
            after.z = velocity.components().z;
        }

        // Position: the mean of the velocities before and after.
        let mean = (velocity.components() + after) * 0.5;
        let height = position.height;
        let north = mean.y * earth.meridian_curvature;
        let east = mean.x * earth.transverse_curvature / earth.cos_latitude;
        let rise = if self.vertical == VerticalChannel::Held { 0.0 } else { mean.z };

        let body_turn = rotation_vector(now, self.before.as_ref());
        let attitude = Dcm::<Nav, Nav>::from_rotation_vector(&-nav_turn.components())
            * nav_from_body
            * Dcm::<Body, Body>::from_rotation_vector(&body_turn);
        self.state = NavState {
            position: Site {
                latitude: position.latitude + north * interval,
                longitude: position.longitude + east * interval,
                height: height + rise * interval,
            },
            velocity: InFrame::from_components(after),
            nav_from_body: attitude.orthonormalised(),
        };
        self.acceleration = (after - velocity.components()) / interval;
        self.force_gain = InFrame::from_components(gain);
        self.before = Some(*now);
    }
}

/// The weight of the products with the increments before in coning and sculling.
///
/// For a rate and a force that change linearly over both intervals `T₋₁` and `T`, coning is
/// `T² / (6 T₋₁ (T₋₁ + T)) Δθ₋₁ × Δθ`, and sculling has the same weight: 1/12 for equal intervals.
fn weight_of_before(now: &Increments, before: &Increments) -> f64 {
    let ratio = now.interval / before.interval;
    ratio * ratio / (6.0 * (1.0 + ratio))
}

/// The body's turn over `now` as a rotation vector \[rad\]: the angle increment and coning.
fn rotation_vector(now: &Increments, before: Option<&Increments>) -> Vector3<f64> {
    let angle = now.angle.components();
    before.map_or(*angle, |before| {
        angle + before.angle.components().cross(angle) * weight_of_before(now, before)
    })
}

/// The velocity gained over `now`, resolved in the body frame at its start \[m/s\].
///
/// Rotation is compensated in closed form for a constant rate and force, and sculling to second
/// order with the increments before (‹savage1998b›).
fn velocity_gain(now: &Increments, before: Option<&Increments>) -> InFrame<Body> {
    let (angle, velocity) = (now.angle.components(), now.velocity.components());
    let square = angle.norm_squared();
    // (1 - cos θ)/θ² and (1 - sin θ / θ)/θ², by series where their differences would cancel:
    // the first omitted terms are below 1e-17 there.
    let (first, second) = if square < 1e-4 {
        (
            0.5 - square / 24.0 * (1.0 - square / 30.0),
            1.0 / 6.0 - square / 120.0 * (1.0 - square / 42.0),
        )
    } else {
        let norm = square.sqrt();
        ((1.0 - norm.cos()) / square, (1.0 - norm.sin() / norm) / square)
    };
    let across = angle.cross(velocity);
    let rotation = across * first + angle.cross(&across) * second;
    let sculling = before.map_or(Vector3::zeros(), |before| {
        (before.angle.components().cross(velocity) + before.velocity.components().cross(angle))
            * weight_of_before(now, before)
    });
    InFrame::from_components(velocity + rotation + sculling)
}
