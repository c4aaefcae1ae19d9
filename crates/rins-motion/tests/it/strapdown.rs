//! The navigator with perfect increments: its position must not change.

use nalgebra::Vector3;
use proptest::prelude::*;
use rins_frames::units::{DEG, DEG_PER_SECOND};
use rins_frames::{InFrame, Nav, Rates};
use rins_motion::mechanism::ConstantTurn;
use rins_motion::{NavState, Navigator, Station, VerticalChannel};
use rins_testing::{any_latitude, assert_close};

use crate::support::{
    any_attitude, at_angle_zero, attitude_apart, constant_motion, paper_turn, station,
};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn fixed_attitude_is_held_over_an_hour(latitude in any_latitude(), attitude in any_attitude()) {
        let station = station(latitude);
        let attitude = at_angle_zero(attitude);
        let rates = Rates {
            angular_rate: attitude.inverse() * station.site.earth_rate(),
            specific_force: attitude.inverse() * -station.gravity_vector(),
        };
        let mut navigator = Navigator::at_rest(&station, attitude, VerticalChannel::Held);
        for _ in 0..360_000 {
            navigator.step(&rates.over(0.01));
        }
        let NavState { velocity, nav_from_body, .. } = *navigator.state();
        let turned = attitude_apart(nav_from_body, attitude).norm();
        // Near a pole rounding rotates the meridian that defines the level.
        prop_assert!(turned < 1e-9 / latitude.cos().sqrt(), "turned by {turned:e} rad");
        prop_assert!(velocity.norm() < 1e-6, "{:e} m/s", velocity.norm());
    }
}

/// On a table that rotates by `θ` per interval, vectors fixed in s rotate by `-θ` in b. The expansion of the navigator's
/// formulas for them results in a drift of `e θ³ / 24`, with the level component `e` of the Earth's rate, and in an
/// acceleration of `f θ⁴ / 240`, with the level component `f` of the specific force, after a first step with an error of `f T
/// θ² / 12` because it has no previous increments.
#[test]
fn turning_table_leaves_what_the_expansion_predicts() {
    const DURATION: f64 = 360.0;
    const INTERVAL: f64 = 0.02;
    for rate in [10.0, -10.0, 40.0, -40.0] {
        let turn = ConstantTurn { rate: rate * DEG_PER_SECOND, ..paper_turn() };
        let start = turn.nav_from_body(0.0);
        let mut navigator = Navigator::at_rest(&turn.station, start, VerticalChannel::Held);
        for sample in constant_motion(&turn, DURATION).samples(INTERVAL) {
            navigator.step(&sample.increments);
        }
        let state = navigator.state();
        let turned = attitude_apart(state.nav_from_body, turn.nav_from_body(DURATION)).norm();

        let theta = (turn.rate * INTERVAL).abs();
        let table_from_nav = turn.nav_from_table.inverse();
        let across = |v: InFrame<Nav>| (table_from_nav * v).components().xy().norm();
        let drift = across(turn.station.site.earth_rate()) * theta.powi(3) / 24.0;
        // 3.9e-11 rad at 10 °/s and 2.5e-9 rad at 40 °/s.
        assert_close!(turned, drift * DURATION, 0.05 * drift * DURATION);

        let f = across(turn.station.gravity_vector());
        let first = f * INTERVAL * theta.powi(2) / 12.0;
        let steady = f * theta.powi(4) / 240.0 * DURATION;
        let by_tilt = turn.station.gravity * drift * DURATION * DURATION / 2.0;
        let bound = first + steady + by_tilt;
        let velocity = state.velocity.norm();
        assert!(velocity < bound, "{velocity:e} m/s at {rate} °/s, more than {bound:e}");
        assert!(velocity > 0.1 * bound, "{velocity:e} m/s at {rate} °/s: {bound:e} is loose");
    }
}

