//! Random errors that differ from the data sheet.

use rins_imu::{NoiseModel, Quantisation};

use crate::catalogue::parameters::{parameter, usual};
use crate::term::{Action, Owner, Parameter, Parity, Prevalence, Prior, Term};
use crate::unit::Unit;

const EXCESS: [Parameter; 1] = [parameter("excess", Unit::ONE, Prior::Anywhere(0.1, 2.0))];
const WHITE: &str = "the noise density differs from the data sheet; an excess of 1 doubles it";

/// White noise of the gyros.
pub static GYRO_NOISE_LEVEL: Term = Term {
    id: "gyro_noise_level",
    also: &[],
    name: "noise density of the gyros",
    cause: WHITE,
    equation: "N (1 + p) instead of N",
    source: "ieee952, annex C",
    parameters: &EXCESS,
    settings: &[],
    needs: &[],
    partners: &["gyro_quantisation", "timestamp_jitter"],
    told_apart_by: "Allan deviation of a long static interval",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| noises.imu.gyro.white_density *= 1.0 + p[0]),
};

/// White noise of the accelerometers.
pub static ACCEL_NOISE_LEVEL: Term = Term {
    id: "accel_noise_level",
    also: &[],
    name: "noise density of the accelerometers",
    cause: WHITE,
    equation: "N (1 + p) instead of N",
    source: "ieee952, annex C",
    parameters: &EXCESS,
    settings: &[],
    needs: &[],
    partners: &["accel_quantisation"],
    told_apart_by: "Allan deviation of a long static interval",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| noises.imu.accel.white_density *= 1.0 + p[0]),
};

/// Flicker (1/f) noise of the gyros.
pub static GYRO_BIAS_INSTABILITY: Term = Term {
    id: "gyro_bias_instability",
    also: &[],
    name: "bias instability of the gyros",
    cause: "flicker (1/f) noise of the bias",
    equation: "the power spectral density of the rate increases by B²/(2πf)",
    source: "ieee952, annex C",
    parameters: &[parameter(
        "level",
        Unit::DEG_PER_HOUR,
        usual((0.002, 0.1), (0.001, 0.02), (0.3, 20.0)),
    )],
    settings: &[],
    needs: &[],
    partners: &["gyro_bias_step", "gyro_bias_ramp", "gyro_rate_random_walk"],
    told_apart_by: "static interval of more than one hour",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| add_flicker(&mut noises.imu.gyro, p[0])),
};

/// Flicker (1/f) noise of the accelerometers.
pub static ACCEL_BIAS_INSTABILITY: Term = Term {
    id: "accel_bias_instability",
    also: &[],
    name: "bias instability of the accelerometers",
    cause: "flicker (1/f) noise of the bias",
    equation: "the power spectral density of the force increases by B²/(2πf)",
    source: "ieee952, annex C",
    parameters: &[parameter(
        "level",
        Unit::MICRO_G,
        usual((1.0, 20.0), (1.0, 10.0), (10.0, 200.0)),
    )],
    settings: &[],
    needs: &[],
    partners: &["accel_bias_step", "accel_bias_ramp", "accel_rate_random_walk"],
    told_apart_by: "static interval of more than one hour",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| add_flicker(&mut noises.imu.accel, p[0])),
};

/// Random walk of the gyro biases.
pub static GYRO_RATE_RANDOM_WALK: Term = Term {
    id: "gyro_rate_random_walk",
    also: &[],
    name: "rate random walk of the gyros",
    cause: "the bias is the integral of white noise",
    equation: "the power spectral density of the rate increases by K²/(2πf)²",
    source: "ieee952, annex C",
    parameters: &[parameter(
        "density",
        Unit::DEG_PER_HOUR_PER_ROOT_HOUR,
        usual((0.001, 0.1), (1e-4, 0.01), (0.1, 30.0)),
    )],
    settings: &[],
    needs: &[],
    partners: &["gyro_bias_ramp", "gyro_thermal_bias", "gyro_bias_instability"],
    told_apart_by: "static interval of more than one hour at constant temperature",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| add_walk(&mut noises.imu.gyro, p[0])),
};

/// Random walk of the accelerometer biases.
pub static ACCEL_RATE_RANDOM_WALK: Term = Term {
    id: "accel_rate_random_walk",
    also: &[],
    name: "acceleration random walk of the accelerometers",
    cause: "the bias is the integral of white noise",
    equation: "the power spectral density of the force increases by K²/(2πf)²",
    source: "ieee952, annex C",
    parameters: &[parameter(
        "density",
        Unit::MICRO_G_PER_ROOT_HOUR,
        usual((1.0, 50.0), (1.0, 20.0), (10.0, 1000.0)),
    )],
    settings: &[],
    needs: &[],
    partners: &["accel_bias_ramp", "accel_thermal_bias", "accel_bias_instability"],
    told_apart_by: "static interval of more than one hour at constant temperature",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| add_walk(&mut noises.imu.accel, p[0])),
};

/// The resolution of the gyros.
pub static GYRO_QUANTISATION: Term = Term {
    id: "gyro_quantisation",
    also: &[],
    name: "quantization of the gyros",
    cause: "LSB of the increments, or of the rates; if both are given, that of the increments is used",
    equation: "the output is rounded; the rounding error of an increment is carried to the next sample",
    source: "ieee952, annex C",
    parameters: &[
        parameter("increment", Unit::ARCSEC, usual((0.01, 0.5), (0.3, 2.0), (0.01, 2.0))),
        parameter("rate", Unit::DEG_PER_HOUR, usual((0.001, 0.1), (0.001, 0.1), (0.5, 50.0))),
    ],
    settings: &[],
    needs: &[],
    partners: &["gyro_noise_level", "gyro_dead_zone"],
    told_apart_by: "a histogram of the readings: they lie on a quantization grid",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Noise(|p, _, noises| quantise(&mut noises.imu.gyro, p)),
};

/// The resolution of the accelerometers.
pub static ACCEL_QUANTISATION: Term = Term {
    id: "accel_quantisation",
    also: &[],
    name: "quantization of the accelerometers",
    cause: "LSB of the increments, or of the forces; if both are given, that of the increments is used",
    equation: "the output is rounded; the rounding error of an increment is carried to the next sample",
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
    told_apart_by: "a histogram of the readings: they lie on a quantization grid",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
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

/// Sets the LSB of increments or of their means, if there is one.
fn quantise(noise: &mut NoiseModel, p: &[f64]) {
    if p[0] != 0.0 {
        noise.quantisation = Some(Quantisation::Increment(p[0]));
    } else if p[1] != 0.0 {
        noise.quantisation = Some(Quantisation::Rate(p[1]));
    }
}
