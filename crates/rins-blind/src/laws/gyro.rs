//! Gyro errors of time, temperature and rate.

use nalgebra::Vector3;

use super::{Instant, after, axes, thermal};
use crate::effect::{Law, Read};

/// The laws of this file.
pub(crate) const LAWS: &[(&str, Law)] = &[
    ("gyro_bias_step", Law::Sense(|p, s, now| gyro(axes(p) * after(s[0], now.time)))),
    ("gyro_bias_ramp", Law::Sense(|p, _, now| gyro(axes(p) * now.time))),
    ("gyro_warmup", Law::Sense(|p, s, now| gyro(axes(p) * (-now.time / s[0]).exp()))),
    ("gyro_thermal_bias", Law::Sense(|p, _, now| gyro(axes(p) * now.warming))),
    ("gyro_thermal_polynomial", Law::Sense(|p, _, now| gyro(thermal(p, now)))),
    ("gyro_thermal_lag", Law::Soak(|p, behind| gyro(axes(p) * behind))),
    ("gyro_shupe", Law::Sense(|p, _, now| gyro(axes(p) * now.warming_rate))),
    ("gyro_rate_dependent_bias", Law::Sense(rate_dependent_bias)),
    ("gyro_scale_asymmetry", Law::Sense(|p, _, now| z(p[0] * now.turning.z.abs()))),
    (
        "gyro_scale_nonlinearity",
        Law::Sense(|p, _, now| {
            let w = now.turning.z;
            z(w * (p[0] * w.abs() + p[1] * w.powi(2)))
        }),
    ),
    ("gyro_thermal_scale", Law::Sense(|p, _, now| z(p[0] * now.warming * now.turning.z))),
    ("gyro_scale_ramp", Law::Sense(|p, _, now| z(p[0] * now.time * now.turning.z))),
    ("gyro_hysteresis", Law::Sense(|p, _, now| z(p[0] * now.rise))),
    ("gyro_dead_zone", Law::Sense(dead_zone)),
    ("thermal_one_per_turn", Law::Heat),
    ("gyro_lag", Law::Delay(|p| (p[0], 0.0))),
];

/// An error of the gyros alone.
pub(super) fn gyro(error: Vector3<f64>) -> Read {
    (error, Vector3::zeros())
}

fn z(error: f64) -> Read {
    gyro(Vector3::new(0.0, 0.0, error))
}

fn rate_dependent_bias(p: &[f64], _: &[f64], now: &Instant) -> Read {
    let speed = now.rate.abs();
    gyro(axes(p) * speed.powi(2) + Vector3::new(p[3], p[4], 0.0) * speed)
}

/// A dead zone: below its width a gyro reads zero for a rotation about its own axis, or an IMU for one about its body's axis;
/// above it, a lock-in remains.
fn dead_zone(p: &[f64], s: &[f64], now: &Instant) -> Read {
    let rates = if s[0] == 0.0 { now.about_axes } else { now.turning };
    gyro(rates.zip_map(&axes(p), |rate, width| {
        let read = (rate * rate - width * width).max(0.0).sqrt();
        read.copysign(rate) - rate
    }))
}
