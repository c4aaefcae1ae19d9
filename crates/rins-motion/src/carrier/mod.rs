//! A carrier under way: legs of heading and speed, and sway about them.

mod course;
mod sway;
mod table;

use nalgebra::{ComplexField, Matrix3, Vector3};
use rins_frames::{Dcm, Nav};

use self::course::Course;
pub use self::course::{CarrierError, Leg};
pub use self::sway::{Oscillation, Sway};
pub use self::table::{CarriedSample, CarriedState, CarriedTable};

/// A carrier: its course over the legs of a voyage, and its sway.
///
/// Carrier axes are right, forward and up. At the heading zero and without sway they are east, north and up.
#[derive(Clone, Debug, PartialEq)]
pub struct Carrier {
    course: Course,
    sway: Sway,
}

/// The motion of a carrier at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarrierState {
    /// Velocity over the Earth, east, north and up \[m/s\].
    pub velocity: Vector3<f64>,
    /// Its derivative \[m/s²\].
    pub acceleration: Vector3<f64>,
    /// The rotation from carrier axes to east, north and up.
    pub attitude: Matrix3<f64>,
    /// The angular rate of the carrier relative to east, north and up, in carrier axes \[rad/s\].
    pub rate: Vector3<f64>,
    /// Yaw, counter-clockwise from above and unwrapped \[rad\].
    pub yaw: f64,
    /// Its derivative \[rad/s\].
    pub yaw_rate: f64,
}

impl Carrier {
    /// A carrier at rest without sway, with the heading zero.
    pub fn at_rest() -> Self {
        Self { course: Course::at_rest(), sway: Sway::default() }
    }

    /// A carrier that runs through these legs again and again for `duration` \[s\], and sways.
    ///
    /// It begins with the heading and the speed of the first leg. Every other leg begins with a turn to its heading, by the shorter way, and
    /// with a change of speed at constant acceleration. Without legs the carrier is at rest.
    ///
    /// # Errors
    /// [`CarrierError`] if a value is not possible, or a heading or speed would have to jump.
    ///
    /// ```
    /// use rins_motion::{Carrier, Leg, Sway};
    /// let leg = |heading: f64| Leg { heading, speed: 5.0, duration: 600.0, turn_rate: Some(0.02), acceleration: None };
    /// let carrier = Carrier::new(&[leg(0.0), leg(1.5)], Sway::default(), 3600.0)?;
    /// let state = carrier.at(300.0);
    /// assert_eq!((state.velocity.x, state.velocity.y), (0.0, 5.0)); // north
    /// # Ok::<(), rins_motion::CarrierError>(())
    /// ```
    pub fn new(legs: &[Leg], sway: Sway, duration: f64) -> Result<Self, CarrierError> {
        sway.check()?;
        let course = if legs.is_empty() { Course::at_rest() } else { Course::new(legs, duration)? };
        Ok(Self { course, sway })
    }

    /// The shortest period of the sway \[s\], if it sways.
    pub fn shortest_period(&self) -> Option<f64> {
        self.sway.shortest_period()
    }

    /// The motion at `time` \[s\].
    pub fn at(&self, time: f64) -> CarrierState {
        let [heading, turn, speed, acceleration] = self.course.at(time);
        let Sway { roll, pitch, yaw, heave } = &self.sway;
        let [roll, pitch, yawing, heave] =
            [roll, pitch, yaw, heave].map(|one| one.map_or([0.0; 3], |one| one.at(time)));
        let (sin, cos) = ComplexField::sin_cos(heading);
        // East and north of a heading, and how they change.
        let ahead = Vector3::new(sin, cos, 0.0);
        let across = Vector3::new(cos, -sin, 0.0);
        let velocity = ahead * speed + Vector3::z() * heave[1];
        let acceleration = ahead * acceleration + across * (speed * turn) + Vector3::z() * heave[2];
        let (yaw, yaw_rate) = (yawing[0] - heading, yawing[1] - turn);
        let by_yaw = *Dcm::<Nav, Nav>::about_z(yaw).matrix();
        let by_pitch = *Dcm::<Nav, Nav>::about_x(pitch[0]).matrix();
        let by_roll = *Dcm::<Nav, Nav>::about_y(roll[0]).matrix();
        let rate = by_roll.transpose()
            * (by_pitch.transpose() * (Vector3::z() * yaw_rate) + Vector3::x() * pitch[1])
            + Vector3::y() * roll[1];
        CarrierState {
            velocity,
            acceleration,
            attitude: by_yaw * by_pitch * by_roll,
            rate,
            yaw,
            yaw_rate,
        }
    }

    /// The height above that of the start by heave at `time` \[m\].
    pub fn heave(&self, time: f64) -> f64 {
        let height = |time: f64| self.sway.heave.map_or(0.0, |heave| heave.at(time)[0]);
        height(time) - height(0.0)
    }

    /// The first time after `time` at which a turn or a change of speed begins or ends \[s\]; infinite if there is none.
    pub fn next_corner(&self, time: f64) -> f64 {
        self.course.next_corner(time)
    }
}

#[cfg(test)]
mod tests;
