//! Effects of the site, the building and the power line.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::Instant;
use crate::effect::{Law, Read};

/// The laws of this file.
pub(crate) const LAWS: &[(&str, Law)] = &[
    ("wrong_latitude", Law::Setup(|p, _, experiment| experiment.place.latitude += p[0])),
    ("wrong_gravity", Law::Setup(|p, _, experiment| experiment.place.gravity *= 1.0 + p[0])),
    ("base_rotation", Law::Setup(|p, _, experiment| experiment.base_rate += p[0])),
    ("interference_line", Law::Sense(line)),
];

/// A spectral line on one axis, of gyro and accelerometer.
fn line(p: &[f64], s: &[f64], now: &Instant) -> Read {
    let (sin, cos) = (TAU * s[0] * now.time).sin_cos();
    let axis = if s[1] < 1.5 {
        Vector3::x()
    } else if s[1] < 2.5 {
        Vector3::y()
    } else {
        Vector3::z()
    };
    (axis * (p[0] * cos + p[1] * sin), axis * (p[2] * cos + p[3] * sin))
}
