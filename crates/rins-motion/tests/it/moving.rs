//! The navigator on a vehicle that rotates and moves in all axes, compared with the true motion.

use nalgebra::Vector3;
use rins_frames::units::DEG;
use rins_frames::{Body, Dcm, EulerAngles, InFrame, Nav, Site};
use rins_motion::{NavState, Navigator, VerticalChannel};

use crate::support::{Motion, attitude_apart, station};

/// The frequency of the heave and sway \[rad/s\].
const SWAY: f64 = 0.7;
/// The frequency of the attitude oscillation \[rad/s\].
const SWING: f64 = 1.9;
/// The amplitudes of velocity \[m/s\].
const SPEED: Vector3<f64> = Vector3::new(12.0, -8.0, 2.0);

/// A boat: its velocity oscillates slowly, its heel and yaw faster.
struct Boat {
    start: Site,
}

impl Boat {
    fn new() -> Self {
        Self { start: Site { latitude: 50.0 * DEG, longitude: 0.1, height: 30.0 } }
    }

    fn angles(time: f64) -> (EulerAngles, EulerAngles) {
        let (sin, cos) = (SWING * time).sin_cos();
        (
            EulerAngles { roll: 0.25 * sin, pitch: 0.1 * cos, yaw: 0.8 + 0.3 * sin },
            EulerAngles { roll: 0.25 * cos, pitch: -0.1 * sin, yaw: 0.3 * cos },
        )
    }
}

impl Motion for Boat {
    fn nav_from_body(&self, time: f64) -> Dcm<Nav, Body> {
        Self::angles(time).0.dcm()
    }

    fn turn_rate(&self, time: f64) -> Vector3<f64> {
        let (angles, slopes) = Self::angles(time);
        // C = Rz(yaw) Rx(pitch) Ry(roll): each rate is about its own axis, resolved in the body.
        let roll = Dcm::<Body, Body>::about_y(angles.roll).inverse();
        let pitch = roll * Dcm::<Body, Body>::about_x(angles.pitch).inverse();
        let rate = InFrame::new(0.0, slopes.roll, 0.0)
            + roll * InFrame::new(slopes.pitch, 0.0, 0.0)
            + pitch * InFrame::new(0.0, 0.0, slopes.yaw);
        rate.components() * SWING
    }

    fn velocity(&self, time: f64) -> Vector3<f64> {
        SPEED * (SWAY * time).sin()
    }

    fn acceleration(&self, time: f64) -> Vector3<f64> {
        SPEED * (SWAY * (SWAY * time).cos())
    }

    /// The radii at the start are used throughout: they change by 1e-8 over the few meters.
    fn site(&self, time: f64) -> Site {
        let Site { latitude, longitude, height } = self.start;
        let away = SPEED * ((1.0 - (SWAY * time).cos()) / SWAY);
        let height = height + away.z;
        Site {
            latitude: latitude + away.y / (self.start.meridian_radius() + height),
            longitude: longitude
                + away.x / ((self.start.transverse_radius() + height) * latitude.cos()),
            height,
        }
    }
}

/// The errors of attitude \[rad\], velocity \[m/s\] and horizontal position \[m\] after a minute.
fn errors(intervals: impl Iterator<Item = f64>) -> (f64, f64, f64) {
    let boat = Boat::new();
    let state = NavState {
        position: boat.start,
        velocity: InFrame::from_components(boat.velocity(0.0)),
        nav_from_body: boat.nav_from_body(0.0),
    };
    let mut navigator = Navigator::new(state, &station(50.0 * DEG), VerticalChannel::Free);
    let mut time = 0.0;
    for interval in intervals {
        navigator.step(&boat.increments(time, time + interval));
        time += interval;
    }
    let NavState { position, velocity, nav_from_body } = navigator.state();
    let truth = boat.site(time);
    let north = (position.latitude - truth.latitude) * 6.4e6;
    let east = (position.longitude - truth.longitude) * 6.4e6 * truth.latitude.cos();
    (
        attitude_apart(*nav_from_body, boat.nav_from_body(time)).norm(),
        (velocity.components() - boat.velocity(time)).norm(),
        north.hypot(east),
    )
}

#[test]
fn motion_in_all_axes_is_followed_to_third_order() {
    let coarse = errors(std::iter::repeat_n(0.01, 6_000));
    let fine = errors(std::iter::repeat_n(0.005, 12_000));
    // 0.03″, 50 µm/s and 1 mm after a minute.
    assert!(coarse.0 < 2e-7 && coarse.1 < 6e-5 && coarse.2 < 1.2e-3, "{coarse:?}");
    for (coarse, fine) in [(coarse.0, fine.0), (coarse.1, fine.1), (coarse.2, fine.2)] {
        assert!(coarse / fine > 7.5, "half the interval leaves {fine:e} of {coarse:e}");
    }
}

#[test]
fn jitter_costs_no_more_than_its_longest_interval() {
    let jittered = errors((0..6_000).map(|k| if k % 2 == 0 { 0.005 } else { 0.015 }));
    let uniform = errors(std::iter::repeat_n(0.015, 4_000));
    let best = errors(std::iter::repeat_n(0.01, 6_000));
    for (jittered, uniform, best) in [
        (jittered.0, uniform.0, best.0),
        (jittered.1, uniform.1, best.1),
        (jittered.2, uniform.2, best.2),
    ] {
        assert!(jittered < uniform, "{jittered:e} with jitter, {uniform:e} at 15 ms");
        assert!(jittered > best, "{jittered:e} with jitter, {best:e} without");
    }
}
