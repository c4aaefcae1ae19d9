//! Parameters and settings as the catalogue's files write them.

use crate::setting::{Setting, SettingKind};
use crate::term::{Parameter, Prior};
use crate::unit::Unit;

/// Usual magnitudes with fibre gyros, laser gyros and MEMS; with pendulous accelerometers, vibrating
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

/// A matrix, row by row: `zx` is what sensor z shows of the component x.
pub(super) const fn matrix(unit: Unit, prior: Prior) -> [Parameter; 9] {
    named(["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"], unit, prior)
}

/// The amplitudes of a cosine and a sine.
pub(super) const fn cos_sin(unit: Unit, prior: Prior) -> [Parameter; 2] {
    named(["cos", "sin"], unit, prior)
}

/// Parameters that differ in their names only.
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

/// When a step happens \[s\]; five minutes into the run where nothing is said.
pub(super) const TIME: Setting = Setting {
    kind: SettingKind::Time,
    name: "time",
    meaning: "when it happens, since the run began",
    unit: Unit::SECOND,
    default: 300.0,
    within: (0.0, 1e7),
};

/// How long a step takes \[s\]; none where nothing is said.
pub(super) const DURATION: Setting = Setting {
    kind: SettingKind::Duration,
    name: "duration",
    meaning: "how long it takes, evenly, that time being its middle",
    unit: Unit::SECOND,
    default: 0.0,
    within: (0.0, 10.0),
};

/// Over how long something settles \[s\].
pub(super) const TIME_CONSTANT: Setting = Setting {
    kind: SettingKind::TimeConstant,
    name: "time_constant",
    meaning: "the time over which it falls by e",
    unit: Unit::SECOND,
    default: 300.0,
    within: (1.0, 1e5),
};

/// How often a second something comes back \[Hz\].
pub(super) const FREQUENCY: Setting = Setting {
    kind: SettingKind::Frequency,
    name: "frequency",
    meaning: "how often it comes back, whatever the table's rate",
    unit: Unit::HERTZ,
    default: 1.0,
    within: (1e-4, 1e4),
};

/// On which of the sensors' axes something is.
pub(super) const AXIS: Setting = Setting {
    kind: SettingKind::Axis,
    name: "axis",
    meaning: "the axis on which it is: 1, 2, 3 for x, y, z",
    unit: Unit::ONE,
    default: 3.0,
    within: (1.0, 3.0),
};

/// The temperature at which what depends on temperature is zero, and at which biases and scale errors beside it are given.
pub const REFERENCE_TEMPERATURE: Setting = Setting {
    kind: SettingKind::ReferenceTemperature,
    name: "reference_temperature",
    meaning: "temperature T_ref at which the effect is zero",
    unit: Unit::CELSIUS,
    default: 20.0,
    within: (-273.15, 1000.0),
};
