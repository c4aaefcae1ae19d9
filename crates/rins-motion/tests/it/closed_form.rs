//! Eqs. (6), (8) and (9), compared with a strapdown run on a flat Earth that does not rotate.

use nalgebra::Vector3;
use proptest::prelude::*;
use rins_frames::{Body, Dcm, InFrame, Nav};
use rins_motion::mechanism::{
    ClosedForm, ConstantTurn, NavErrors, SensorErrors, Sign, SpinAxisErrors, flat_navigation,
};
use rins_motion::{NavState, Navigator, VerticalChannel};

use crate::support::{
    any_spin_axis_errors, any_turn, any_vector, attitude_apart, constant_motion, paper_errors,
    paper_turn, scaled,
};

/// The largest initial attitude error \[rad\].
const INITIAL_ERROR: f64 = 1e-3;

/// The error of an angle due to Simpson's rule and some thousand products \[rad\].
const ROUNDING: f64 = 1e-11;

fn closed_form(turn: &ConstantTurn, errors: &SpinAxisErrors, initial: &NavErrors) -> ClosedForm {
    ClosedForm {
        initial_attitude: initial.attitude,
        initial_velocity: initial.velocity,
        ..ClosedForm::new(*turn, *errors, Sign::Strapdown)
    }
}

fn tilted(attitude: Vector3<f64>, velocity: Vector3<f64>) -> NavErrors {
    NavErrors {
        attitude: InFrame::from_components(attitude),
        velocity: InFrame::new(velocity.x, velocity.y, 0.0),
        ..NavErrors::none()
    }
}

