//! Gyro biases that do not stay what they were: with time, temperature and the table's rate.

use crate::catalogue::parameters::{
    REFERENCE_TEMPERATURE, TIME, TIME_CONSTANT, named, per_axis, usual,
};
use crate::setting::Setting;
use crate::signals::add_constant;
use crate::term::{Action, Need, Owner, Parity, Term};
use crate::unit::Unit;

/// Gyro biases that jump.
pub static GYRO_BIAS_STEP: Term = Term {
    id: "gyro_bias_step",
    also: &[],
    name: "gyro bias step",
    cause: "a gyro's bias jumps: a mode hop, a change of polarisation, stress let go in a package",
    equation: "gyro += b H(t - t0)",
    source: "the mean over a sample of a step in time",
    parameters: &per_axis(Unit::DEG_PER_HOUR, usual((0.005, 0.5), (0.002, 0.05), (0.5, 50.0))),
    settings: &[TIME],
    needs: &[],
    partners: &["base_tilt_ramp", "gyro_bias_instability", "gyro_warmup"],
    told_apart_by: "repeat the run: a step of the sensor comes at another time or not at all",
    owner: Owner::Run,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        add_constant(&mut out.gyro, p, moment.share_after(settings[0]));
    }),
};

/// Gyro biases that drift.
pub static GYRO_BIAS_RAMP: Term = Term {
    id: "gyro_bias_ramp",
    also: &[],
    name: "gyro bias ramp",
    cause: "a gyro's bias drifts at a constant rate: ageing, or the start of something slow",
    equation: "gyro += b' t",
    source: "the first term of a slow drift's series",
    parameters: &per_axis(
        Unit::DEG_PER_HOUR_PER_HOUR,
        usual((0.001, 0.05), (1e-4, 0.001), (1.0, 10.0)),
    ),
    settings: &[],
    needs: &[],
    partners: &["gyro_scale_ramp", "gyro_thermal_bias", "gyro_warmup", "gyro_rate_random_walk"],
    told_apart_by: "turn the table both ways; run for longer; vary the temperature up and down",
    owner: Owner::Run,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| add_constant(&mut out.gyro, p, moment.mean.time)),
};

/// Gyro biases that settle after turn-on.
pub static GYRO_WARMUP: Term = Term {
    id: "gyro_warmup",
    also: &[],
    name: "warm-up of the gyros",
    cause: "a gyro's bias settles after it was turned on",
    equation: "gyro += b exp(-t/τ)",
    source: "one time constant of a warm-up",
    parameters: &per_axis(Unit::DEG_PER_HOUR, usual((0.05, 2.0), (0.01, 0.2), (1.0, 50.0))),
    settings: &[TIME_CONSTANT],
    needs: &[],
    partners: &["gyro_thermal_bias", "gyro_shupe", "gyro_bias_ramp"],
    told_apart_by: "repeat the run warm, then cold",
    owner: Owner::Run,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        add_constant(&mut out.gyro, p, (-moment.mean.time / settings[0]).exp());
    }),
};

/// Gyro biases that follow the temperature.
pub static GYRO_THERMAL_BIAS: Term = Term {
    id: "gyro_thermal_bias",
    also: &[],
    name: "temperature coefficient of the gyro bias",
    cause: "a gyro's bias depends on its temperature",
    equation: "gyro += k (T - T_ref)",
    source: "the first term of a bias's series in temperature",
    parameters: &per_axis(
        Unit::DEG_PER_HOUR_PER_KELVIN,
        usual((0.005, 0.1), (5e-4, 0.01), (0.3, 30.0)),
    ),
    settings: &[REFERENCE_TEMPERATURE],
    needs: &[Need::Temperature],
    partners: &["gyro_bias_ramp", "gyro_warmup", "gyro_thermal_scale"],
    told_apart_by: "vary the temperature up and down, and turn the table both ways",
    owner: Owner::Sensor,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        add_constant(&mut out.gyro, p, moment.mean.above(settings[0]));
    }),
};

