//! True motions of the table and of its base.

use std::f64::consts::{PI, TAU};

use nalgebra::{Complex, Vector3};

use crate::drive::Ripple;
use crate::effect::Law;

/// The minimum duration of a tilt step of the base \[s\].
const STEP_TIME: f64 = 0.02;

/// The laws of this file.
pub(crate) const LAWS: &[(&str, Law)] = &[
    (
        "table_wobble",
        Law::Tilt(|p, s, pose| {
            let tilt = Complex::new(p[0], p[1]) * Complex::from_polar(1.0, s[0] * pose.angle);
            Vector3::new(tilt.re, tilt.im, 0.0)
        }),
    ),
    ("cable_torque_tilt", Law::Tilt(|p, _, pose| Vector3::new(p[0], p[1], 0.0) * pose.angle)),
    ("base_tilt_ramp", Law::Tilt(|p, _, pose| Vector3::new(p[0], p[1], 0.0) * pose.time)),
    (
        "base_tilt_step",
        Law::Tilt(|p, s, pose| {
            Vector3::new(p[0], p[1], p[2]) * smooth_step(pose.time - s[0], s[1].max(STEP_TIME))
        }),
    ),
    (
        "base_sway",
        Law::Tilt(|p, s, pose| {
            let (sin, cos) = (TAU * s[0] * pose.time).sin_cos();
            Vector3::from_fn(|axis, _| p[2 * axis] * cos + p[2 * axis + 1] * sin)
        }),
    ),
    (
        "table_rate_ripple",
        Law::Setup(|p, s, experiment| {
            experiment.drive.ripples.push(Ripple { order: s[0], cos: p[0], sin: p[1] });
        }),
    ),
];

/// A smooth step from 0 to 1, centered at time zero, with this duration.
fn smooth_step(time: f64, duration: f64) -> f64 {
    let part = (time / duration + 0.5).clamp(0.0, 1.0);
    0.5 - 0.5 * (PI * part).cos()
}