/// A strapdown run on a flat Earth: matrix products step by step, velocity by Simpson's rule.
fn flat_run(
    turn: &ConstantTurn,
    errors: &SpinAxisErrors,
    initial: &NavErrors,
    time: f64,
) -> (Vector3<f64>, Vector3<f64>) {
    let steps = (time / 0.05).ceil();
    let half = time / steps / 2.0;
    let gyros = SensorErrors::from(*errors);
    let reported = |time: f64| {
        let reaction = turn.nav_from_body(time).inverse() * -turn.station.gravity_vector();
        let truth = rins_frames::Rates {
            angular_rate: InFrame::new(0.0, 0.0, turn.rate),
            specific_force: reaction,
        };
        (truth.angular_rate + gyros.of(&truth).angular_rate, reaction)
    };
    let half_turn = Dcm::<Body, Body>::from_rotation_vector(&(reported(0.0).0.components() * half));
    let off = -*initial.attitude.components();
    let mut attitude = Dcm::<Nav, Nav>::from_rotation_vector(&off) * turn.nav_from_body(0.0);
    let mut velocity = *initial.velocity.components();
    let mut step = 0.0;
    while step < steps {
        let start = 2.0 * half * step;
        for (part, weight) in [(0.0, 1.0), (1.0, 4.0), (2.0, 1.0)] {
            let force = attitude * reported(start + half * part).1 + turn.station.gravity_vector();
            velocity += force.components() * (weight * half / 3.0);
            if part < 2.0 {
                attitude = attitude * half_turn;
            }
        }
        step += 1.0;
    }
    velocity.z = initial.velocity.components().z;
    let error = -attitude_apart(attitude, turn.nav_from_body(time));
    (error, velocity)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn flat_navigation_is_a_strapdown_run_on_a_flat_earth(
        turn in any_turn(),
        errors in any_spin_axis_errors(),
        tilt in any_vector(INITIAL_ERROR),
        kick in any_vector(1.0),
        time in 1.0..100.0_f64,
    ) {
        // Errors a hundred times larger, since this form is not linear.
        let errors = scaled(&errors, 100.0);
        let initial = tilted(tilt * 100.0, kick);
        let form = flat_navigation(&turn, &errors, &initial, time);
        let (attitude, velocity) = flat_run(&turn, &errors, &initial, time);
        // The error of Simpson's rule is (m ω h)⁴ / 2880 of g t, or 1e-9.
        prop_assert!((attitude - form.attitude.components()).norm() < 1e-11);
        let off = (velocity - form.velocity.components()).norm();
        prop_assert!(off < 1e-8, "off by {off:e} m/s");
    }

    /// If all errors are halved, the remaining error of a first-order closed form is a quarter.
    #[test]
    fn closed_form_is_the_first_order_of_a_strapdown_run(
        turn in any_turn(),
        errors in any_spin_axis_errors(),
        tilt in any_vector(INITIAL_ERROR),
        kick in any_vector(1.0),
        time in 1.0..100.0_f64,
    ) {
        let turned = (turn.rate * time).abs();
        let misaligned = errors.misalignment_xz.hypot(errors.misalignment_yz);
        let size = 2.0 * misaligned + errors.scale_z.abs() * turned + tilt.norm();
        // Misalignment also increases the rate that the gyros measure, by half its square.
        let second = size * size + misaligned * misaligned * turned;
        let third = size * second;
        let left = |factor: f64| {
            let errors = scaled(&errors, factor);
            let initial = tilted(tilt * factor, kick * factor);
            let (attitude, velocity) = flat_run(&turn, &errors, &initial, time);
            let form = closed_form(&turn, &errors, &initial);
            let total = form.velocity_error(time).total();
            let by_gravity = turn.station.gravity * time;
            (
                attitude - form.attitude_error(time).components(),
                (velocity - total.components()) / by_gravity,
            )
        };
        let (attitude, velocity) = left(1.0);
        let (attitude_of_half, velocity_of_half) = left(0.5);
        prop_assert!(attitude.norm() < second + ROUNDING, "{:e}", attitude.norm());
        prop_assert!(velocity.norm() < second + ROUNDING, "{:e}", velocity.norm());
        let not_second = (attitude_of_half * 4.0 - attitude).norm();
        prop_assert!(not_second < third + ROUNDING, "{not_second:e} of {:e}", attitude.norm());
        let not_second = (velocity_of_half * 4.0 - velocity).norm();
        prop_assert!(not_second < third + ROUNDING, "{not_second:e} of {:e}", velocity.norm());
    }

    /// `φ' = -C_b^n δω` and `δv' = (-g φ_y, g φ_x)`, by central differences.
    #[test]
    fn closed_form_solves_equations_7_and_12(
        turn in any_turn(),
        errors in any_spin_axis_errors(),
        tilt in any_vector(INITIAL_ERROR),
        kick in any_vector(1.0),
        time in 1.0..300.0_f64,
        sign in prop_oneof![Just((Sign::Printed, 1.0)), Just((Sign::Strapdown, -1.0))],
    ) {
        let form = ClosedForm {
            sign: sign.0,
            ..closed_form(&turn, &errors, &tilted(tilt, kick))
        };
        // At this step the contribution of the third derivative and rounding are both below 1e-10 rad/s.
        let h = 1e-3;
        let by_difference = |of: &dyn Fn(f64) -> InFrame<Nav>| {
            (of(time + h) - of(time - h)) * (0.5 / h)
        };
        let slope = by_difference(&|time| form.attitude_error(time));
        let gyro_error = InFrame::from_components(Vector3::new(
            errors.misalignment_xz,
            errors.misalignment_yz,
            errors.scale_z,
        ));
        let driven = turn.nav_from_body(time) * gyro_error * (sign.1 * turn.rate);
        prop_assert!((slope - driven).norm() < 1e-9);

        let slope = by_difference(&|time| form.velocity_error(time).total());
        let phi = *form.attitude_error(time).components();
        let g = turn.station.gravity;
        prop_assert!((slope - InFrame::new(-g * phi.y, g * phi.x, 0.0)).norm() < 1e-7);
        prop_assert!((slope - form.acceleration_error(time)).norm() < 1e-7);
    }

    #[test]
    fn whole_turns_return_what_misalignment_levels_off_but_not_what_scale_does(
        turn in any_turn(),
        errors in any_spin_axis_errors(),
        turns in 1..20_u8,
    ) {
        let time = f64::from(turns) * std::f64::consts::TAU / turn.rate.abs();
        let misaligned = SpinAxisErrors { scale_z: 0.0, ..errors };
        let form = ClosedForm::new(turn, misaligned, Sign::Strapdown);
        prop_assert!(form.attitude_error(time).norm() < 1e-15);
        prop_assert!(form.velocity_error(time).bounded.norm() < 1e-13);

        // The rotation about the spin axis due to the scale error tilts the level by the tilt of the axis.
        let scaled = SpinAxisErrors { scale_z: errors.scale_z, ..SpinAxisErrors::default() };
        let form = ClosedForm::new(turn, scaled, Sign::Strapdown);
        let level = form.attitude_error(time).components().xy().norm();
        let axis = turn.nav_from_table.matrix().column(2).xy().norm();
        let whole = errors.scale_z.abs() * f64::from(turns) * std::f64::consts::TAU;
        prop_assert!((level - axis * whole).abs() < 1e-12);
    }

    /// After half a revolution misalignment has not averaged out: its effect is 2 M perpendicular to the spin axis.
    #[test]
    fn half_a_turn_shows_misalignment_twice(turn in any_turn(), errors in any_spin_axis_errors()) {
        let misaligned = SpinAxisErrors { scale_z: 0.0, ..errors };
        let form = ClosedForm::new(turn, misaligned, Sign::Strapdown);
        let twice = 2.0 * errors.misalignment_xz.hypot(errors.misalignment_yz);
        let shown = form.attitude_error(std::f64::consts::PI / turn.rate.abs()).norm();
        prop_assert!((shown - twice).abs() < 1e-15);
    }

    /// The bounded brackets stay within their amplitudes at any time.
    #[test]
    fn bounded_terms_are_bounded(
        turn in any_turn(),
        errors in any_spin_axis_errors(),
        time in 0.0..1e5_f64,
    ) {
        let form = ClosedForm::new(turn, errors, Sign::Strapdown);
        let most = 2.0 * turn.station.gravity / turn.rate.abs()
            * errors.misalignment_xz.hypot(errors.misalignment_yz);
        prop_assert!(form.velocity_error(time).bounded.norm() <= most * (1.0 + 1e-12));
    }
}

