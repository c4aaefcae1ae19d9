//! What gyro z shows of the table's rate beyond a constant scale error, and what gyros show of a slow rate.
//!
//! Only gyro z has scale effects of second order: x and y see no more than the Earth's rate.

use num_dual::Dual64;

use crate::catalogue::parameters::{REFERENCE_TEMPERATURE, parameter, per_axis, usual};
use crate::setting::{Setting, SettingKind};
use crate::term::{Action, Need, Owner, Parity, Term};
use crate::unit::Unit;

/// A scale error that changes sign with the rate.
pub static GYRO_SCALE_ASYMMETRY: Term = Term {
    id: "gyro_scale_asymmetry",
    also: &[],
    name: "asymmetry of the gyro scale",
    cause: "a gyro's scale factor differs between the two senses of rotation",
    equation: "gyro_z += A |ω_z|",
    source: "the even part of a scale factor; ieee952",
    parameters: &[parameter("z", Unit::PPM, usual((1.0, 50.0), (0.1, 1.0), (10.0, 500.0)))],
    settings: &[],
    needs: &[Need::Reversal, Need::SeveralRates],
    partners: &["gyro.bias", "encoder_latency", "gyro_rate_dependent_bias", "gyro_hysteresis"],
    told_apart_by: "turn both ways at three rates, with rests",
    owner: Owner::Sensor,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| out.gyro[2] += p[0] * moment.rate.z.abs()),
};

/// A scale error that grows with the rate.
pub static GYRO_SCALE_NONLINEARITY: Term = Term {
    id: "gyro_scale_nonlinearity",
    also: &[],
    name: "nonlinearity of the gyro scale",
    cause: "a gyro's scale factor depends on the rate",
    equation: "gyro_z += k2 ω_z |ω_z| + k3 ω_z³",
    source: "the odd terms of a scale factor's series in the rate; ieee952",
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
    told_apart_by: "turn at four rates, the largest ten times the smallest",
    owner: Owner::Sensor,
    parity: Parity::Even,
    action: Action::Signal(|p, _, moment, out| {
        let w = moment.rate.z;
        out.gyro[2] += p[0] * (w * w.abs()) + p[1] * (w * w * w);
    }),
};

/// A scale error that follows the temperature.
pub static GYRO_THERMAL_SCALE: Term = Term {
    id: "gyro_thermal_scale",
    also: &[],
    name: "temperature coefficient of the gyro scale",
    cause: "a gyro's scale factor depends on its temperature",
    equation: "gyro_z += k (T - T_ref) ω_z",
    source: "the first term of a scale factor's series in temperature",
    parameters: &[parameter(
        "z",
        Unit::PPM_PER_KELVIN,
        usual((1.0, 100.0), (0.01, 0.1), (20.0, 200.0)),
    )],
    settings: &[REFERENCE_TEMPERATURE],
    needs: &[Need::Temperature, Need::Reversal],
    partners: &["gyro_thermal_bias", "gyro_scale_ramp"],
    told_apart_by: "turn both ways while the temperature changes",
    owner: Owner::Sensor,
    parity: Parity::Even,
    action: Action::Signal(|p, settings, moment, out| {
        out.gyro[2] += p[0] * (moment.mean.above(settings[0]) * moment.rate.z);
    }),
};

/// A scale error that drifts.
pub static GYRO_SCALE_RAMP: Term = Term {
    id: "gyro_scale_ramp",
    also: &[],
    name: "gyro scale ramp",
    cause: "a gyro's scale factor drifts at a constant rate",
    equation: "gyro_z += S' t ω_z",
    source: "the first term of a slow drift's series",
    parameters: &[parameter(
        "z",
        Unit::PPM_PER_HOUR,
        usual((0.1, 10.0), (0.01, 0.1), (10.0, 1000.0)),
    )],
    settings: &[],
    needs: &[Need::Reversal],
    partners: &["gyro_bias_ramp", "gyro_thermal_scale", "clock_drift"],
    told_apart_by: "turn the table both ways",
    owner: Owner::Run,
    parity: Parity::Even,
    action: Action::Signal(|p, _, moment, out| {
        out.gyro[2] += p[0] * (moment.mean.time * moment.rate.z);
    }),
};

/// A gyro that remembers how its rate last changed.
pub static GYRO_HYSTERESIS: Term = Term {
    id: "gyro_hysteresis",
    also: &[],
    name: "gyro hysteresis",
    cause: "a gyro shows one rate after a rise and another after a fall",
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
    told_apart_by: "go up and down a ladder of rates",
    owner: Owner::Sensor,
    parity: Parity::Even,
    action: Action::Signal(|p, _, moment, out| out.gyro[2] += p[0] * moment.mean.rate_change),
};

/// Gyros that do not see a slow rate.
///
/// What is slow is the rate about a gyro's own axis: 100 arcsec of misalignment see 17 deg/h of a table that turns at
/// 10 deg/s, more than the 12 deg/h that the Earth's rate has for x and y. A zone that is a processor's, before it resolves
/// readings along the body's axes, is about these.
///
/// The derivative by a width of zero is zero: linearise at a width that is not.
pub static GYRO_DEAD_ZONE: Term = Term {
    id: "gyro_dead_zone",
    also: &[],
    name: "gyro dead zone",
    cause: "backscatter locks a laser gyro in, or a closed loop has a dead band",
    equation: "|ω| ≤ d: gyro -= ω; else gyro += sgn(ω) (√(ω² - d²) - |ω|), ω about the gyro's own axis",
    source: "the lock-in equation, titterton2004",
    parameters: &per_axis(Unit::DEG_PER_HOUR, usual((0.01, 0.5), (0.001, 0.05), (0.1, 20.0))),
    settings: &[Setting {
        kind: SettingKind::RateAxes,
        name: "axes",
        meaning: "about which axes the rate is: 0 the gyros' own, 1 the body's",
        unit: Unit::ONE,
        default: 0.0,
        within: (0.0, 1.0),
    }],
    needs: &[],
    partners: &["gyro_quantisation", "gyro_g2_sensitivity"],
    told_apart_by: "turn slowly enough for the rate about the gyro's own axis to cross zero in x and y",
    owner: Owner::Sensor,
    parity: Parity::Even,
    action: Action::Sensed(|p, settings, moment, sensed, out| {
        let of_body = settings[0] != 0.0;
        for (axis, &width) in p.iter().enumerate() {
            let rate = if of_body { Dual64::from_re(moment.rate[axis]) } else { sensed[axis] };
            out.gyro[axis] += missing(rate, width);
        }
    }),
};

/// The slope by a rate or a width is taken between such so much smaller and larger, as a part of the width: at the zone's
/// edge it has no bound, and would be that of whichever sample is nearest.
const SLOPE_OVER: f64 = 0.1;

/// What a gyro with a dead zone of this width reads beyond a rate.
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
