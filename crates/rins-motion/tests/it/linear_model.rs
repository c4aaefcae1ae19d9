//! The linear model on the round, rotating Earth, compared with whole runs of the navigator.

use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use rins_frames::units::{DEG, DEG_PER_HOUR, MICRO_G, PPM};
use rins_frames::{Body, Dcm, InFrame, Nav, Table};
use rins_motion::mechanism::{
    ClosedForm, ConstantTurn, LinearModel, NavErrors, Neglected, SensorErrors, Sign, Terms, cost,
};
use rins_motion::{NavState, Navigator, VerticalChannel};
use rins_testing::assert_close;

use crate::support::{
    any_attitude, any_rate, any_spin_axis_errors, any_turn, any_vector, constant_motion,
    paper_errors, paper_turn, scaled, station,
};

const DURATION: f64 = 360.0;

/// The model is exact in time; the navigator has intervals of 0.02 s, and rotations within them.
const AGREEMENT: f64 = 3e-4;

/// Computed states after a run on perfect and on erroneous increments; their difference does not contain the error of the
/// navigator's finite interval.
fn navigated(
    turn: &ConstantTurn,
    vertical: VerticalChannel,
    initial: &NavErrors,
    sensors: &SensorErrors,
    duration: f64,
) -> NavErrors {
    let off = -*initial.attitude.components();
    let truth = NavState {
        position: turn.station.site,
        velocity: InFrame::zeros(),
        nav_from_body: turn.nav_from_body(0.0),
    };
    let mut start = truth;
    start.nav_from_body = Dcm::<Nav, Nav>::from_rotation_vector(&off) * truth.nav_from_body;
    start.velocity = initial.velocity;
    start.position.latitude += initial.latitude;
    start.position.longitude += initial.longitude;
    start.position.height += initial.height;
    let mut perfect = Navigator::new(truth, &turn.station, vertical);
    let mut erroneous = Navigator::new(start, &turn.station, vertical);
    for sample in constant_motion(turn, duration).samples(0.02) {
        perfect.step(&sample.increments);
        erroneous.step(&sensors.measured(&sample.increments));
    }
    NavErrors::between(erroneous.state(), perfect.state())
}

/// The relative difference of two sets of errors, each kind relative to its own size.
///
/// Below the floors the difference of two runs is due to rounding.
fn apart(got: &NavErrors, want: &NavErrors) -> f64 {
    const ATTITUDE_FLOOR: f64 = 1e-9;
    const VELOCITY_FLOOR: f64 = 1e-6;
    const PLACE_FLOOR: f64 = 1e-4;
    let off = *got - *want;
    let place = |e: &NavErrors| Vector3::new(e.latitude * 6.4e6, e.longitude * 6.4e6, e.height);
    let attitude = off.attitude.norm() / want.attitude.norm().max(ATTITUDE_FLOOR);
    let velocity = off.velocity.norm() / want.velocity.norm().max(VELOCITY_FLOOR);
    attitude.max(velocity).max(place(&off).norm() / place(want).norm().max(PLACE_FLOOR))
}

fn scaled_sensors(sensors: &SensorErrors, factor: f64) -> SensorErrors {
    SensorErrors {
        gyro_bias: sensors.gyro_bias * factor,
        gyro_matrix: sensors.gyro_matrix * factor,
        accel_bias: sensors.accel_bias * factor,
        accel_matrix: sensors.accel_matrix * factor,
    }
}

/// All 24 errors, of the size of those of a navigation-grade IMU.
fn any_sensors() -> impl Strategy<Value = SensorErrors> {
    let matrix = |size| {
        [any_vector(size), any_vector(size), any_vector(size)]
            .prop_map(|columns| Matrix3::from_columns(&columns))
    };
    (
        any_vector(0.1 * DEG_PER_HOUR),
        matrix(300.0 * PPM),
        any_vector(100.0 * MICRO_G),
        matrix(300.0 * PPM),
    )
        .prop_map(|(gyro_bias, gyro_matrix, accel_bias, accel_matrix)| SensorErrors {
            gyro_bias: InFrame::from_components(gyro_bias),
            gyro_matrix,
            accel_bias: InFrame::from_components(accel_bias),
            accel_matrix,
        })
}

