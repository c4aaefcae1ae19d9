//! Accelerometer biases that do not stay what they were: with time, temperature and vibration.

use rins_frames::units::DEG_PER_SECOND;

use crate::catalogue::parameters::{REFERENCE_TEMPERATURE, TIME, TIME_CONSTANT, per_axis, usual};
use crate::setting::{Setting, SettingKind};
use crate::signals::add_constant;
use crate::term::{Action, Need, Owner, Parity, Term};
use crate::unit::Unit;

/// Accelerometer biases that jump.
pub static ACCEL_BIAS_STEP: Term = Term {
    id: "accel_bias_step",
    also: &[],
    name: "accelerometer bias step",
    cause: "an accelerometer's bias jumps: stress let go, a charge, a contact",
    equation: "accel += b H(t - t0)",
    source: "the mean over a sample of a step in time",
    parameters: &per_axis(Unit::MICRO_G, usual((5.0, 500.0), (2.0, 100.0), (100.0, 5000.0))),
    settings: &[TIME],
    needs: &[],
    partners: &["base_tilt_step", "accel_warmup"],
    told_apart_by: "turn the table: a bias stays with the body, a tilt with the table",
    owner: Owner::Run,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        add_constant(&mut out.accel, p, moment.share_after(settings[0]));
    }),
};

/// Accelerometer biases that drift.
pub static ACCEL_BIAS_RAMP: Term = Term {
    id: "accel_bias_ramp",
    also: &[],
    name: "accelerometer bias ramp",
    cause: "an accelerometer's bias drifts at a constant rate",
    equation: "accel += b' t",
    source: "the first term of a slow drift's series",
    parameters: &per_axis(
        Unit::MICRO_G_PER_HOUR,
        usual((1.0, 100.0), (1.0, 50.0), (100.0, 10000.0)),
    ),
    settings: &[],
    needs: &[],
    partners: &["accel_thermal_bias", "accel_warmup", "base_tilt_ramp"],
    told_apart_by: "turn the table; vary the temperature up and down",
    owner: Owner::Run,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| add_constant(&mut out.accel, p, moment.mean.time)),
};

/// Accelerometer biases that settle after turn-on.
pub static ACCEL_WARMUP: Term = Term {
    id: "accel_warmup",
    also: &[],
    name: "warm-up of the accelerometers",
    cause: "an accelerometer's bias settles after it was turned on",
    equation: "accel += b exp(-t/τ)",
    source: "one time constant of a warm-up",
    parameters: &per_axis(Unit::MICRO_G, usual((20.0, 1000.0), (10.0, 200.0), (100.0, 20000.0))),
    settings: &[TIME_CONSTANT],
    needs: &[],
    partners: &["accel_thermal_bias", "accel_bias_ramp"],
    told_apart_by: "repeat the run warm, then cold",
    owner: Owner::Run,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        add_constant(&mut out.accel, p, (-moment.mean.time / settings[0]).exp());
    }),
};

/// Accelerometer biases that follow the temperature.
pub static ACCEL_THERMAL_BIAS: Term = Term {
    id: "accel_thermal_bias",
    also: &[],
    name: "temperature coefficient of the accelerometer bias",
    cause: "an accelerometer's bias depends on its temperature",
    equation: "accel += k (T - T_ref)",
    source: "the first term of a bias's series in temperature",
    parameters: &per_axis(
        Unit::MICRO_G_PER_KELVIN,
        usual((1.0, 50.0), (1.0, 20.0), (50.0, 2000.0)),
    ),
    settings: &[REFERENCE_TEMPERATURE],
    needs: &[Need::Temperature],
    partners: &["accel_bias_ramp", "accel_warmup"],
    told_apart_by: "vary the temperature up and down",
    owner: Owner::Sensor,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        add_constant(&mut out.accel, p, moment.mean.above(settings[0]));
    }),
};

/// The rate at which the parameters of vibration rectification are given \[rad/s\].
const REFERENCE_RATE: f64 = 10.0 * DEG_PER_SECOND;

/// Accelerometers that rectify the vibration of a turning table.
pub static ACCEL_VIBRATION_RECTIFICATION: Term = Term {
    id: "accel_vibration_rectification",
    also: &[],
    name: "vibration rectification",
    cause: "a turning table shakes; the accelerometers make a constant of it, given here at 10 deg/s",
    equation: "accel += c (|ω| / 10 deg/s)^n, ω of the table",
    source: "the mean of a quadratic error under vibration whose variance goes with a power of the rate",
    parameters: &per_axis(Unit::MICRO_G, usual((1.0, 50.0), (1.0, 10.0), (10.0, 2000.0))),
    settings: &[Setting {
        kind: SettingKind::Exponent,
        name: "exponent",
        meaning: "the power of the rate with which the vibration's variance grows",
        unit: Unit::ONE,
        default: 1.0,
        within: (0.25, 4.0),
    }],
    needs: &[Need::SeveralRates],
    partners: &["accel_lever_arm", "accel.bias"],
    told_apart_by: "accelerometer z, which no lever arm reaches; rests and several rates; ramps",
    owner: Owner::Run,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        let level = (moment.mean.rate.abs() / REFERENCE_RATE).powf(settings[0]);
        add_constant(&mut out.accel, p, level);
    }),
};