/// The north velocity error of eq. (9) as printed, literally, and with the sign of its bounded `C_s^n(1, 1)` term as a
/// factor.
fn equation_9(turn: &ConstantTurn, errors: &SpinAxisErrors, time: f64, sign: f64) -> f64 {
    let c = turn.nav_from_table.matrix();
    let (g, omega) = (turn.station.gravity, turn.rate);
    let SpinAxisErrors { misalignment_xz: m_xz, misalignment_yz: m_yz, scale_z: s_z } = *errors;
    let (sin, cos) = (omega * time).sin_cos();
    (sign * c[(0, 0)] * g / omega * (-m_xz * cos + m_yz * sin + m_xz)
        - c[(0, 1)] * g / omega * (m_xz * sin + m_yz * cos - m_yz))
        + (-c[(0, 0)] * g * m_yz * time
            + c[(0, 1)] * g * m_xz * time
            + c[(0, 2)] * g / 2.0 * s_z * omega * time * time)
}

/// The printed eq. (9) is the integral of the printed eq. (6) with the sign of that term as printed; with the other sign it
/// is not. The difference is visible after a quarter revolution, but not after whole revolutions.
#[test]
fn bounded_c11_term_of_equation_9_is_positive() {
    let (turn, errors) = (paper_turn(), paper_errors());
    let form = ClosedForm::new(turn, errors, Sign::Printed);
    let time = 9.0;
    let steps = 2000;
    let h = time / f64::from(steps);
    let by_midpoints: f64 = (0..steps)
        .map(|k| form.acceleration_error((f64::from(k) + 0.5) * h).components().y * h)
        .sum();
    // The error of the midpoint rule is h² / 24 times the change of the slope.
    let within = 1e-9;
    assert!((equation_9(&turn, &errors, time, 1.0) - by_midpoints).abs() < within);
    assert!((form.velocity_error(time).total().components().y - by_midpoints).abs() < within);
    let other = equation_9(&turn, &errors, time, -1.0);
    assert!((other - by_midpoints).abs() > 0.01, "{other} for {by_midpoints} m/s");
    let whole = |sign| equation_9(&turn, &errors, 360.0, sign);
    assert!((whole(1.0) - whole(-1.0)).abs() < 1e-9);
}

/// Over two seconds the Earth's rate and the Schuler loop are negligible: the navigator itself then verifies the flat run and
/// the corrected sign.
#[test]
fn navigator_agrees_with_the_flat_run_over_a_short_time() {
    const TIME: f64 = 2.0;
    let (turn, errors) = (paper_turn(), scaled(&paper_errors(), 10.0));
    let sensors = SensorErrors::from(errors);
    let start = turn.nav_from_body(0.0);
    let mut navigator = Navigator::at_rest(&turn.station, start, VerticalChannel::Held);
    let mut truth: NavState = *navigator.state();
    for sample in constant_motion(&turn, TIME).samples(0.01) {
        navigator.step(&sensors.measured(&sample.increments));
    }
    truth.nav_from_body = turn.nav_from_body(TIME);
    let navigated = NavErrors::between(navigator.state(), &truth);
    let (attitude, velocity) = flat_run(&turn, &errors, &NavErrors::none(), TIME);
    // The ratio of the Earth's rate to the table's is 4e-4, and its angle over two seconds is 1.5e-4.
    let off = (navigated.attitude.components() - attitude).norm();
    assert!(off < 6e-4 * attitude.norm(), "{off:e} of {:e}", attitude.norm());
    let off = (navigated.velocity.components() - velocity).norm();
    assert!(off < 1e-3 * velocity.norm(), "{off:e} of {:e}", velocity.norm());

    let sign = |sign| ClosedForm::new(turn, errors, sign).velocity_error(TIME).total();
    let off = |by: InFrame<Nav>| (by - navigated.velocity).norm() / velocity.norm();
    assert!(off(sign(Sign::Strapdown)) < 0.02);
    assert!((off(sign(Sign::Printed)) - 2.0).abs() < 0.02);
}

#[test]
fn table_that_stands_drives_nothing() {
    let turn = ConstantTurn { rate: 0.0, ..paper_turn() };
    let form = ClosedForm::new(turn, paper_errors(), Sign::Strapdown);
    assert!(form.attitude_error(100.0).norm() < 1e-300);
    assert!(form.velocity_error(100.0).total().norm() < 1e-15);
    let flat = flat_navigation(&turn, &paper_errors(), &NavErrors::none(), 100.0);
    assert!(flat.velocity.norm() < 1e-12 && flat.attitude.norm() < 1e-15);
}
