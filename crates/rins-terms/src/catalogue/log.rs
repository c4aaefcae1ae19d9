//! Faults of a log: stuck samples, outliers, saturation, jitter of the time stamps.

use std::f64::consts::FRAC_1_SQRT_2;

use rins_frames::{Body, InFrame};
use rins_imu::{NormalStream, Seed, Sensor};

use crate::catalogue::parameters::{parameter, usual};
use crate::setting::{Setting, SettingKind};
use crate::term::{Action, Need, Owner, Parameter, Parity, Prevalence, Prior, Term};
use crate::unit::Unit;

/// Random numbers independent of the noise of the sensors.
fn random(seed: Seed) -> NormalStream {
    Seed { seed: seed.seed.rotate_left(32) ^ 0x6c6f_6766_6175_6c74, ..seed }.stream(Sensor::Encoder)
}

/// Draw of an event with this probability.
fn happens(probability: f64, random: &mut NormalStream) -> bool {
    // The distribution function of a normal number is uniformly distributed.
    0.5 * libm::erfc(random.sample() * FRAC_1_SQRT_2) < probability
}

const fn share(high: f64) -> Parameter {
    parameter("share", Unit::ONE, Prior::Anywhere(0.01 * high, high))
}

/// Samples that repeat the previous one.
pub static STUCK_SAMPLES: Term = Term {
    id: "stuck_samples",
    also: &[],
    name: "stuck samples",
    cause: "a driver repeats the last readings if no new ones are available",
    equation: "this fraction of all samples repeats the previous rates and forces",
    source: "definition of a held reading",
    parameters: &[share(0.05)],
    settings: &[Setting {
        kind: SettingKind::SampleCount,
        name: "length",
        meaning: "number of consecutive stuck samples",
        unit: Unit::ONE,
        default: 5.0,
        within: (1.0, 1e5),
    }],
    needs: &[],
    partners: &["accel_quantisation", "gyro_quantisation"],
    told_apart_by: "sequences of equal samples",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Log(|p, settings, seed, recording| {
        let mut random = random(seed);
        let mut left = 0.0;
        for k in 1..recording.len() {
            if left < 1.0 && happens(p[0] / settings[0], &mut random) {
                left = settings[0].round();
            }
            if left >= 1.0 {
                left -= 1.0;
                let interval = recording.increments[k].interval;
                recording.increments[k] = recording.increments[k - 1].rates().over(interval);
            }
        }
    }),
};

/// Outliers.
pub static OUTLIERS: Term = Term {
    id: "outliers",
    also: &[],
    name: "outliers",
    cause: "spikes of the electronics, or mechanical shocks; gyro and accel are their 1σ",
    equation: "a normally distributed error is added to this fraction of all readings",
    source: "normal distribution contaminated by a wider one",
    parameters: &[
        share(1e-3),
        parameter("gyro", Unit::DEG_PER_HOUR, usual((10.0, 1000.0), (10.0, 1000.0), (1000.0, 1e5))),
        parameter("accel", Unit::MICRO_G, usual((1e3, 1e5), (1e3, 1e5), (1e4, 1e6))),
    ],
    settings: &[],
    needs: &[],
    partners: &["gyro_noise_level", "accel_noise_level"],
    told_apart_by: "the largest residual and the kurtosis",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Log(|p, _, seed, recording| {
        let mut random = random(seed);
        for increments in &mut recording.increments {
            let interval = increments.interval;
            for (triad, sigma) in [(&mut increments.angle, p[1]), (&mut increments.velocity, p[2])]
            {
                let spikes = nalgebra::Vector3::from_fn(|_, _| {
                    let hit = happens(p[0], &mut random);
                    if hit { sigma * interval * random.sample() } else { 0.0 }
                });
                *triad += InFrame::from_components(spikes);
            }
        }
    }),
};

/// Table angles that are read at other times than their time stamps.
pub static TIMESTAMP_JITTER: Term = Term {
    id: "timestamp_jitter",
    also: &[],
    name: "jitter of the time stamps",
    cause: "a computer reads the encoder at irregular times",
    equation: "angle = ζ(t + σ n), n standard normal",
    source: "definition of jitter, at the table rate of each sample",
    parameters: &[parameter("sigma", Unit::MICROSECOND, Prior::Anywhere(1.0, 2000.0))],
    settings: &[],
    needs: &[Need::TableAngle, Need::SeveralRates],
    partners: &["gyro_noise_level"],
    told_apart_by: "two rates: the scatter is proportional to the rate",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Log(|p, _, seed, recording| {
        let times = &recording.times;
        let Some(angles) = &mut recording.table_angle else { return };
        let (true_angles, last) = (angles.clone(), angles.len().saturating_sub(1));
        let mut random = random(seed);
        for (k, angle) in angles.iter_mut().enumerate() {
            let (before, after) = (k.saturating_sub(1), (k + 1).min(last));
            let elapsed = times[after] - times[before];
            let turn = true_angles[after] - true_angles[before];
            let rate = if elapsed > 0.0 { turn / elapsed } else { 0.0 };
            *angle += rate * p[0] * random.sample();
        }
    }),
};

/// Saturation of the gyros.
pub static GYRO_SATURATION: Term = Term {
    id: "gyro_saturation",
    also: &[],
    name: "saturation of the gyros",
    cause: "the rate exceeds the range of a gyro; zero means no limit",
    equation: "gyro within ± limit",
    source: "definition of a range",
    parameters: &[parameter("limit", Unit::DEG_PER_SECOND, Prior::Anywhere(5.0, 2000.0))],
    settings: &[],
    needs: &[],
    partners: &["gyro_scale_nonlinearity", "outliers"],
    told_apart_by: "a histogram of the readings: many readings at the limit",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Log(|p, _, _, recording| {
        for increments in &mut recording.increments {
            increments.angle = clipped(&increments.angle, p[0] * increments.interval);
        }
    }),
};

/// Saturation of the accelerometers.
pub static ACCEL_SATURATION: Term = Term {
    id: "accel_saturation",
    also: &[],
    name: "saturation of the accelerometers",
    cause: "the specific force exceeds the range of an accelerometer; zero means no limit",
    equation: "accel within ± limit",
    source: "definition of a range",
    parameters: &[parameter("limit", Unit::G, Prior::Anywhere(0.5, 20.0))],
    settings: &[],
    needs: &[],
    partners: &["accel_cubic", "outliers"],
    told_apart_by: "a histogram of the readings: many readings at the limit",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Log(|p, _, _, recording| {
        for increments in &mut recording.increments {
            increments.velocity = clipped(&increments.velocity, p[0] * increments.interval);
        }
    }),
};

fn clipped(vector: &InFrame<Body>, limit: f64) -> InFrame<Body> {
    let limit = limit.abs();
    if limit == 0.0 {
        return *vector;
    }
    InFrame::from_components(vector.components().map(|x| x.clamp(-limit, limit)))
}