/// Gyro biases that follow the change of temperature.
pub static GYRO_SHUPE: Term = Term {
    id: "gyro_shupe",
    also: &[],
    name: "Shupe effect",
    cause: "a change of temperature runs through a fibre coil, or a gradient through a package",
    equation: "gyro += k dT/dt",
    source: "the effect's first order, D. M. Shupe, Applied Optics 19(5), 1980",
    parameters: &per_axis(
        Unit::DEG_PER_HOUR_PER_KELVIN_PER_MINUTE,
        usual((0.05, 2.0), (0.005, 0.05), (0.1, 5.0)),
    ),
    settings: &[],
    needs: &[Need::Temperature],
    partners: &["gyro_warmup", "gyro_thermal_bias"],
    told_apart_by: "heat in steps: it is gone when the temperature holds",
    owner: Owner::Sensor,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| {
        add_constant(&mut out.gyro, p, moment.mean.warming_rate);
    }),
};

/// Gyro biases that come with the table's rate, whichever way it turns.
///
/// What gyro z shows in proportion to `|ω|` is `gyro_scale_asymmetry`.
pub static GYRO_RATE_DEPENDENT_BIAS: Term = Term {
    id: "gyro_rate_dependent_bias",
    also: &[],
    name: "gyro bias that depends on the rate",
    cause: "vibration of a turning table, rectified, or the heat of its motor",
    equation: "gyro += c ω² + d |ω|, ω of the table, d for x and y",
    source: "the even terms of a series in the table's rate",
    parameters: &{
        let [x, y, z] = named(
            ["square_x", "square_y", "square_z"],
            Unit::DEG_PER_HOUR_PER_DEG_PER_SECOND_2,
            usual((1e-5, 5e-4), (1e-6, 5e-5), (0.01, 0.2)),
        );
        let [linear_x, linear_y] = named(
            ["linear_x", "linear_y"],
            Unit::DEG_PER_HOUR_PER_DEG_PER_SECOND,
            usual((1e-4, 5e-3), (1e-5, 5e-4), (0.1, 2.0)),
        );
        [x, y, z, linear_x, linear_y]
    },
    settings: &[],
    needs: &[Need::SeveralRates],
    partners: &["gyro_scale_asymmetry", "gyro.bias", "gyro.misalignment"],
    told_apart_by: "turn at three rates of both signs, with rests",
    owner: Owner::Sensor,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| {
        let w = moment.mean.rate;
        add_constant(&mut out.gyro, &p[..3], w * w);
        add_constant(&mut out.gyro, &p[3..], w.abs());
    }),
};

/// Gyro biases that a heat source beside the table makes.
pub static THERMAL_ONE_PER_TURN: Term = Term {
    id: "thermal_one_per_turn",
    also: &[],
    name: "heat from one side",
    cause: "a source of heat beside the table warms the gyros once a turn; they follow it slowly",
    equation: "gyro += (c cos ζ + s sin ζ) behind a low-pass 1/(1 + τ d/dt), settled at the start",
    source: "one thermal time constant",
    parameters: &named(
        ["x_cos", "x_sin", "y_cos", "y_sin", "z_cos", "z_sin"],
        Unit::DEG_PER_HOUR,
        usual((0.001, 0.1), (1e-4, 0.01), (0.1, 10.0)),
    ),
    settings: &[Setting { default: 10.0, ..TIME_CONSTANT }],
    needs: &[Need::SeveralRates],
    partners: &["gyro_g_sensitivity", "gyro_magnetic", "gyro_warmup"],
    told_apart_by: "turn at two rates: gravity and the field do not fade with the rate",
    owner: Owner::Run,
    parity: Parity::Tensor,
    action: Action::Following(|p, followed, out| {
        add_constant(&mut out.gyro, &[p[0], p[2], p[4]], followed.re);
        add_constant(&mut out.gyro, &[p[1], p[3], p[5]], followed.im);
    }),
};
