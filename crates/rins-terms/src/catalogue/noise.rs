//! Random errors that are not as a data sheet says.

use rins_imu::{NoiseModel, Quantisation};

use crate::catalogue::parameters::{parameter, usual};
use crate::term::{Action, Owner, Parameter, Parity, Prior, Term};
use crate::unit::Unit;

const EXCESS: [Parameter; 1] = [parameter("excess", Unit::ONE, Prior::Anywhere(0.1, 2.0))];
const WHITE: &str =
    "the white noise is stronger or weaker than the data sheet says; 1 is twice as strong";

/// Gyro white noise.
pub static GYRO_NOISE_LEVEL: Term = Term {
    id: "gyro_noise_level",
    also: &[],
    name: "level of the gyro noise",
    cause: WHITE,
    equation: "N (1 + p) instead of N",
    source: "ieee952, annex C",
    parameters: &EXCESS,
    settings: &[],
    needs: &[],
    partners: &["gyro_quantisation", "timestamp_jitter"],
    told_apart_by: "the Allan deviation of a long rest",
    owner: Owner::Sensor,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| noises.imu.gyro.white_density *= 1.0 + p[0]),
};

/// Accelerometer white noise.
pub static ACCEL_NOISE_LEVEL: Term = Term {
    id: "accel_noise_level",
    also: &[],
    name: "level of the accelerometer noise",
    cause: WHITE,
    equation: "N (1 + p) instead of N",
    source: "ieee952, annex C",
    parameters: &EXCESS,
    settings: &[],
    needs: &[],
    partners: &["accel_quantisation"],
    told_apart_by: "the Allan deviation of a long rest",
    owner: Owner::Sensor,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| noises.imu.accel.white_density *= 1.0 + p[0]),
};

/// Gyro flicker noise.
pub static GYRO_BIAS_INSTABILITY: Term = Term {
    id: "gyro_bias_instability",
    also: &[],
    name: "bias instability of the gyros",
    cause: "flicker noise: a bias that wanders alike over all times",
    equation: "the rate's density grows by B²/(2πf)",
    source: "ieee952, annex C",
    parameters: &[parameter(
        "level",
        Unit::DEG_PER_HOUR,
        usual((0.002, 0.1), (0.001, 0.02), (0.3, 20.0)),
    )],
    settings: &[],
    needs: &[],
    partners: &["gyro_bias_step", "gyro_bias_ramp", "gyro_rate_random_walk"],
    told_apart_by: "a rest of more than an hour",
    owner: Owner::Sensor,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| add_flicker(&mut noises.imu.gyro, p[0])),
};

/// Accelerometer flicker noise.
pub static ACCEL_BIAS_INSTABILITY: Term = Term {
    id: "accel_bias_instability",
    also: &[],
    name: "bias instability of the accelerometers",
    cause: "flicker noise: a bias that wanders alike over all times",
    equation: "the force's density grows by B²/(2πf)",
    source: "ieee952, annex C",
    parameters: &[parameter(
        "level",
        Unit::MICRO_G,
        usual((1.0, 20.0), (1.0, 10.0), (10.0, 200.0)),
    )],
    settings: &[],
    needs: &[],
    partners: &["accel_bias_step", "accel_bias_ramp", "accel_rate_random_walk"],
    told_apart_by: "a rest of more than an hour",
    owner: Owner::Sensor,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| add_flicker(&mut noises.imu.accel, p[0])),
};

/// Gyro biases that walk.
pub static GYRO_RATE_RANDOM_WALK: Term = Term {
    id: "gyro_rate_random_walk",
    also: &[],
    name: "rate random walk of the gyros",
    cause: "a bias that is the integral of white noise",
    equation: "the rate's density grows by K²/(2πf)²",
    source: "ieee952, annex C",
    parameters: &[parameter(
        "density",
        Unit::DEG_PER_HOUR_PER_ROOT_HOUR,
        usual((0.001, 0.1), (1e-4, 0.01), (0.1, 30.0)),
    )],
    settings: &[],
    needs: &[],
    partners: &["gyro_bias_ramp", "gyro_thermal_bias", "gyro_bias_instability"],
    told_apart_by: "a rest of more than an hour at a constant temperature",
    owner: Owner::Sensor,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| add_walk(&mut noises.imu.gyro, p[0])),
};

