//! Signals of no known cause: of a frequency, or of an order of the table angle.

use rins_terms::{
    Action, Dual64, KinematicState, Owner, Parameter, Parity, Prevalence, Prior, Setting,
    SettingKind, Signals, Term, Unit, sin_cos,
};

/// The channels on which a disturbance may be, each with a cosine and a sine.
pub(crate) const CHANNELS: [&str; 7] =
    ["gyro.x", "gyro.y", "gyro.z", "accel.x", "accel.y", "accel.z", "encoder"];

pub(super) const GYRO: Prior = Prior::Sheet(|imu| imu.gyro.bias_sigma);
pub(super) const ACCEL: Prior = Prior::Sheet(|imu| imu.accel.bias_sigma);
const ANGLE: Prior = Prior::Anywhere(0.1, 10.0);

pub(super) const fn of(name: &'static str, unit: Unit, prior: Prior) -> Parameter {
    Parameter { name, unit, prior }
}

const PARAMETERS: &[Parameter] = &[
    of("gyro_x_cos", Unit::DEG_PER_HOUR, GYRO),
    of("gyro_x_sin", Unit::DEG_PER_HOUR, GYRO),
    of("gyro_y_cos", Unit::DEG_PER_HOUR, GYRO),
    of("gyro_y_sin", Unit::DEG_PER_HOUR, GYRO),
    of("gyro_z_cos", Unit::DEG_PER_HOUR, GYRO),
    of("gyro_z_sin", Unit::DEG_PER_HOUR, GYRO),
    of("accel_x_cos", Unit::MICRO_G, ACCEL),
    of("accel_x_sin", Unit::MICRO_G, ACCEL),
    of("accel_y_cos", Unit::MICRO_G, ACCEL),
    of("accel_y_sin", Unit::MICRO_G, ACCEL),
    of("accel_z_cos", Unit::MICRO_G, ACCEL),
    of("accel_z_sin", Unit::MICRO_G, ACCEL),
    of("angle_cos", Unit::ARCSEC, ANGLE),
    of("angle_sin", Unit::ARCSEC, ANGLE),
];

const fn disturbance(
    name: &'static str,
    settings: &'static [Setting],
    act: fn(&[Dual64], &[f64], &KinematicState, &mut Signals),
) -> Term {
    Term {
        id: "disturbance",
        also: &[],
        name,
        cause: "unknown",
        equation: "gyro, accel, angle += c cos ψ + s sin ψ",
        source: "none: a description, not a cause",
        parameters: PARAMETERS,
        settings,
        needs: &[],
        partners: &[],
        told_apart_by: "",
        owner: Owner::Run,
        prevalence: Prevalence::Unknown,
        parity: Parity::Tensor,
        action: Action::Signal(act),
    }
}

/// Of a frequency \[Hz\].
pub(crate) static IN_TIME: Term = disturbance(
    "spectral line of unknown cause",
    &[Setting {
        kind: SettingKind::Frequency,
        name: "frequency",
        meaning: "frequency of the spectral line",
        unit: Unit::HERTZ,
        default: 1.0,
        within: (0.0, 1e4),
    }],
    |p, settings, moment, out| {
        let phase = |time: f64| std::f64::consts::TAU * settings[0] * time;
        act(p, phase(moment.mean.time), phase(moment.end.time), out);
    },
);

/// Of an order of the table angle.
pub(crate) static IN_ANGLE: Term = disturbance(
    "harmonic order of unknown cause",
    &[Setting {
        kind: SettingKind::Order,
        name: "order",
        meaning: "harmonic order: periods per revolution",
        unit: Unit::ONE,
        default: 1.0,
        within: (0.0, 1e3),
    }],
    |p, settings, moment, out| {
        act(p, settings[0] * moment.mean.angle, settings[0] * moment.end.angle, out);
    },
);

fn act(p: &[Dual64], mean: f64, end: f64, out: &mut Signals) {
    let (sin, cos) = sin_cos(mean);
    for axis in 0..3 {
        out.gyro[axis] += p[2 * axis] * cos + p[2 * axis + 1] * sin;
        out.accel[axis] += p[6 + 2 * axis] * cos + p[7 + 2 * axis] * sin;
    }
    let (sin, cos) = sin_cos(end);
    out.angle += p[12] * cos + p[13] * sin;
}
