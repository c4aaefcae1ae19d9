//! Errors of the scale factor of gyro z that are not constant, and errors of the gyros at low rates.
//!
//! Only gyro z has these errors of the scale factor: gyros x and y measure only the Earth's rate.

use num_dual::Dual64;

use crate::catalogue::parameters::{REFERENCE_TEMPERATURE, parameter, per_axis, usual};
use crate::setting::{Setting, SettingKind};
use crate::term::{Action, Need, Owner, Parity, Prevalence, Term};
use crate::unit::Unit;

/// Scale error that changes its sign with the rate.
pub static GYRO_SCALE_ASYMMETRY: Term = Term {
    id: "gyro_scale_asymmetry",
    also: &[],
    name: "asymmetry of the gyro scale factor",
    cause: "the scale factor of a gyro differs between the two directions of rotation",
    equation: "gyro_z += A |ω_z|",
    source: "even part of a scale factor; ieee952",
    parameters: &[parameter("z", Unit::PPM, usual((1.0, 50.0), (0.1, 1.0), (10.0, 500.0)))],
    settings: &[],
    needs: &[Need::Reversal, Need::SeveralRates],
    partners: &["gyro.bias", "encoder_latency", "gyro_rate_dependent_bias", "gyro_hysteresis"],
    told_apart_by: "rotate in both directions at three rates, with static intervals",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| out.gyro[2] += p[0] * moment.rate.z.abs()),
};

/// Scale error that increases with the rate.
pub static GYRO_SCALE_NONLINEARITY: Term = Term {
    id: "gyro_scale_nonlinearity",
    also: &[],
    name: "nonlinearity of the gyro scale factor",
    cause: "the scale factor of a gyro depends on the rate",
    equation: "gyro_z += k2 ω_z |ω_z| + k3 ω_z³",
    source: "odd terms of the series of the scale factor in the rate; ieee952",
    parameters: &[
        parameter(
            "k2_z",
            Unit::PPM_PER_DEG_PER_SECOND,
            usual((0.5, 10.0), (0.1, 0.5), (5.0, 100.0)),
        ),
        parameter(
            "k3_z",
            Unit::PPM_PER_DEG_PER_SECOND_2,
            usual((0.05, 1.0), (0.01, 0.05), (0.5, 10.0)),
        ),
    ],
    settings: &[],
    needs: &[Need::SeveralRates],
    partners: &["gyro.scale"],
    told_apart_by: "rotate at four rates, the highest ten times the lowest",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Even,
    action: Action::Signal(|p, _, moment, out| {
        let w = moment.rate.z;
        out.gyro[2] += p[0] * (w * w.abs()) + p[1] * (w * w * w);
    }),
};

/// Temperature dependence of the scale error.
pub static GYRO_THERMAL_SCALE: Term = Term {
    id: "gyro_thermal_scale",
    also: &[],
    name: "temperature coefficient of the gyro scale factor",
    cause: "the scale factor of a gyro depends on its temperature",
    equation: "gyro_z += k (T - T_ref) ω_z",
    source: "first term of the series of the scale factor in temperature",
    parameters: &[parameter(
        "z",
        Unit::PPM_PER_KELVIN,
        usual((1.0, 100.0), (0.01, 0.1), (20.0, 200.0)),
    )],
    settings: &[REFERENCE_TEMPERATURE],
    needs: &[Need::Temperature, Need::Reversal],
    partners: &["gyro_thermal_bias", "gyro_scale_ramp"],
    told_apart_by: "rotate in both directions while the temperature changes",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Even,
    action: Action::Signal(|p, settings, moment, out| {
        out.gyro[2] += p[0] * (moment.mean.above(settings[0]) * moment.rate.z);
    }),
};

/// Ramp of the scale error.
pub static GYRO_SCALE_RAMP: Term = Term {
    id: "gyro_scale_ramp",
    also: &[],
    name: "ramp of the gyro scale factor",
    cause: "the scale factor of a gyro changes at a constant rate",
    equation: "gyro_z += S' t ω_z",
    source: "first term of the series of a slow drift",
    parameters: &[parameter(
        "z",
        Unit::PPM_PER_HOUR,
        usual((0.1, 10.0), (0.01, 0.1), (10.0, 1000.0)),
    )],
    settings: &[],
    needs: &[Need::Reversal],
    partners: &["gyro_bias_ramp", "gyro_thermal_scale", "clock_drift"],
    told_apart_by: "rotate in both directions",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Even,
    action: Action::Signal(|p, _, moment, out| {
        out.gyro[2] += p[0] * (moment.mean.time * moment.rate.z);
    }),
};