/// Accelerometer biases that walk.
pub static ACCEL_RATE_RANDOM_WALK: Term = Term {
    id: "accel_rate_random_walk",
    also: &[],
    name: "random walk of the accelerometer biases",
    cause: "a bias that is the integral of white noise",
    equation: "the force's density grows by K²/(2πf)²",
    source: "ieee952, annex C",
    parameters: &[parameter(
        "density",
        Unit::MICRO_G_PER_ROOT_HOUR,
        usual((1.0, 50.0), (1.0, 20.0), (10.0, 1000.0)),
    )],
    settings: &[],
    needs: &[],
    partners: &["accel_bias_ramp", "accel_thermal_bias", "accel_bias_instability"],
    told_apart_by: "a rest of more than an hour at a constant temperature",
    owner: Owner::Sensor,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| add_walk(&mut noises.imu.accel, p[0])),
};

/// The resolution of the gyros.
pub static GYRO_QUANTISATION: Term = Term {
    id: "gyro_quantisation",
    also: &[],
    name: "quantisation of the gyros",
    cause: "a least bit of increments, or of rates; where both are given that of increments counts",
    equation: "the output is rounded; of increments the rest comes later",
    source: "ieee952, annex C",
    parameters: &[
        parameter("increment", Unit::ARCSEC, usual((0.01, 0.5), (0.3, 2.0), (0.01, 2.0))),
        parameter("rate", Unit::DEG_PER_HOUR, usual((0.001, 0.1), (0.001, 0.1), (0.5, 50.0))),
    ],
    settings: &[],
    needs: &[],
    partners: &["gyro_noise_level", "gyro_dead_zone"],
    told_apart_by: "a histogram of the readings: they stand in a comb",
    owner: Owner::Sensor,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| quantise(&mut noises.imu.gyro, p)),
};

/// The resolution of the accelerometers.
pub static ACCEL_QUANTISATION: Term = Term {
    id: "accel_quantisation",
    also: &[],
    name: "quantisation of the accelerometers",
    cause: "a least bit of increments, or of forces; where both are given that of increments counts",
    equation: "the output is rounded; of increments the rest comes later",
    source: "ieee952, annex C",
    parameters: &[
        parameter(
            "increment",
            Unit::MICROMETRE_PER_SECOND,
            usual((1.0, 1000.0), (1.0, 100.0), (10.0, 1000.0)),
        ),
        parameter("force", Unit::MICRO_G, usual((1.0, 50.0), (1.0, 50.0), (10.0, 200.0))),
    ],
    settings: &[],
    needs: &[],
    partners: &["accel_noise_level", "stuck_samples"],
    told_apart_by: "a histogram of the readings: they stand in a comb",
    owner: Owner::Sensor,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| quantise(&mut noises.imu.accel, p)),
};

/// Densities add.
fn add_flicker(noise: &mut NoiseModel, level: f64) {
    if level != 0.0 {
        noise.flicker = Some(noise.flicker.unwrap_or(0.0).hypot(level));
    }
}

fn add_walk(noise: &mut NoiseModel, density: f64) {
    noise.bias_random_walk = noise.bias_random_walk.hypot(density);
}

/// Sets a least bit of increments or of their means, if there is one.
fn quantise(noise: &mut NoiseModel, p: &[f64]) {
    if p[0] != 0.0 {
        noise.quantisation = Some(Quantisation::Increment(p[0]));
    } else if p[1] != 0.0 {
        noise.quantisation = Some(Quantisation::Rate(p[1]));
    }
}
