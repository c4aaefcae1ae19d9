//! Accelerometer errors.

use nalgebra::{Matrix3, Vector3};

use super::{Instant, after, axes, thermal};
use crate::effect::{Law, Read};

/// The table rate to which the vibration rectification parameter refers \[rad/s\].
const TEN_DEGREES: f64 = 10.0 * std::f64::consts::PI / 180.0;

/// The laws of this file.
pub(crate) const LAWS: &[(&str, Law)] = &[
    ("accel_bias_step", Law::Sense(|p, s, now| accel(axes(p) * after(s[0], now.time)))),
    ("accel_bias_ramp", Law::Sense(|p, _, now| accel(axes(p) * now.time))),
    ("accel_warmup", Law::Sense(|p, s, now| accel(axes(p) * (-now.time / s[0]).exp()))),
    ("accel_thermal_bias", Law::Sense(|p, _, now| accel(axes(p) * now.warming))),
    ("accel_thermal_polynomial", Law::Sense(|p, _, now| accel(thermal(p, now)))),
    ("accel_thermal_lag", Law::Soak(|p, behind| accel(axes(p) * behind))),
    (
        "accel_vibration_rectification",
        Law::Sense(|p, s, now| accel(axes(p) * (now.rate.abs() / TEN_DEGREES).powf(s[0]))),
    ),
    (
        "accel_quadratic",
        Law::Sense(|p, _, now| accel(axes(p).component_mul(&now.force.map(|f| f.powi(2))))),
    ),
    (
        "accel_cubic",
        Law::Sense(|p, _, now| accel(axes(p).component_mul(&now.force.map(|f| f.powi(3))))),
    ),
    (
        "accel_asymmetry",
        Law::Sense(|p, _, now| accel(axes(p).component_mul(&now.force.map(f64::abs)))),
    ),
    ("accel_cross_coupling", Law::Sense(cross_coupling)),
    ("accel_lever_arm", Law::Places(|p| [Vector3::new(p[0], p[1], 0.0); 3])),
    (
        "accel_size_effect",
        Law::Places(|p| {
            [Vector3::new(p[0], p[1], 0.0), Vector3::new(p[2], p[3], 0.0), Vector3::zeros()]
        }),
    ),
    ("accel_latency", Law::Delay(|p| (0.0, p[0]))),
];

fn accel(error: Vector3<f64>) -> Read {
    (Vector3::zeros(), error)
}

/// The force along an axis, multiplied by the product of a matrix without diagonal and the force.
fn cross_coupling(p: &[f64], _: &[f64], now: &Instant) -> Read {
    let turned = Matrix3::new(0.0, p[0], p[1], p[2], 0.0, p[3], p[4], p[5], 0.0);
    accel((turned * now.force).component_mul(&now.force))
}
