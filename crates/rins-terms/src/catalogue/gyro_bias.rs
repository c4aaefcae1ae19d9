//! Changes of the gyro biases: with time, temperature and the table rate.

use crate::catalogue::parameters::{
    REFERENCE_TEMPERATURE, TIME, TIME_CONSTANT, named, per_axis, usual,
};
use crate::setting::Setting;
use crate::signals::add_constant;
use crate::term::{Action, Need, Owner, Parity, Prevalence, Term};
use crate::unit::Unit;

/// Step of the gyro biases.
pub static GYRO_BIAS_STEP: Term = Term {
    id: "gyro_bias_step",
    also: &[],
    name: "gyro bias step",
    cause: "the bias of a gyro changes suddenly: a mode hop, a change of polarization, released stress in a package",
    equation: "gyro += b H(t - t0)",
    source: "mean of a step over one sample",
    parameters: &per_axis(Unit::DEG_PER_HOUR, usual((0.005, 0.5), (0.002, 0.05), (0.5, 50.0))),
    settings: &[TIME],
    needs: &[],
    partners: &["base_tilt_ramp", "gyro_bias_instability", "gyro_warmup"],
    told_apart_by: "repeat the run: a step of the sensor occurs at another time or not at all",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        add_constant(&mut out.gyro, p, moment.share_after(settings[0]));
    }),
};

/// Ramp of the gyro biases.
pub static GYRO_BIAS_RAMP: Term = Term {
    id: "gyro_bias_ramp",
    also: &[],
    name: "gyro bias ramp",
    cause: "the bias of a gyro changes at a constant rate: aging, or a transient that is long against the run",
    equation: "gyro += b' t",
    source: "first term of the series of a slow drift",
    parameters: &per_axis(
        Unit::DEG_PER_HOUR_PER_HOUR,
        usual((0.001, 0.05), (1e-4, 0.001), (1.0, 10.0)),
    ),
    settings: &[],
    needs: &[],
    partners: &["gyro_scale_ramp", "gyro_thermal_bias", "gyro_warmup", "gyro_rate_random_walk"],
    told_apart_by: "rotate in both directions; extend the run; raise and lower the temperature",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| add_constant(&mut out.gyro, p, moment.mean.time)),
};

/// Exponential transient of the gyro biases after turn-on.
pub static GYRO_WARMUP: Term = Term {
    id: "gyro_warmup",
    also: &[],
    name: "warm-up of the gyros",
    cause: "the bias of a gyro has an exponential transient after turn-on",
    equation: "gyro += b exp(-t/τ)",
    source: "transient with one time constant",
    parameters: &per_axis(Unit::DEG_PER_HOUR, usual((0.05, 2.0), (0.01, 0.2), (1.0, 50.0))),
    settings: &[TIME_CONSTANT],
    needs: &[],
    partners: &["gyro_thermal_bias", "gyro_shupe", "gyro_bias_ramp"],
    told_apart_by: "repeat the run with a warm IMU, then with a cold one",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        add_constant(&mut out.gyro, p, (-moment.mean.time / settings[0]).exp());
    }),
};

/// Temperature dependence of the gyro biases.
pub static GYRO_THERMAL_BIAS: Term = Term {
    id: "gyro_thermal_bias",
    also: &[],
    name: "temperature coefficient of the gyro bias",
    cause: "the bias of a gyro depends on its temperature",
    equation: "gyro += k (T - T_ref)",
    source: "first term of the series of the bias in temperature",
    parameters: &per_axis(
        Unit::DEG_PER_HOUR_PER_KELVIN,
        usual((0.005, 0.1), (5e-4, 0.01), (0.3, 30.0)),
    ),
    settings: &[REFERENCE_TEMPERATURE],
    needs: &[Need::Temperature],
    partners: &["gyro_bias_ramp", "gyro_warmup", "gyro_thermal_scale"],
    told_apart_by: "raise and lower the temperature, and rotate in both directions",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        add_constant(&mut out.gyro, p, moment.mean.above(settings[0]));
    }),
};

/// Dependence of the gyro biases on the rate of change of the temperature.
pub static GYRO_SHUPE: Term = Term {
    id: "gyro_shupe",
    also: &[],
    name: "Shupe effect",
    cause: "the temperature of a fiber coil changes, or a package has a temperature gradient",
    equation: "gyro += k dT/dt",
    source: "first order of the effect, D. M. Shupe, Applied Optics 19(5), 1980",
    parameters: &per_axis(
        Unit::DEG_PER_HOUR_PER_KELVIN_PER_MINUTE,
        usual((0.05, 2.0), (0.005, 0.05), (0.1, 5.0)),
    ),
    settings: &[],
    needs: &[Need::Temperature],
    partners: &["gyro_warmup", "gyro_thermal_bias"],
    told_apart_by: "heat in steps: it vanishes at constant temperature",
    owner: Owner::Sensor,
    prevalence: Prevalence::Particular,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| {
        add_constant(&mut out.gyro, p, moment.mean.warming_rate);
    }),
};

/// Dependence of the gyro biases on the magnitude of the table rate.
///
/// The part of gyro z that is proportional to `|ω|` is `gyro_scale_asymmetry`.
pub static GYRO_RATE_DEPENDENT_BIAS: Term = Term {
    id: "gyro_rate_dependent_bias",
    also: &[],
    name: "rate-dependent gyro bias",
    cause: "rectified vibration of a rotating table, or heat of its motor",
    equation: "gyro += c ω² + d |ω|, ω of the table, d for x and y",
    source: "even terms of the series in the table rate",
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
    told_apart_by: "rotate in both directions at three rates, with static intervals",
    owner: Owner::Sensor,
    prevalence: Prevalence::Particular,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| {
        let w = moment.mean.rate;
        add_constant(&mut out.gyro, &p[..3], w * w);
        add_constant(&mut out.gyro, &p[3..], w.abs());
    }),
};

/// Gyro biases that result from a heat source beside the table.
pub static THERMAL_ONE_PER_TURN: Term = Term {
    id: "thermal_one_per_turn",
    also: &[],
    name: "heating from one side",
    cause: "a heat source beside the table heats the gyros once per revolution, with a time constant",
    equation: "gyro += (c cos ζ + s sin ζ) after a low-pass 1/(1 + τ d/dt), in steady state at the start",
    source: "one thermal time constant",
    parameters: &named(
        ["x_cos", "x_sin", "y_cos", "y_sin", "z_cos", "z_sin"],
        Unit::DEG_PER_HOUR,
        usual((0.001, 0.1), (1e-4, 0.01), (0.1, 10.0)),
    ),
    settings: &[Setting { default: 10.0, ..TIME_CONSTANT }],
    needs: &[Need::SeveralRates],
    partners: &["gyro_g_sensitivity", "gyro_magnetic", "gyro_warmup"],
    told_apart_by: "rotate at two rates: the effects of gravity and the magnetic field do not decrease with the rate",
    owner: Owner::Run,
    prevalence: Prevalence::Particular,
    parity: Parity::Tensor,
    action: Action::Following(|p, followed, out| {
        add_constant(&mut out.gyro, &[p[0], p[2], p[4]], followed.re);
        add_constant(&mut out.gyro, &[p[1], p[3], p[5]], followed.im);
    }),
};
