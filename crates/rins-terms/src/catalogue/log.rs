//! Faults of a finished log: samples that stick, spikes, clipped and jittery readings.

use std::f64::consts::FRAC_1_SQRT_2;

use rins_frames::{Body, InFrame};
use rins_imu::{NormalStream, Seed, Sensor};

use crate::catalogue::parameters::{parameter, usual};
use crate::setting::{Setting, SettingKind};
use crate::term::{Action, Need, Owner, Parameter, Parity, Prior, Term};
use crate::unit::Unit;

/// Random numbers that no sensor's noise has.
fn random(seed: Seed) -> NormalStream {
    Seed { seed: seed.seed.rotate_left(32) ^ 0x6c6f_6766_6175_6c74, ..seed }.stream(Sensor::Encoder)
}

/// Whether something happens that does with this probability.
fn happens(probability: f64, random: &mut NormalStream) -> bool {
    // A normal number's place in its distribution is uniform.
    0.5 * libm::erfc(random.sample() * FRAC_1_SQRT_2) < probability
}

const fn share(high: f64) -> Parameter {
    parameter("share", Unit::ONE, Prior::Anywhere(0.01 * high, high))
}

/// Samples that repeat the one before.
pub static STUCK_SAMPLES: Term = Term {
    id: "stuck_samples",
    also: &[],
    name: "stuck samples",
    cause: "a driver hands out the last readings again when there are no new ones",
    equation: "this share of all samples repeats the last rates and forces",
    source: "the definition of a held reading",
    parameters: &[share(0.05)],
    settings: &[Setting {
        kind: SettingKind::SampleCount,
        name: "length",
        meaning: "how many samples in a row are stuck",
        unit: Unit::ONE,
        default: 5.0,
        within: (1.0, 1e5),
    }],
    needs: &[],
    partners: &["accel_quantisation", "gyro_quantisation"],
    told_apart_by: "runs of equal samples",
    owner: Owner::Run,
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

/// Spikes.
pub static OUTLIERS: Term = Term {
    id: "outliers",
    also: &[],
    name: "outliers",
    cause: "spikes of the electronics, or shocks; gyro and accel are their 1σ",
    equation: "this share of all readings has a normal number added",
    source: "a normal distribution contaminated by a wider one",
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

/// Angles that are not read when their stamps say.
pub static TIMESTAMP_JITTER: Term = Term {
    id: "timestamp_jitter",
    also: &[],
    name: "jitter of the time stamps",
    cause: "a computer reads the encoder when it has time",
    equation: "angle = ζ(t + σ n), n standard normal",
    source: "the definition of jitter, at the table's rate about each sample",
    parameters: &[parameter("sigma", Unit::MICROSECOND, Prior::Anywhere(1.0, 2000.0))],
    settings: &[],
    needs: &[Need::TableAngle, Need::SeveralRates],
    partners: &["gyro_noise_level"],
    told_apart_by: "two rates: the scatter grows with the rate",
    owner: Owner::Run,
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

/// Gyros that clip.
pub static GYRO_SATURATION: Term = Term {
    id: "gyro_saturation",
    also: &[],
    name: "saturation of the gyros",
    cause: "a rate beyond what a gyro can read; a limit of zero is none",
    equation: "gyro within ± limit",
    source: "the definition of a range",
    parameters: &[parameter("limit", Unit::DEG_PER_SECOND, Prior::Anywhere(5.0, 2000.0))],
    settings: &[],
    needs: &[],
    partners: &["gyro_scale_nonlinearity", "outliers"],
    told_apart_by: "a histogram of the readings: it ends in a wall",
    owner: Owner::Sensor,
    parity: Parity::Unchanged,
    action: Action::Log(|p, _, _, recording| {
        for increments in &mut recording.increments {
            increments.angle = clipped(&increments.angle, p[0] * increments.interval);
        }
    }),
};

/// Accelerometers that clip.
pub static ACCEL_SATURATION: Term = Term {
    id: "accel_saturation",
    also: &[],
    name: "saturation of the accelerometers",
    cause: "a force beyond what an accelerometer can read; a limit of zero is none",
    equation: "accel within ± limit",
    source: "the definition of a range",
    parameters: &[parameter("limit", Unit::G, Prior::Anywhere(0.5, 20.0))],
    settings: &[],
    needs: &[],
    partners: &["accel_cubic", "outliers"],
    told_apart_by: "a histogram of the readings: it ends in a wall",
    owner: Owner::Sensor,
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
