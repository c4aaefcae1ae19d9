//! Faults of a finished log.

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use crate::effect::Law;
use crate::random::Random;
use crate::run::Log;

/// The laws of this file.
pub(crate) const LAWS: &[(&str, Law)] = &[
    (
        "gyro_saturation",
        Law::Spoil(|p, _, log, _| {
            for rate in &mut log.gyro {
                rate.apply(|x| *x = x.clamp(-p[0], p[0]));
            }
        }),
    ),
    (
        "accel_saturation",
        Law::Spoil(|p, _, log, _| {
            for force in &mut log.accel {
                force.apply(|x| *x = x.clamp(-p[0], p[0]));
            }
        }),
    ),
    ("timestamp_jitter", Law::Spoil(jitter)),
    ("outliers", Law::Spoil(outliers)),
    ("stuck_samples", Law::Spoil(stuck)),
];

/// Jitter: the encoder is read some time before or after its time stamp.
fn jitter(p: &[f64], _: &[f64], log: &mut Log, random: &mut Random) {
    let true_angles = log.angles.clone();
    let interval = log.times[1] - log.times[0];
    for (place, angle) in log.angles.iter_mut().enumerate() {
        let normal: f64 = StandardNormal.sample(random);
        let shift = p[0] * normal / interval;
        let neighbour = if shift < 0.0 { place.saturating_sub(1) } else { place + 1 };
        let towards = true_angles[neighbour.min(true_angles.len() - 1)] - true_angles[place];
        *angle += shift.abs() * towards;
    }
}

/// Spikes.
fn outliers(p: &[f64], _: &[f64], log: &mut Log, random: &mut Random) {
    for (list, sigma) in [(&mut log.gyro, p[1]), (&mut log.accel, p[2])] {
        for reading in list.iter_mut().flatten() {
            if random.random::<f64>() < p[0] {
                let normal: f64 = StandardNormal.sample(random);
                *reading += sigma * normal;
            }
        }
    }
}

/// Repetitions of the last sample.
fn stuck(p: &[f64], s: &[f64], log: &mut Log, random: &mut Random) {
    let mut left = 0.0;
    for place in 1..log.times.len() {
        if left < 0.5 && random.random::<f64>() < p[0] / s[0] {
            left = s[0];
        }
        if left > 0.5 {
            left -= 1.0;
            log.gyro[place] = log.gyro[place - 1];
            log.accel[place] = log.accel[place - 1];
        }
    }
}