fn any_initial() -> impl Strategy<Value = NavErrors> {
    (any_vector(1e-3), any_vector(0.5), any_vector(1.0)).prop_map(|(attitude, velocity, place)| {
        NavErrors {
            attitude: InFrame::from_components(attitude),
            velocity: InFrame::new(velocity.x, velocity.y, 0.0),
            latitude: place.x * 1e-5,
            longitude: place.y * 1e-5,
            height: 0.0,
        }
    })
}

fn any_vertical() -> impl Strategy<Value = VerticalChannel> {
    prop_oneof![Just(VerticalChannel::Free), Just(VerticalChannel::Held)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// All errors together, a thousand times smaller, so that only the first order is visible.
    #[test]
    fn small_errors_of_a_navigator_are_those_of_the_model(
        turn in (-1.2..1.2_f64, any_attitude(), any_rate()).prop_map(
            |(latitude, nav_from_table, rate)| ConstantTurn {
                station: station(latitude),
                nav_from_table,
                rate,
            },
        ),
        vertical in any_vertical(),
        initial in any_initial(),
        sensors in any_sensors(),
    ) {
        let initial = initial * 1e-3;
        let sensors = scaled_sensors(&sensors, 1e-3);
        let model = LinearModel::new(turn, vertical).propagate(&initial, &sensors, DURATION);
        let run = navigated(&turn, vertical, &initial, &sensors, DURATION);
        let off = apart(&model, &run);
        prop_assert!(off < AGREEMENT, "{off:e} apart: {model:?} for {run:?}");
    }

    /// The model without its three terms is another form of the closed form.
    #[test]
    fn model_of_a_flat_earth_is_the_closed_form(
        turn in any_turn(),
        errors in any_spin_axis_errors(),
        tilt in any_vector(1e-3),
        kick in any_vector(1.0),
        time in 1.0..400.0_f64,
    ) {
        let initial = NavErrors {
            attitude: InFrame::from_components(tilt),
            velocity: InFrame::from_components(kick),
            ..NavErrors::none()
        };
        let form = ClosedForm {
            initial_attitude: initial.attitude,
            initial_velocity: initial.velocity,
            ..ClosedForm::new(turn, errors, Sign::Strapdown)
        };
        let model = LinearModel::with_terms(turn, VerticalChannel::Held, Terms::NONE)
            .propagate(&initial, &errors.into(), time);
        // The matrix exponential of a few hundred radians loses four digits of sixteen.
        let off = (model.attitude - form.attitude_error(time)).norm();
        prop_assert!(off < 1e-12, "{off:e} rad");
        let off = (model.velocity - form.velocity_error(time).total()).norm();
        prop_assert!(off < 1e-9, "{off:e} m/s");
    }

    /// Two parts of a run, the second from the table angle at the end of the first.
    #[test]
    fn parts_of_a_run_make_the_run(
        turn in any_turn(),
        vertical in any_vertical(),
        initial in any_initial(),
        sensors in any_sensors(),
        times in [1.0..300.0_f64, 1.0..300.0_f64],
    ) {
        let whole = LinearModel::new(turn, vertical);
        let first = whole.propagate(&initial, &sensors, times[0]);
        let angle = turn.rate * times[0];
        let later = ConstantTurn {
            nav_from_table: turn.nav_from_table * Dcm::<Table, Table>::about_z(angle),
            ..turn
        };
        let both = LinearModel::new(later, vertical).propagate(&first, &sensors, times[1]);
        let off = apart(&both, &whole.propagate(&initial, &sensors, times[0] + times[1]));
        prop_assert!(off < 1e-10, "{off:e} apart");
    }
}

/// Each sensor error and each initial error alone, so that none is hidden by a larger one.
#[test]
fn each_error_alone_is_that_of_a_navigator() {
    // Not whole revolutions, after which most of these errors have almost no effect.
    const DURATION: f64 = 355.0;
    let turn = paper_turn();
    let mut cases: Vec<(String, NavErrors, SensorErrors)> = Vec::new();
    let none = (NavErrors::none(), SensorErrors::none());
    for axis in 0..3 {
        let unit = InFrame::<Body>::from_components(Vector3::ith(axis, 1.0));
        let unit_n = InFrame::<Nav>::from_components(*unit.components());
        let gyro = SensorErrors { gyro_bias: unit * 1e-8, ..none.1 };
        let accel = SensorErrors { accel_bias: unit * 1e-5, ..none.1 };
        let tilt = NavErrors { attitude: unit_n * 1e-5, ..none.0 };
        let kick = NavErrors { velocity: unit_n * 1e-3, ..none.0 };
        cases.push((format!("gyro bias {axis}"), none.0, gyro));
        cases.push((format!("accelerometer bias {axis}"), none.0, accel));
        cases.push((format!("attitude {axis}"), tilt, none.1));
        cases.push((format!("velocity {axis}"), kick, none.1));
        for column in 0..3 {
            // The first two columns are multiplied only by the Earth's rate: they must be larger to be visible.
            let size = if column == 2 { 1e-7 } else { 5e-4 };
            let matrix = Matrix3::from_fn(|i, j| if (i, j) == (axis, column) { 1.0 } else { 0.0 });
            let gyro = SensorErrors { gyro_matrix: matrix * size, ..none.1 };
            let accel = SensorErrors { accel_matrix: matrix * 1e-4, ..none.1 };
            cases.push((format!("gyro matrix {axis} {column}"), none.0, gyro));
            cases.push((format!("accelerometer matrix {axis} {column}"), none.0, accel));
        }
    }
    cases.push(("latitude".into(), NavErrors { latitude: 1e-6, ..none.0 }, none.1));
    cases.push(("height".into(), NavErrors { height: 1.0, ..none.0 }, none.1));
    for vertical in [VerticalChannel::Free, VerticalChannel::Held] {
        for (name, initial, sensors) in &cases {
            let model = LinearModel::new(turn, vertical).propagate(initial, sensors, DURATION);
            let run = navigated(&turn, vertical, initial, sensors, DURATION);
            let off = apart(&model, &run);
            assert!(off < AGREEMENT, "{name}, {vertical:?}: {off:e} apart");
        }
    }
}

/// The paper's run with errors `factor` times the paper's: the navigator, and the model.
fn paper_run(factor: f64) -> (NavErrors, NavErrors) {
    let turn = paper_turn();
    let sensors = SensorErrors::from(scaled(&paper_errors(), factor));
    let none = NavErrors::none();
    let model = LinearModel::new(turn, VerticalChannel::Held).propagate(&none, &sensors, DURATION);
    (navigated(&turn, VerticalChannel::Held, &none, &sensors, DURATION), model)
}

/// The reference values are from a numerical model that has no code in common with this one.
#[test]
fn navigator_has_the_reference_velocities_and_angles() {
    let (run, _) = paper_run(1.0);
    assert_close!(run.velocity.components().x, 2.971, 1e-3);
    assert_close!(run.velocity.components().y, -17.432, 1e-3);
    let angles = run.of_euler_angles(paper_turn().nav_from_body(DURATION));
    assert_close!(angles.roll / DEG, -0.3327, 1e-4);
    assert_close!(angles.pitch / DEG, 0.5120, 1e-4);
    assert_close!(angles.yaw / DEG, 0.9985, 1e-4);
}

#[test]
fn model_holds_to_a_thousandth_where_errors_are_small() {
    let (run, model) = paper_run(0.01);
    let off = apart(&model, &run);
    assert!(off < 1e-3, "{off:e} apart");
    let v = (model.velocity - run.velocity, run.velocity);
    assert!(v.0.components().x.abs() < 1e-3 * v.1.components().x.abs());
}

/// For errors of the paper's size the model lacks their second order, (0.101, 0.010) m/s: a quarter of it at half the size,
/// and all but a fiftieth of it equals that of a flat Earth.
#[test]
fn what_the_model_lacks_is_of_second_order() {
    let lacks = |factor| {
        let (run, model) = paper_run(factor);
        run.velocity - model.velocity
    };
    let whole = lacks(1.0);
    assert_close!(whole.components().x, 0.1009, 2e-4);
    assert_close!(whole.components().y, 0.0101, 2e-4);
    let not_second = (lacks(0.5) * 4.0 - whole).norm();
    assert!(not_second < 0.01 * whole.norm(), "{not_second:e}");
    let on_flat = cost(Neglected::SecondOrder, &paper_turn(), &paper_errors(), DURATION);
    let not_flat = (on_flat.velocity + whole).norm();
    assert!(not_flat < 0.021 * whole.norm(), "{not_flat:e}");
}

/// With the second order of the flat Earth added, the model has the navigator's velocity to 0.1 % for errors of the paper's
/// size.
#[test]
fn model_and_flat_second_order_make_the_reference_run() {
    let (run, model) = paper_run(1.0);
    let second = cost(Neglected::SecondOrder, &paper_turn(), &paper_errors(), DURATION);
    let predicted = model.velocity - second.velocity;
    for axis in 0..2 {
        let (got, want) = (predicted.components()[axis], run.velocity.components()[axis]);
        assert_close!(got, want, 1e-3 * want.abs());
    }
}

/// The table in the documentation of the module.
#[test]
fn each_approximation_costs_what_the_documentation_says() {
    let (turn, errors) = (paper_turn(), paper_errors());
    let printed = [
        (Neglected::EarthRate, 0.082, -0.184),
        (Neglected::TransportRate, 0.050, -0.275),
        (Neglected::Coriolis, 0.166, 0.030),
        (Neglected::SecondOrder, -0.103, -0.011),
    ];
    let mut sum = Vector3::zeros();
    for (neglected, east, north) in printed {
        let cost = cost(neglected, &turn, &errors, DURATION);
        assert_close!(cost.velocity.components().x, east, 5.1e-4);
        assert_close!(cost.velocity.components().y, north, 5.1e-4);
        sum += cost.velocity.components();
    }
    let form = ClosedForm::new(turn, errors, Sign::Strapdown).velocity_error(DURATION).total();
    assert_close!(form.components().x, 3.174, 5.1e-4);
    assert_close!(form.components().y, -17.872, 5.1e-4);
    // 0.203 and -0.440 m/s; the sum of the single effects differs by 0.008.
    let (run, _) = paper_run(1.0);
    let off = form - run.velocity;
    assert_close!(off.components().x / run.velocity.components().x, 0.068, 5.1e-4);
    assert!((off.components() - sum).norm() < 0.01);
}

#[test]
fn errors_of_euler_angles_are_the_errors_of_their_rotation() {
    let turn = paper_turn();
    let truth = turn.nav_from_body(0.0);
    // About the vertical, only yaw; the computed attitude is rotated opposite to φ.
    let about_up = NavErrors { attitude: InFrame::new(0.0, 0.0, 1e-3), ..NavErrors::none() };
    let angles = about_up.of_euler_angles(truth);
    assert_close!(angles.yaw, -1e-3, 1e-12);
    assert_close!(angles.roll, 1e-300, 1e-12);
    assert_close!(angles.pitch, 1e-300, 1e-12);
    // The error stays small across ±π.
    let back = Dcm::<Nav, Body>::about_z(179.99 * DEG);
    let over = NavErrors { attitude: InFrame::new(0.0, 0.0, -1e-3), ..NavErrors::none() };
    assert_close!(over.of_euler_angles(back).yaw, 1e-3, 1e-12);
}