#[test]
fn measured_gravity_leaves_the_navigator_at_rest() {
    // A tenth of a percent is more than any gravity anomaly on the Earth.
    let normal = station(40.0 * DEG);
    let station = Station { gravity: normal.gravity * 1.001, ..normal };
    let rates = Rates {
        angular_rate: InFrame::from_components(*station.site.earth_rate().components()),
        specific_force: InFrame::new(0.0, 0.0, station.gravity),
    };
    let level = rins_frames::Dcm::identity();
    let mut navigator = Navigator::at_rest(&station, level, VerticalChannel::Free);
    for _ in 0..6000 {
        navigator.step(&rates.over(0.01));
    }
    assert!(navigator.state().velocity.norm() < 1e-9);
}

/// Each sample corrects rounding errors of the length and the orthogonality of an attitude's rows.
#[test]
fn an_attitude_that_is_not_quite_a_rotation_becomes_one() {
    const OFF: f64 = 1e-7;
    // One step leaves the square of the deviation, which is up to three times its element.
    const LEFT: f64 = 20.0 * OFF * OFF;
    let station = station(40.0 * DEG);
    let defect = nalgebra::Matrix3::from_fn(|row, column| OFF * (1.0 + row as f64 - column as f64));
    let attitude = *at_angle_zero(rins_frames::Dcm::about_x(0.4)).matrix();
    let state = NavState {
        position: station.site,
        velocity: InFrame::zeros(),
        nav_from_body: rins_frames::Dcm::from_kernel(attitude + defect * attitude),
    };
    let not_orthonormal = |navigator: &Navigator| {
        let c = navigator.state().nav_from_body.matrix();
        (c * c.transpose() - nalgebra::Matrix3::identity()).amax()
    };
    let mut navigator = Navigator::new(state, &station, VerticalChannel::Held);
    assert!(not_orthonormal(&navigator) > OFF, "it begins as no rotation");
    let turning = Rates {
        angular_rate: InFrame::new(0.1, -0.2, 0.3),
        specific_force: InFrame::new(0.0, 0.0, station.gravity),
    };
    for _ in 0..3 {
        navigator.step(&turning.over(0.01));
        assert!(not_orthonormal(&navigator) < LEFT, "{:e}", not_orthonormal(&navigator));
    }
}

#[test]
fn held_channel_keeps_height_and_vertical_velocity() {
    let station = station(40.0 * DEG);
    let rates = Rates {
        angular_rate: InFrame::zeros(),
        specific_force: InFrame::new(0.1, 0.2, station.gravity + 1.0),
    };
    let state = NavState {
        position: station.site,
        velocity: InFrame::new(0.0, 0.0, 3.0),
        nav_from_body: rins_frames::Dcm::identity(),
    };
    let mut navigator = Navigator::new(state, &station, VerticalChannel::Held);
    for _ in 0..100 {
        navigator.step(&rates.over(0.01));
    }
    let NavState { position, velocity, .. } = navigator.state();
    assert_eq!((position.height.to_bits(), velocity.components().z.to_bits()), {
        (station.site.height.to_bits(), 3.0_f64.to_bits())
    });
    assert_close!(velocity.components().x, 0.1, 1e-3);
}

#[test]
fn force_gain_is_the_reaction_to_gravity_at_rest() {
    let turn = paper_turn();
    let start = turn.nav_from_body(0.0);
    let mut navigator = Navigator::at_rest(&turn.station, start, VerticalChannel::Held);
    for sample in constant_motion(&turn, 1.0).samples(0.02) {
        navigator.step(&sample.increments);
        let reaction = Vector3::new(0.0, 0.0, turn.station.gravity * 0.02);
        // The first step has no sculling correction: (ωT)² / 12 of the level component is missing.
        assert!((navigator.force_gain().components() - reaction).norm() < 3e-7);
    }
    let w_in = navigator.rate_of_nav_in_inertial();
    let w_ie = turn.station.site.earth_rate();
    assert!((w_in - w_ie).norm() < 1e-12, "at rest the level turns with the Earth");
}
