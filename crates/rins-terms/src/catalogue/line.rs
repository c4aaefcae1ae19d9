//! Interference of a fixed frequency.

use std::f64::consts::{PI, TAU};

use crate::catalogue::parameters::{AXIS, FREQUENCY, parameter, usual};
use crate::term::{Action, Owner, Parity, Prior, Term};
use crate::unit::Unit;
use crate::waves::sin_cos;

/// One gyro's share, and one accelerometer's.
const GYRO: Prior = usual((0.01, 10.0), (0.01, 1.0), (1.0, 100.0));
const ACCEL: Prior = usual((1.0, 300.0), (1.0, 300.0), (10.0, 3000.0));

/// A line that does not move with the table's rate.
///
/// The mean over a sample is exact, above half the sampling rate too: a line that is seen at another
/// frequency than its own.
pub static INTERFERENCE_LINE: Term = Term {
    id: "interference_line",
    also: &[],
    name: "interference",
    cause: "mains, crosstalk or a slip ring put a line into the gyro and the accelerometer of one axis",
    equation: "gyro, accel += c cos 2πft + s sin 2πft",
    source: "the mean over a sample of a sine",
    parameters: &[
        parameter("gyro_cos", Unit::DEG_PER_HOUR, GYRO),
        parameter("gyro_sin", Unit::DEG_PER_HOUR, GYRO),
        parameter("accel_cos", Unit::MICRO_G, ACCEL),
        parameter("accel_sin", Unit::MICRO_G, ACCEL),
    ],
    settings: &[FREQUENCY, AXIS],
    needs: &[],
    partners: &["encoder_harmonic", "base_sway", "table_wobble"],
    told_apart_by: "turn at another rate: a line keeps its frequency, a harmonic its order",
    owner: Owner::Run,
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
