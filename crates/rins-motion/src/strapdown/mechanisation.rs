//! The mechanization: integration of increments to position, velocity and attitude.

use rins_lanes::{Matrix, Real, Vector, rotation};

use super::vicinity::{Figures, Vicinity};
use crate::station::Station;

/// Whether height and vertical velocity are integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VerticalChannel {
    /// They are integrated; the channel then diverges with `2 g/R`.
    Free,
    /// They keep their initial values.
    Held,
}

/// Strapdown navigation of one run, or of several in parallel, without frames in types.
///
/// Each interval has one angle increment and one velocity increment. Coning and sculling are compensated with the previous
/// increments (‹savage1998a›, ‹savage1998b›: the one-sample form with the previous sample), the rotation of the body over the
/// interval in closed form, and that of the local level and the Coriolis acceleration at its middle.
///
/// Residual coning error: a cone of half-angle `a` with a phase advance `λ` per interval `T` drifts by `a² (λ - sin λ - sin λ
/// (1 - cos λ) / 3) / 2T ≈ a² λ⁵ / 60T`; sculling similarly by `a A λ⁴ / 60`, with the amplitude `A` of the specific force.
///
/// The position may be corrected by a filter between steps.
#[derive(Clone, Copy, Debug)]
pub struct Mechanisation<T> {
    /// Latitude, longitude \[rad\] and height \[m\].
    pub place: [T; 3],
    /// Velocity over the Earth, in n \[m/s\].
    pub velocity: Vector<T>,
    /// Attitude, `C_b^n`.
    pub nav_from_body: Matrix<T>,
    /// The specific force over the last interval, integrated and resolved in n: `∫ f^n dt` \[m/s\].
    pub force_gain: Vector<T>,
    vertical: VerticalChannel,
    /// Measured divided by normal gravity at the station: the anomaly is constant.
    gravity_ratio: f64,
    vicinity: Vicinity<T>,
    before: Option<Before<T>>,
    /// The mean acceleration over the Earth in the last interval \[m/s²\], for the velocity at the middle.
    acceleration: Vector<T>,
}

/// The increments of the previous interval.
#[derive(Clone, Copy, Debug)]
struct Before<T> {
    angle: Vector<T>,
    velocity: Vector<T>,
    interval: f64,
}

impl<T: Real> Mechanisation<T> {
    /// Navigation from this position, velocity and attitude, with the gravity measured at `station`.
    pub fn new(
        place: [T; 3],
        velocity: Vector<T>,
        nav_from_body: Matrix<T>,
        station: &Station,
        vertical: VerticalChannel,
    ) -> Self {
        let none = Vector::zeros(place[0]);
        Self {
            place,
            velocity,
            nav_from_body,
            force_gain: none,
            vertical,
            gravity_ratio: station.gravity / station.site.normal_gravity(),
            vicinity: Vicinity::of(place[0], place[2]),
            before: None,
            acceleration: none,
        }
    }

    /// Propagates position, velocity and attitude over one interval \[s\] with angle \[rad\] and velocity \[m/s\] increments;
    /// returns the Earth's properties at its start.
    #[inline(always)]
    pub fn step(&mut self, angle: &Vector<T>, gained: &Vector<T>, interval: f64) -> Figures<T> {
        let like = angle[0];
        let (velocity, rate) = (self.velocity, like.constant(1.0 / interval));
        let v = velocity + self.acceleration.scaled(0.5 * interval);
        let earth = self.vicinity.at(self.place[0], self.place[2]);
        let earth_rate = earth.earth_rate();
        let east_rate = v[0] * earth.transverse_curvature;
        let transport_rate =
            Vector([-(v[1] * earth.meridian_curvature), east_rate, east_rate * earth.tan_latitude]);

        // Velocity: the increment in the body frame at the start, resolved in the level at the middle.
        let nav_turn = (earth_rate + transport_rate).scaled(interval);
        let gain_start = self.nav_from_body * self.velocity_gain(angle, gained, interval);
        let gain = gain_start - nav_turn.cross(&gain_start).scaled(0.5);
        let fall = earth.gravity * (-self.gravity_ratio * interval);
        let coriolis = (earth_rate + earth_rate + transport_rate).cross(&v).scaled(interval);
        let mut after = velocity + gain - coriolis;
        after[2] = after[2] + fall;
        if self.vertical == VerticalChannel::Held {
            after[2] = velocity[2];
        }

        // Position: the mean of the velocities before and after.
        let way = (velocity + after).scaled(0.5 * interval);
        let [latitude, longitude, height] = self.place;
        let north = way[1] * earth.meridian_curvature;
        let east = way[0] * earth.transverse_curvature / earth.latitude[1];
        let rise = match self.vertical {
            VerticalChannel::Held => height,
            VerticalChannel::Free => height + way[2],
        };

        let body_turn = self.rotation_vector(angle, interval);
        let attitude = rotation::exp(&-nav_turn) * (self.nav_from_body * rotation::exp(&body_turn));
        self.place = [latitude + north, longitude + east, rise];
        self.nav_from_body = rotation::orthonormalised(&attitude);
        self.acceleration = (after - velocity) * rate;
        self.velocity = after;
        self.force_gain = gain;
        self.before = Some(Before { angle: *angle, velocity: *gained, interval });
        earth
    }

    /// The rotation vector of the body \[rad\]: the angle increment and coning.
    #[inline(always)]
    fn rotation_vector(&self, angle: &Vector<T>, interval: f64) -> Vector<T> {
        match &self.before {
            None => *angle,
            Some(before) => *angle + before.angle.cross(angle).scaled(before.weight(interval)),
        }
    }

    /// The velocity increment, resolved in the body frame at the interval's start \[m/s\].
    ///
    /// Rotation is compensated in closed form for a constant rate and force, and sculling to second order with the previous
    /// increments (‹savage1998b›).
    #[inline(always)]
    fn velocity_gain(&self, angle: &Vector<T>, gained: &Vector<T>, interval: f64) -> Vector<T> {
        let (first, second) = rotation::mean_weights(angle.dot(angle));
        let across = angle.cross(gained);
        let turned = *gained + across * first + angle.cross(&across) * second;
        match &self.before {
            None => turned,
            Some(before) => {
                let sculling = before.angle.cross(gained) + before.velocity.cross(angle);
                turned + sculling.scaled(before.weight(interval))
            }
        }
    }
}

impl<T> Before<T> {
    /// The weight of the products with these increments in the coning and sculling of the following interval \[s\].
    ///
    /// For a rate and a force that change linearly over both intervals `T₋₁` and `T`, coning is
    /// `T² / (6 T₋₁ (T₋₁ + T)) Δθ₋₁ × Δθ`, and sculling has the same weight: 1/12 for equal intervals.
    #[inline(always)]
    fn weight(&self, interval: f64) -> f64 {
        let ratio = interval / self.interval;
        ratio * ratio / (6.0 * (1.0 + ratio))
    }
}
