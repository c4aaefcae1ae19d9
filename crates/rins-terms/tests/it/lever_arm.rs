//! A lever arm against positions in inertial space, differenced twice.

use nalgebra::{Rotation3, Vector3};
use rins_frames::{EARTH_RATE, InFrame, Nav};
use rins_terms::{Instant, KinematicState, Surroundings, TermInstance, catalogue, values};
use rins_testing::assert_close;

use crate::support::run;

const RATE: f64 = 0.5;
const ACCELERATION: f64 = 0.3;

/// The force that a place in the body feels beyond that on the axis, in body axes \[m/s²\].
fn differenced(surroundings: &Surroundings, r_b: &Vector3<f64>, angle: f64) -> Vector3<f64> {
    let earth: InFrame<Nav> = surroundings.station.site.earth_rate();
    let pole = nalgebra::Unit::new_normalize(*earth.components());
    let attitude = |time: f64| {
        let turned = angle + RATE * time + 0.5 * ACCELERATION * time * time;
        let turned = Rotation3::from_axis_angle(&Vector3::z_axis(), turned);
        let fixed = *surroundings.nav_from_table.matrix();
        Rotation3::from_axis_angle(&pole, EARTH_RATE * time).matrix() * fixed * turned.matrix()
    };
    let h = 3e-4;
    let place = |time: f64| attitude(time) * r_b;
    let acceleration = (place(h) - place(0.0) * 2.0 + place(-h)) / (h * h);
    attitude(0.0).transpose() * acceleration
}

fn moment(angle: f64) -> KinematicState<'static> {
    let track = &run().track;
    let moment = track.moments().next().unwrap();
    let mean = Instant { angle, rate: RATE, acceleration: ACCELERATION, ..moment.mean };
    let mut moment = KinematicState { mean, ..moment };
    let earth = moment.surroundings.earth_rate;
    moment.rate = moment.in_body(&earth) + Vector3::z() * RATE;
    moment
}

// Truncation 3e-10 and rounding 1e-10 m/s²; the Earth's centripetal acceleration, which gravity has,
// 5e-10. The Coriolis acceleration is 1e-5.
const WITHIN: f64 = 2e-9;

#[test]
fn lever_arm_is_the_second_derivative_of_a_position() {
    for angle in [0.0, 1.0, 4.0] {
        let moment = moment(angle);
        let arm = TermInstance::new(&catalogue::ACCEL_LEVER_ARM).with_values(&[0.08, -0.05]);
        let got = values(&arm.signals(&moment, None).accel);
        let want = differenced(&moment.surroundings, &Vector3::new(0.08, -0.05, 0.0), angle);
        for axis in 0..3 {
            assert_close!(got[axis], want[axis], WITHIN);
        }
        assert!(want.z.abs() > 10.0 * WITHIN, "the Coriolis acceleration shows");
    }
}

#[test]
fn each_accelerometer_feels_the_place_where_it_is() {
    let moment = moment(2.0);
    let places = [0.03, 0.01, -0.02, 0.04];
    let size = TermInstance::new(&catalogue::ACCEL_SIZE_EFFECT).with_values(&places);
    let got = values(&size.signals(&moment, None).accel);
    let at = |x, y| differenced(&moment.surroundings, &Vector3::new(x, y, 0.0), 2.0);
    assert_close!(got.x, at(0.03, 0.01).x, WITHIN);
    assert_close!(got.y, at(-0.02, 0.04).y, WITHIN);
    assert_eq!(got.z, 0.0);
}
