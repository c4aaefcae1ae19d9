//! Terms carried from one set of axes to another and back, and the names that parameters have there.

use nalgebra::Vector3;
use proptest::prelude::*;
use rins_frames::units::DEG;
use rins_frames::{EulerAngles, SignedAxes, Site};
use rins_motion::Station;
use rins_testing::assert_close;

use super::{own_channel, sign_of};
use crate::catalogue::{self, CATALOGUE};
use crate::kinematic_state::{Instant, KinematicState};
use crate::model::{Model, Role, TermInstance};
use crate::setting::SettingKind;
use crate::signals::values;
use crate::surroundings::Surroundings;
use crate::term::Parity;

fn about(source: [usize; 3], sign: [f64; 3]) -> SignedAxes {
    SignedAxes { source, sign }
}

/// The 24 proper rotations that take axes to axes.
fn rotations() -> Vec<SignedAxes> {
    let orders = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
    let signs =
        (0..8_u8).map(|bits| [0, 1, 2].map(|k| if bits >> k & 1 == 1 { -1.0 } else { 1.0 }));
    let all = signs.flat_map(|sign| orders.map(|source| about(source, sign)));
    all.filter(|axes| axes.matrix().determinant() > 0.0).collect()
}

/// A moment at which an IMU feels this.
fn moment(rate: Vector3<f64>, force: Vector3<f64>) -> KinematicState<'static> {
    let site = Site { latitude: 0.6, longitude: 0.0, height: 0.0 };
    let attitude = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 0.0 };
    let still =
        Instant { time: 3.0, temperature: Some(25.0), warming_rate: 0.1, ..Instant::default() };
    KinematicState {
        sample: 0,
        interval: 0.01,
        duration: 10.0,
        mean: still,
        end: still,
        rate,
        force,
        surroundings: Surroundings::new(Station::with_normal_gravity(site), attitude.dcm()),
        track: None,
    }
}

/// Terms that know of no axis of rotation: what they do is the same whichever it is.
fn of_the_sensors() -> Vec<TermInstance> {
    [
        &catalogue::GYRO_BIAS,
        &catalogue::GYRO_SCALE,
        &catalogue::GYRO_MISALIGNMENT,
        &catalogue::ACCEL_BIAS,
        &catalogue::ACCEL_SCALE,
        &catalogue::ACCEL_MISALIGNMENT,
        &catalogue::GYRO_BIAS_STEP,
        &catalogue::GYRO_BIAS_RAMP,
        &catalogue::GYRO_WARMUP,
        &catalogue::GYRO_THERMAL_BIAS,
        &catalogue::GYRO_SHUPE,
        &catalogue::GYRO_DEAD_ZONE,
        &catalogue::GYRO_G_SENSITIVITY,
        &catalogue::GYRO_G2_SENSITIVITY,
        &catalogue::ACCEL_BIAS_STEP,
        &catalogue::ACCEL_BIAS_RAMP,
        &catalogue::ACCEL_WARMUP,
        &catalogue::ACCEL_THERMAL_BIAS,
        &catalogue::ACCEL_QUADRATIC,
        &catalogue::ACCEL_CUBIC,
        &catalogue::ACCEL_ASYMMETRY,
        &catalogue::ACCEL_CROSS_COUPLING,
        &catalogue::INTERFERENCE_LINE,
    ]
    .map(TermInstance::new)
    .to_vec()
}

proptest! {
    /// An error is the sensor's: along other axes other numbers describe the same.
    #[test]
    fn carried_terms_do_the_same_to_the_sensors(
        which in 0..24_usize,
        rate in prop::array::uniform3(-3.0..3.0_f64),
        force in prop::array::uniform3(-20.0..20.0_f64),
        numbers in prop::array::uniform18(-1.0..1.0_f64),
        axis in 1..=3_u8,
    ) {
        let axes = rotations()[which];
        let (rate, force) = (Vector3::from(rate), Vector3::from(force));
        for chosen in of_the_sensors() {
            let n = chosen.values.len();
            let chosen = chosen.with_values(&numbers[..n]).with_setting(SettingKind::Axis, f64::from(axis));
            let carried = chosen.carried(&axes);
            let there = carried.signals(&moment(axes.apply(&rate), axes.apply(&force)), None);
            let here = chosen.signals(&moment(rate, force), None);
            let id = chosen.term.id;
            let scale = 1e-12 * (values(&here.gyro).norm() + values(&here.accel).norm() + 1.0);
            let off = [
                values(&there.gyro) - axes.apply(&values(&here.gyro)),
                values(&there.accel) - axes.apply(&values(&here.accel)),
            ];
            prop_assert!(off.iter().all(|off| off.norm() < scale), "{id}: {off:?}");
            prop_assert_eq!(carried.carried(&axes.inverse()), chosen, "{}: there and back", id);
        }
    }

    /// A lever arm is a vector: the axis of rotation is turned along with it, here about itself and to its other end.
    #[test]
    fn lever_arms_follow_a_table_that_is_seen_from_its_other_end(
        arm in prop::array::uniform2(-0.3..0.3_f64),
        places in prop::array::uniform4(-0.3..0.3_f64),
        spin in -6.0..6.0_f64,
        acceleration in -3.0..3.0_f64,
        flip in any::<bool>(),
        swap in any::<bool>(),
    ) {
        let end = if flip { -1.0 } else { 1.0 };
        // A proper rotation that keeps z or reverses it.
        let axes = if swap {
            about([1, 0, 2], [1.0, -end, end])
        } else {
            about([0, 1, 2], [1.0, end, end])
        };
        prop_assert!(axes.matrix().determinant() > 0.0);
        let turning = |end: f64| {
            let rate = Vector3::z() * (spin * end);
            let mut moment = moment(rate, Vector3::z());
            for instant in [&mut moment.mean, &mut moment.end] {
                (instant.rate, instant.acceleration) = (spin * end, acceleration * end);
            }
            moment
        };
        for chosen in [
            TermInstance::new(&catalogue::ACCEL_LEVER_ARM).with_values(&arm),
            TermInstance::new(&catalogue::ACCEL_SIZE_EFFECT).with_values(&places),
        ] {
            let here = values(&chosen.signals(&turning(1.0), None).accel);
            let there = values(&chosen.carried(&axes).signals(&turning(end), None).accel);
            prop_assert!((there - axes.apply(&here)).norm() < 1e-12 * (1.0 + here.norm()));
        }
    }
}

