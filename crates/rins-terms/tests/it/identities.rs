//! Effects that one schedule or all schedules cannot tell apart, since they add the same.

use nalgebra::Vector3;
use rins_frames::units::DEG_PER_SECOND;
use rins_motion::Segment;
use rins_terms::{SettingKind, Signals, TermInstance, catalogue, derivatives};

use crate::support::{Run, run, turning};

fn steady() -> Run {
    turning(&[Segment { rate: 10.0 * DEG_PER_SECOND, duration: 30.0 }])
}

/// The derivatives by parameters, one row a sample, one list of ten numbers each, over a run.
fn columns(run: &Run, id: &str) -> Vec<Vec<f64>> {
    let term = catalogue::term(id).unwrap();
    let chosen = TermInstance::new(term).with_setting(SettingKind::Time, 10.0);
    (0..term.parameters.len())
        .map(|place| {
            // The ramp up is no steady turning.
            let settled = run.track.moments().skip(150);
            settled.flat_map(|moment| numbers(&chosen.signals(&moment, Some(place)))).collect()
        })
        .collect()
}

fn numbers(signals: &Signals) -> [f64; 10] {
    let [gyro, accel, tilt]: [Vector3<f64>; 3] =
        [&signals.gyro, &signals.accel, &signals.tilt].map(derivatives);
    let angle = signals.angle.eps;
    [gyro.x, gyro.y, gyro.z, accel.x, accel.y, accel.z, tilt.x, tilt.y, tilt.z, angle]
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The sine of the angle between what two parameters add.
fn sine(run: &Run, first: (&str, usize), second: (&str, usize)) -> f64 {
    let a = &columns(run, first.0)[first.1];
    let b = &columns(run, second.0)[second.1];
    let along = dot(a, b) / dot(b, b);
    let left: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - along * b).collect();
    (dot(&left, &left) / dot(a, a)).sqrt()
}

/// Effects that a steady turn does not tell apart, and that reversals and other rates do.
#[test]
fn steady_turn_confuses_what_reversals_tell_apart() {
    let (steady, varied) = (steady(), run());
    let pairs = [
        (("gyro.bias", 2), ("gyro.scale", 2)),
        (("gyro.bias", 0), ("gyro.misalignment", 1)),
        (("gyro_bias_ramp", 2), ("gyro_scale_ramp", 0)),
        (("gyro_thermal_bias", 2), ("gyro_thermal_scale", 0)),
        (("gyro.bias", 2), ("gyro_scale_asymmetry", 0)),
        (("dropped_samples", 0), ("encoder_slip", 0)),
        (("encoder_latency", 0), ("encoder.zero", 0)),
        (("encoder_latency", 0), ("encoder_backlash", 0)),
        (("accel_lever_arm", 0), ("accel.bias", 0)),
    ];
    for (first, second) in pairs {
        let (blind, seen) = (sine(&steady, first, second), sine(varied, first, second));
        // Transverse Earth rate turns M_xz's neighbours a little; the Coriolis acceleration the lever arm.
        assert!(blind < 2e-3, "{first:?} and {second:?}: {blind}");
        assert!(seen > 0.1, "{first:?} and {second:?}: {seen}");
    }
}

#[test]
fn cable_and_base_tilt_alike_while_the_table_turns_one_way() {
    let (steady, varied) = (steady(), run());
    let sine = |run: &Run| {
        // A constant tilt is the attitude of the axis: it is taken off both.
        let centred = |id: &str| -> Vec<f64> {
            let column = &columns(run, id)[0];
            let x: Vec<f64> = column.chunks_exact(10).map(|numbers| numbers[6]).collect();
            let mean = x.iter().sum::<f64>() / x.len() as f64;
            x.iter().map(|x| x - mean).collect()
        };
        let (cable, base) = (centred("cable_torque_tilt"), centred("base_tilt_ramp"));
        let cosine = dot(&cable, &base) / (dot(&cable, &cable) * dot(&base, &base)).sqrt();
        (1.0 - cosine * cosine).max(0.0).sqrt()
    };
    assert!(sine(&steady) < 1e-6, "{}", sine(&steady));
    assert!(sine(varied) > 0.1, "{}", sine(varied));
}

#[test]
fn wrong_gravity_is_a_common_scale_error_under_any_schedule() {
    let run = run();
    let gravity = &columns(run, "wrong_gravity")[0];
    let scales = columns(run, "accel.scale");
    for (k, gravity) in gravity.iter().enumerate() {
        assert_eq!(*gravity, scales[0][k] + scales[1][k] + scales[2][k]);
    }
}

#[test]
fn lever_arm_is_a_size_effect_of_equal_places_in_the_plane() {
    let run = run();
    let (arm, size) = (columns(run, "accel_lever_arm"), columns(run, "accel_size_effect"));
    for component in 0..arm[0].len() {
        // All but accelerometer z.
        if component % 10 != 5 {
            assert_eq!(arm[0][component], size[0][component] + size[2][component]);
            assert_eq!(arm[1][component], size[1][component] + size[3][component]);
        }
    }
}

/// A g-sensitivity that is the same along both axes of the plane shifts the azimuth that is found.
#[test]
fn isotropic_g_sensitivity_is_a_vector_fixed_in_the_table() {
    let run = run();
    let columns = columns(run, "gyro_g_sensitivity");
    let around = run.track.surroundings;
    for (k, moment) in run.track.moments().skip(150).enumerate() {
        let isotropic: Vec<f64> =
            (0..3).map(|j| columns[0][10 * k + j] + columns[4][10 * k + j]).collect();
        let fixed = moment.in_body(&around.specific_force);
        // The mean over a sample is shorter than the vector by up to 8e-6 of it.
        assert!((isotropic[0] - fixed.x).abs() < 1e-4 && (isotropic[1] - fixed.y).abs() < 1e-4);
    }
}
