//! Parameters and settings of the files of the catalogue.

use crate::setting::{Setting, SettingKind};
use crate::term::{Parameter, Prior};
use crate::unit::Unit;

/// Typical ranges for fiber-optic gyros, laser gyros and MEMS; for pendulous accelerometers, vibrating
/// beams and MEMS.
pub(super) const fn usual(fibre: (f64, f64), laser: (f64, f64), mems: (f64, f64)) -> Prior {
    Prior::Usual([fibre, laser, mems])
}

/// A parameter of a sensor or of a table.
pub(super) const fn parameter(name: &'static str, unit: Unit, prior: Prior) -> Parameter {
    Parameter { name, unit, prior }
}

/// One parameter for each sensor of a triad.
pub(super) const fn per_axis(unit: Unit, prior: Prior) -> [Parameter; 3] {
    named(["x", "y", "z"], unit, prior)
}

/// A matrix, row by row: `zx` is the sensitivity of sensor z to the component x.
pub(super) const fn matrix(unit: Unit, prior: Prior) -> [Parameter; 9] {
    named(["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"], unit, prior)
}

/// The amplitudes of a cosine and a sine.
pub(super) const fn cos_sin(unit: Unit, prior: Prior) -> [Parameter; 2] {
    named(["cos", "sin"], unit, prior)
}

/// Parameters that differ only in their names.
pub(super) const fn named<const N: usize>(
    names: [&'static str; N],
    unit: Unit,
    prior: Prior,
) -> [Parameter; N] {
    let mut parameters = [parameter("", unit, prior); N];
    let mut place = 0;
    while place < N {
        parameters[place].name = names[place];
        place += 1;
    }
    parameters
}

/// Time of an event \[s\]; by default five minutes after the start of the run.
pub(super) const TIME: Setting = Setting {
    kind: SettingKind::Time,
    name: "time",
    meaning: "time of the event since the start of the run",
    unit: Unit::SECOND,
    default: 300.0,
    within: (0.0, 1e7),
};

/// Duration of a step \[s\]; zero by default.
pub(super) const DURATION: Setting = Setting {
    kind: SettingKind::Duration,
    name: "duration",
    meaning: "duration of the linear change; the time is its middle",
    unit: Unit::SECOND,
    default: 0.0,
    within: (0.0, 10.0),
};

/// Time constant of a transient \[s\].
pub(super) const TIME_CONSTANT: Setting = Setting {
    kind: SettingKind::TimeConstant,
    name: "time_constant",
    meaning: "time in which the effect decreases by a factor of e",
    unit: Unit::SECOND,
    default: 300.0,
    within: (1.0, 1e5),
};

/// Frequency of a periodic effect \[Hz\].
pub(super) const FREQUENCY: Setting = Setting {
    kind: SettingKind::Frequency,
    name: "frequency",
    meaning: "frequency, independent of the table rate",
    unit: Unit::HERTZ,
    default: 1.0,
    within: (1e-4, 1e4),
};

/// Axis of the sensors.
pub const AXIS: Setting = Setting {
    kind: SettingKind::Axis,
    name: "axis",
    meaning: "axis of the sensor: 1, 2, 3 for x, y, z",
    unit: Unit::ONE,
    default: 3.0,
    within: (1.0, 3.0),
};

/// Temperature at which temperature-dependent effects are zero, and to which biases and scale errors refer.
pub const REFERENCE_TEMPERATURE: Setting = Setting {
    kind: SettingKind::ReferenceTemperature,
    name: "reference_temperature",
    meaning: "temperature T_ref at which the effect is zero",
    unit: Unit::CELSIUS,
    default: 20.0,
    within: (-273.15, 1000.0),
};