#[test]
fn what_spins_about_x_has_its_names_along_x() {
    let axes = about([1, 2, 0], [1.0; 3]);
    let model = Model::full().with(TermInstance::new(&catalogue::GYRO_SCALE_NONLINEARITY));
    let own = |id: &str| {
        let (term, parameter) = model.find(id).unwrap();
        model.own_id(term, parameter, &axes)
    };
    assert_eq!(own("gyro.scale.z"), "gyro.scale.x");
    assert_eq!(own("gyro.misalignment.xz"), "gyro.misalignment.yx");
    assert_eq!(own("gyro.bias.x"), "gyro.bias.y");
    assert_eq!(own("gyro_scale_nonlinearity.k2_z"), "gyro_scale_nonlinearity.k2_x");
    assert_eq!(own("axis.attitude.x"), "axis.attitude.x");
    for id in model.ids() {
        assert_eq!(model.find_own(&own(&id), &axes), model.find(&id), "{id}");
    }
    assert_eq!(model.find_own("gyro_scale_nonlinearity.k2_z", &axes), None);
    assert_eq!(own_channel("accel.y", &axes), "accel.z");
    let order: Vec<&str> = catalogue::GYRO_RATE_DEPENDENT_BIAS
        .own_order(&axes)
        .into_iter()
        .map(|place| catalogue::GYRO_RATE_DEPENDENT_BIAS.parameters[place].name)
        .collect();
    assert_eq!(order, ["square_z", "square_x", "square_y", "linear_x", "linear_y"]);
}

#[test]
fn what_another_run_has_not_starts_at_nothing_in_the_same_role() {
    let axes = about([1, 2, 0], [1.0; 3]);
    let chosen =
        TermInstance::new(&catalogue::GYRO_SCALE_ASYMMETRY).with_values(&[1e-6]).estimated();
    let carried = chosen.carried(&axes);
    assert_eq!((carried.values[0], carried.roles[0]), (0.0, Role::Free));
    assert_eq!(chosen.without_place(&axes), ["z"]);
    assert!(chosen.without_place(&SignedAxes::IDENTITY).is_empty());
}

/// A name that no run could have would be a parameter that nobody could ask for.
#[test]
fn own_names_are_unique_and_lead_back() {
    for term in CATALOGUE {
        for axes in rotations() {
            let names = term.own_names(&axes);
            for (place, name) in names.iter().enumerate() {
                assert_eq!(term.find_own(name, &axes), Some(place), "{}.{name}", term.id);
            }
            let mut order = term.own_order(&axes);
            if axes == SignedAxes::IDENTITY {
                assert!(order.is_sorted(), "{}", term.id);
            }
            order.sort_unstable();
            assert!(order.into_iter().eq(0..names.len()), "{}", term.id);
        }
    }
}

/// Every parameter with an axis in its name that is an output of gyros or accelerometers follows the axes.
#[test]
fn what_is_named_after_the_sensors_axes_follows_them() {
    let half_turn = about([0, 1, 2], [1.0, -1.0, -1.0]);
    assert_close!(sign_of("x_yz", Parity::Tensor, &half_turn), 1.0, 1e-15);
    assert_close!(sign_of("x_xy", Parity::Tensor, &half_turn), -1.0, 1e-15);
    assert_close!(sign_of("xy", Parity::LastAxis, &half_turn), -1.0, 1e-15);
    assert_close!(sign_of("y", Parity::Even, &half_turn), 1.0, 1e-15);
    for term in CATALOGUE.iter().filter(|term| term.parity == Parity::Unchanged) {
        let of_sensor = term.id.starts_with("gyro") || term.id.starts_with("accel");
        let names = term.parameters.iter().map(|parameter| parameter.name);
        let mut with_axes =
            names.filter(|name| name.split('_').any(|t| super::axes_of(t).is_some()));
        assert!(!of_sensor || with_axes.next().is_none(), "{}", term.id);
    }
}
