//! Biases that follow the temperature along a curve, or behind it.

use num_dual::Dual64;

use crate::catalogue::parameters::{REFERENCE_TEMPERATURE, TIME_CONSTANT, named, per_axis, usual};
use crate::setting::Setting;
use crate::signals::{DualVector, add_constant};
use crate::term::{Action, Need, Owner, Parameter, Parity, Prevalence, Prior, Term};
use crate::unit::Unit;

/// The degree of the polynomials in temperature, as of the IEEE 952 and 1293 error models.
pub const THERMAL_DEGREE: usize = 3;

// Typical curvature of MEMS: that of a measured cycle from -18 to 74 degC; of the others 0.01 per K and 6e-5 per K² of the slope.

/// The time constant of a sensor behind its thermometer \[s\].
const LAG: Setting = Setting {
    meaning: "time constant with which the sensor follows its thermometer",
    ..TIME_CONSTANT
};

/// The coefficients of the first, second and third power, each of all axes.
const fn polynomial(
    units: [Unit; THERMAL_DEGREE],
    priors: [Prior; THERMAL_DEGREE],
) -> [Parameter; 9] {
    let [linear_x, linear_y, linear_z] =
        named(["linear_x", "linear_y", "linear_z"], units[0], priors[0]);
    let [square_x, square_y, square_z] =
        named(["square_x", "square_y", "square_z"], units[1], priors[1]);
    let [cube_x, cube_y, cube_z] = named(["cube_x", "cube_y", "cube_z"], units[2], priors[2]);
    [linear_x, linear_y, linear_z, square_x, square_y, square_z, cube_x, cube_y, cube_z]
}

/// Adds the polynomial of a temperature difference \[K\].
fn add_polynomial(to: &mut DualVector, parameters: &[Dual64], above: f64) {
    let mut power = 1.0;
    for of_degree in parameters.chunks_exact(3) {
        power *= above;
        add_constant(to, of_degree, power);
    }
}

/// Dependence of the gyro biases on temperature along a curve.
pub static GYRO_THERMAL_POLYNOMIAL: Term = Term {
    id: "gyro_thermal_polynomial",
    also: &[],
    name: "temperature polynomial of the gyro bias",
    cause: "the bias of a gyro depends on its temperature, not linearly over the range of the run",
    equation: "gyro += k1 (T - T_ref) + k2 (T - T_ref)² + k3 (T - T_ref)³",
    source: "series of the bias in temperature to the third power; curvature as of a measured thermal cycle",
    parameters: &polynomial(
        [
            Unit::DEG_PER_HOUR_PER_KELVIN,
            Unit::DEG_PER_HOUR_PER_KELVIN_2,
            Unit::DEG_PER_HOUR_PER_KELVIN_3,
        ],
        [
            usual((0.005, 0.1), (5e-4, 0.01), (0.3, 30.0)),
            usual((1e-5, 1e-3), (1e-6, 1e-4), (3e-3, 2.0)),
            usual((6e-8, 6e-6), (6e-9, 6e-7), (2e-5, 0.02)),
        ],
    ),
    settings: &[REFERENCE_TEMPERATURE],
    needs: &[Need::Temperature, Need::TemperatureRange],
    partners: &["gyro_thermal_bias", "gyro_thermal_lag", "gyro_warmup"],
    told_apart_by: "raise and lower the temperature over the range of use",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        add_polynomial(&mut out.gyro, p, moment.mean.above(settings[0]));
    }),
};

/// Thermal hysteresis of the gyro biases: the sensor is at another temperature than its thermometer while that changes.
pub static GYRO_THERMAL_LAG: Term = Term {
    id: "gyro_thermal_lag",
    also: &[],
    name: "thermal hysteresis of the gyros",
    cause: "the sensing element follows its thermometer with a time constant, so that heating and cooling differ",
    equation: "gyro += k (T_τ - T), T_τ the temperature after a low-pass 1/(1 + τ d/dt)",
    source: "one thermal time constant; for short ones -k τ dT/dt",
    parameters: &per_axis(
        Unit::DEG_PER_HOUR_PER_KELVIN,
        usual((0.005, 0.1), (5e-4, 0.01), (0.3, 30.0)),
    ),
    settings: &[LAG],
    needs: &[Need::Temperature, Need::TemperatureRange],
    partners: &["gyro_shupe", "gyro_warmup", "gyro_thermal_polynomial"],
    told_apart_by: "hold the temperature after a step: it fades with the time constant, the Shupe effect at once",
    owner: Owner::Sensor,
    prevalence: Prevalence::Particular,
    parity: Parity::Tensor,
    action: Action::Soaking(|p, behind, out| add_constant(&mut out.gyro, p, behind)),
};

/// Dependence of the accelerometer biases on temperature along a curve.
pub static ACCEL_THERMAL_POLYNOMIAL: Term = Term {
    id: "accel_thermal_polynomial",
    also: &[],
    name: "temperature polynomial of the accelerometer bias",
    cause: "the bias of an accelerometer depends on its temperature, not linearly over the range of the run",
    equation: "accel += k1 (T - T_ref) + k2 (T - T_ref)² + k3 (T - T_ref)³",
    source: "series of the bias in temperature to the third power; curvature as of a measured thermal cycle",
    parameters: &polynomial(
        [Unit::MICRO_G_PER_KELVIN, Unit::MICRO_G_PER_KELVIN_2, Unit::MICRO_G_PER_KELVIN_3],
        [
            usual((1.0, 50.0), (1.0, 20.0), (50.0, 2000.0)),
            usual((0.01, 0.5), (0.01, 0.2), (0.5, 40.0)),
            usual((6e-5, 3e-3), (6e-5, 1.2e-3), (3e-3, 0.6)),
        ],
    ),
    settings: &[REFERENCE_TEMPERATURE],
    needs: &[Need::Temperature, Need::TemperatureRange],
    partners: &["accel_thermal_bias", "accel_thermal_lag", "accel_warmup"],
    told_apart_by: "raise and lower the temperature over the range of use",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, settings, moment, out| {
        add_polynomial(&mut out.accel, p, moment.mean.above(settings[0]));
    }),
};

/// Thermal hysteresis of the accelerometer biases.
pub static ACCEL_THERMAL_LAG: Term = Term {
    id: "accel_thermal_lag",
    also: &[],
    name: "thermal hysteresis of the accelerometers",
    cause: "the proof mass follows its thermometer with a time constant, so that heating and cooling differ",
    equation: "accel += k (T_τ - T), T_τ the temperature after a low-pass 1/(1 + τ d/dt)",
    source: "one thermal time constant",
    parameters: &per_axis(
        Unit::MICRO_G_PER_KELVIN,
        usual((1.0, 50.0), (1.0, 20.0), (50.0, 2000.0)),
    ),
    settings: &[LAG],
    needs: &[Need::Temperature, Need::TemperatureRange],
    partners: &["accel_warmup", "accel_thermal_polynomial", "base_tilt_ramp"],
    told_apart_by: "hold the temperature after a step: it fades with the time constant",
    owner: Owner::Sensor,
    prevalence: Prevalence::Particular,
    parity: Parity::Tensor,
    action: Action::Soaking(|p, behind, out| add_constant(&mut out.accel, p, behind)),
};
