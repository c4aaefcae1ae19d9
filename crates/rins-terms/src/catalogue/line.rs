//! Sinusoidal interference at a fixed frequency.

use std::f64::consts::{PI, TAU};

use crate::catalogue::parameters::{AXIS, FREQUENCY, parameter, usual};
use crate::term::{Action, Owner, Parity, Prevalence, Prior, Term};
use crate::unit::Unit;
use crate::waves::sin_cos;

/// Amplitude ranges of a gyro and of an accelerometer.
const GYRO: Prior = usual((0.01, 10.0), (0.01, 1.0), (1.0, 100.0));
const ACCEL: Prior = usual((1.0, 300.0), (1.0, 300.0), (10.0, 3000.0));

/// Spectral line at a frequency that does not depend on the table rate.
///
/// The mean over a sample is exact, also above half of the sampling rate, where the line is aliased.
pub static INTERFERENCE_LINE: Term = Term {
    id: "interference_line",
    also: &[],
    name: "sinusoidal interference",
    cause: "mains, crosstalk or a slip ring cause a spectral line in the gyro and the accelerometer of one axis",
    equation: "gyro, accel += c cos 2πft + s sin 2πft",
    source: "mean of a sinusoid over one sample",
    parameters: &[
        parameter("gyro_cos", Unit::DEG_PER_HOUR, GYRO),
        parameter("gyro_sin", Unit::DEG_PER_HOUR, GYRO),
        parameter("accel_cos", Unit::MICRO_G, ACCEL),
        parameter("accel_sin", Unit::MICRO_G, ACCEL),
    ],
    settings: &[FREQUENCY, AXIS],
    needs: &[],
    partners: &["encoder_harmonic", "base_sway", "table_wobble"],
    told_apart_by: "rotate at another rate: a spectral line keeps its frequency, a harmonic keeps its order",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::OfSetting,
    action: Action::Signal(|p, settings, moment, out| {
        let (frequency, axis) = (settings[0], settings[1]);
        let half_turn = PI * frequency * moment.interval;
        let gain = if half_turn == 0.0 { 1.0 } else { sin_cos(half_turn).0 / half_turn };
        let (sin, cos) = sin_cos(TAU * frequency * moment.mean.time);
        let place = [1.5, 2.5].iter().filter(|&&edge| axis > edge).count();
        out.gyro[place] += (p[0] * cos + p[1] * sin) * gain;
        out.accel[place] += (p[2] * cos + p[3] * sin) * gain;
    }),
};
