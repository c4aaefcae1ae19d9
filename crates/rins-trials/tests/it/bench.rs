//! An experiment that the tests share.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};
use rins_blind::{
    Drive, Encoder, Experiment, Known, Noise, Place, Segment, Sensors, SensorsKnown, Temperature,
};

pub(crate) const DEGREE: f64 = PI / 180.0;

/// A table that turns at these rates \[deg/s\], each for so long \[s\], and an IMU with errors and without noise.
pub(crate) fn experiment(rates: &[f64], each: f64) -> Experiment {
    let segments = rates.iter().map(|rate| Segment { rate: rate * DEGREE, duration: each });
    let sensors = |size: f64, bias: f64| Sensors {
        bias: Vector3::new(0.4, -0.7, 0.9) * bias,
        matrix: Matrix3::new(0.8, -0.3, 0.6, 0.2, -0.9, -0.5, 0.4, 0.7, 0.5) * size,
        noise: Noise::default(),
        rounding: None,
    };
    Experiment {
        place: Place::at(48.0 * DEGREE),
        base_rate: 0.0,
        attitude: [22.0, -11.0, 35.0].map(|angle| angle * DEGREE),
        drive: Drive {
            segments: segments.collect(),
            acceleration: 5.0 * DEGREE,
            rolling: rates.len() == 1,
            lag: 0.03,
            shake: 0.0,
            ripples: Vec::new(),
        },
        mounting: [0.0; 2],
        gyro: sensors(3e-4, 5e-7),
        accel: sensors(2e-4, 1e-3),
        encoder: Encoder { noise: 0.0, resolution: 0.0 },
        temperature: Temperature {
            start: 20.0,
            rise: 2.0,
            settling: 60.0,
            swing: 1.0,
            period: 90.0,
        },
        interval: 0.02,
        substeps: 20,
        effects: Vec::new(),
        unknowns: Vec::new(),
        seed: 1,
    }
}

/// A navigation-grade data sheet.
pub(crate) fn known(experiment: &Experiment) -> Known {
    let sheet =
        |noise, bias, scale, misalignment| SensorsKnown { noise, bias, scale, misalignment };
    Known {
        place: experiment.place,
        attitude: experiment.attitude,
        attitude_sigma: 0.1 * DEGREE,
        gyro: sheet(0.02 * DEGREE / 3600.0, 5e-7, 5e-4, 5e-4),
        accel: sheet(30.0 * 9.80665e-6, 2e-3, 3e-4, 3e-4),
        encoder_noise: 1.5e-6,
        wobble: Some(5e-9),
    }
}
