//! Noise that differs from the data sheet.

use crate::effect::Law;
use crate::experiment::{Rounding, Sensors};

/// The laws of this file.
pub(crate) const LAWS: &[(&str, Law)] = &[
    ("gyro_noise_level", Law::Setup(|p, _, all| all.gyro.noise.white *= 1.0 + p[0])),
    ("accel_noise_level", Law::Setup(|p, _, all| all.accel.noise.white *= 1.0 + p[0])),
    ("gyro_bias_instability", Law::Setup(|p, _, all| flicker(&mut all.gyro, p[0]))),
    ("accel_bias_instability", Law::Setup(|p, _, all| flicker(&mut all.accel, p[0]))),
    ("gyro_rate_random_walk", Law::Setup(|p, _, all| walk(&mut all.gyro, p[0]))),
    ("accel_rate_random_walk", Law::Setup(|p, _, all| walk(&mut all.accel, p[0]))),
    ("gyro_quantisation", Law::Setup(|p, _, all| round(&mut all.gyro, p))),
    ("accel_quantisation", Law::Setup(|p, _, all| round(&mut all.accel, p))),
];

/// Two independent sources.
fn flicker(sensors: &mut Sensors, level: f64) {
    sensors.noise.flicker = (sensors.noise.flicker.powi(2) + level.powi(2)).sqrt();
}

fn walk(sensors: &mut Sensors, density: f64) {
    sensors.noise.walk = (sensors.noise.walk.powi(2) + density.powi(2)).sqrt();
}

fn round(sensors: &mut Sensors, p: &[f64]) {
    sensors.rounding = if p[0] > 0.0 {
        Some(Rounding::Increment(p[0]))
    } else {
        (p[1] > 0.0).then_some(Rounding::Mean(p[1]))
    };
}