/// Dependence on the direction of the last change of the rate.
pub static GYRO_HYSTERESIS: Term = Term {
    id: "gyro_hysteresis",
    also: &[],
    name: "gyro hysteresis",
    cause: "the reading of a gyro depends on whether the rate last increased or decreased",
    equation: "gyro_z += h sgn(last dω), 0 before the first change",
    source: "ieee952",
    parameters: &[parameter(
        "z",
        Unit::DEG_PER_HOUR,
        usual((0.01, 0.2), (0.001, 0.02), (0.4, 8.0)),
    )],
    settings: &[],
    needs: &[Need::SeveralRates],
    partners: &["gyro_scale_asymmetry", "gyro_bias_step"],
    told_apart_by: "increase the rate in steps, then decrease it in the same steps",
    owner: Owner::Sensor,
    prevalence: Prevalence::Particular,
    parity: Parity::Even,
    action: Action::Signal(|p, _, moment, out| out.gyro[2] += p[0] * moment.mean.rate_change),
};

/// Zero reading at low rates.
///
/// The rate is that about the input axis of a gyro: with a misalignment of 100 arcsec, a gyro measures 17 deg/h of a table
/// rate of 10 deg/s, more than the component of the Earth's rate of up to 12 deg/h in x and y. For a dead zone in the
/// processor, after the readings are resolved along the body axes, the rates are those about the body axes.
///
/// The derivative with respect to a width of zero is zero: linearize at another width.
pub static GYRO_DEAD_ZONE: Term = Term {
    id: "gyro_dead_zone",
    also: &[],
    name: "gyro dead zone",
    cause: "lock-in of a laser gyro by backscatter, or a dead band of a closed loop",
    equation: "|ω| ≤ d: gyro -= ω; else gyro += sgn(ω) (√(ω² - d²) - |ω|), ω about the input axis of the gyro",
    source: "lock-in equation, titterton2004",
    parameters: &per_axis(Unit::DEG_PER_HOUR, usual((0.01, 0.5), (0.001, 0.05), (0.1, 20.0))),
    settings: &[Setting {
        kind: SettingKind::RateAxes,
        name: "axes",
        meaning: "axes of the rate ω: 0 input axes of the gyros, 1 body axes",
        unit: Unit::ONE,
        default: 0.0,
        within: (0.0, 1.0),
    }],
    needs: &[],
    partners: &["gyro_quantisation", "gyro_g2_sensitivity"],
    told_apart_by: "rotate slowly enough that the rate about the input axes of gyros x and y crosses zero",
    owner: Owner::Sensor,
    prevalence: Prevalence::Particular,
    parity: Parity::Even,
    action: Action::Sensed(|p, settings, moment, sensed, out| {
        let of_body = settings[0] != 0.0;
        for (axis, &width) in p.iter().enumerate() {
            let rate = if of_body { Dual64::from_re(moment.rate[axis]) } else { sensed[axis] };
            out.gyro[axis] += missing(rate, width);
        }
    }),
};

/// Half of the difference over which the slope with respect to a rate or a width is taken, as a fraction of the width: at the
/// edge of the zone the slope is unbounded and would depend on the nearest sample.
const SLOPE_OVER: f64 = 0.1;

/// Reading of a gyro with a dead zone of this width, minus the rate.
fn missing(rate: Dual64, width: Dual64) -> Dual64 {
    let apart = SLOPE_OVER * width.re;
    let by = |of_rate: f64, of_width: f64| {
        let at = |times: f64| beyond(rate.re + times * of_rate, width.re + times * of_width);
        (at(apart) - at(-apart)) / (2.0 * apart)
    };
    let mut slope = 0.0;
    if apart != 0.0 && rate.eps != 0.0 {
        slope += by(1.0, 0.0) * rate.eps;
    }
    if apart != 0.0 && width.eps != 0.0 {
        slope += by(0.0, 1.0) * width.eps;
    }
    Dual64::new(beyond(rate.re, width.re), slope)
}

/// The same, as numbers without derivatives.
fn beyond(rate: f64, width: f64) -> f64 {
    if rate.abs() <= width.abs() {
        return -rate;
    }
    // √(ω² - d²) - |ω| without the difference of two nearly equal numbers.
    let left = (rate * rate - width * width).sqrt() + rate.abs();
    -width * width / left * rate.signum()
}
