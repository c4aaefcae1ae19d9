//! Changes of the accelerometer biases: with time, temperature and vibration.

use rins_frames::units::DEG_PER_SECOND;

use crate::catalogue::parameters::{REFERENCE_TEMPERATURE, TIME, TIME_CONSTANT, per_axis, usual};
use crate::setting::{Setting, SettingKind};
use crate::signals::add_constant;
use crate::term::{Action, Need, Owner, Parity, Prevalence, Term};
use crate::unit::Unit;

/// Step of the accelerometer biases.
pub static ACCEL_BIAS_STEP: Term = Term {
    id: "accel_bias_step",
    also: &[],
    name: "accelerometer bias step",
    cause: "the bias of an accelerometer changes suddenly: released stress, an electric charge, a contact",
    equation: "accel += b H(t - t0)",
    source: "mean of a step over one sample",
    parameters: &per_axis(Unit::MICRO_G, usual((5.0, 500.0), (2.0, 100.0), (100.0, 5000.0))),
    settings: &[TIME],
    needs: &[],
    partners: &["base_tilt_step", "accel_warmup"],
    told_apart_by: "rotate the table: a bias is constant in the body frame, a tilt in the axis frame",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        add_constant(&mut out.accel, p, moment.share_after(settings[0]));
    }),
};

/// Ramp of the accelerometer biases.
pub static ACCEL_BIAS_RAMP: Term = Term {
    id: "accel_bias_ramp",
    also: &[],
    name: "accelerometer bias ramp",
    cause: "the bias of an accelerometer changes at a constant rate",
    equation: "accel += b' t",
    source: "first term of the series of a slow drift",
    parameters: &per_axis(
        Unit::MICRO_G_PER_HOUR,
        usual((1.0, 100.0), (1.0, 50.0), (100.0, 10000.0)),
    ),
    settings: &[],
    needs: &[],
    partners: &["accel_thermal_bias", "accel_warmup", "base_tilt_ramp"],
    told_apart_by: "rotate the table; raise and lower the temperature",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| add_constant(&mut out.accel, p, moment.mean.time)),
};

/// Exponential transient of the accelerometer biases after turn-on.
pub static ACCEL_WARMUP: Term = Term {
    id: "accel_warmup",
    also: &[],
    name: "warm-up of the accelerometers",
    cause: "the bias of an accelerometer has an exponential transient after turn-on",
    equation: "accel += b exp(-t/τ)",
    source: "transient with one time constant",
    parameters: &per_axis(Unit::MICRO_G, usual((20.0, 1000.0), (10.0, 200.0), (100.0, 20000.0))),
    settings: &[TIME_CONSTANT],
    needs: &[],
    partners: &["accel_thermal_bias", "accel_bias_ramp"],
    told_apart_by: "repeat the run with a warm IMU, then with a cold one",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        add_constant(&mut out.accel, p, (-moment.mean.time / settings[0]).exp());
    }),
};

/// Temperature dependence of the accelerometer biases.
pub static ACCEL_THERMAL_BIAS: Term = Term {
    id: "accel_thermal_bias",
    also: &[],
    name: "temperature coefficient of the accelerometer bias",
    cause: "the bias of an accelerometer depends on its temperature",
    equation: "accel += k (T - T_ref)",
    source: "first term of the series of the bias in temperature",
    parameters: &per_axis(
        Unit::MICRO_G_PER_KELVIN,
        usual((1.0, 50.0), (1.0, 20.0), (50.0, 2000.0)),
    ),
    settings: &[REFERENCE_TEMPERATURE],
    needs: &[Need::Temperature],
    partners: &["accel_bias_ramp", "accel_warmup"],
    told_apart_by: "raise and lower the temperature",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        add_constant(&mut out.accel, p, moment.mean.above(settings[0]));
    }),
};

/// The rate at which the parameters of vibration rectification are given \[rad/s\].
const REFERENCE_RATE: f64 = 10.0 * DEG_PER_SECOND;

/// Rectification of the vibration of a rotating table.
pub static ACCEL_VIBRATION_RECTIFICATION: Term = Term {
    id: "accel_vibration_rectification",
    also: &[],
    name: "vibration rectification",
    cause: "a rotating table vibrates, and the accelerometers rectify the vibration to a bias; c is its value at 10 deg/s",
    equation: "accel += c (|ω| / 10 deg/s)^n, ω of the table",
    source: "mean of a quadratic error under vibration with a variance proportional to a power of the rate",
    parameters: &per_axis(Unit::MICRO_G, usual((1.0, 50.0), (1.0, 10.0), (10.0, 2000.0))),
    settings: &[Setting {
        kind: SettingKind::Exponent,
        name: "exponent",
        meaning: "exponent n of the table rate in the variance of the vibration",
        unit: Unit::ONE,
        default: 1.0,
        within: (0.25, 4.0),
    }],
    needs: &[Need::SeveralRates],
    partners: &["accel_lever_arm", "accel.bias"],
    told_apart_by: "accelerometer z, on which a lever arm has no effect; static intervals and several rates; ramps of the rate",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        let level = (moment.mean.rate.abs() / REFERENCE_RATE).powf(settings[0]);
        add_constant(&mut out.accel, p, level);
    }),
};
