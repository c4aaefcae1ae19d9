//! A log that means something else than was said of it: units, axes, the table's sense.

use nalgebra::Vector3;
use rins_frames::{Body, InFrame};

use crate::catalogue::parameters::parameter;
use crate::setting::{Setting, SettingKind};
use crate::term::{Action, Owner, Parity, Prior, Term};
use crate::unit::Unit;

/// Degrees that are radians, and the like.
pub static UNIT_ERROR: Term = Term {
    id: "unit_error",
    also: &[],
    name: "wrong unit",
    cause: "a log was read in another unit than it was written in; the factor zero stands for none",
    equation: "gyro, accel, angle = factor · true",
    source: "degrees for radians 57.3, hours for seconds 3600, g for m/s² 9.81",
    parameters: &[
        parameter("gyro", Unit::ONE, Prior::Anywhere(0.0175, 57.3)),
        parameter("accel", Unit::ONE, Prior::Anywhere(0.102, 9.81)),
        parameter("angle", Unit::ONE, Prior::Anywhere(0.0175, 57.3)),
    ],
    settings: &[],
    needs: &[],
    partners: &["gyro.scale", "accel.scale"],
    told_apart_by: "gravity at rest, and the gyros against the table: factors of 57, 3600 or 9.8 name themselves",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Log(|p, _, _, recording| {
        let [gyro, accel, angle] = [0, 1, 2].map(|k| if p[k] == 0.0 { 1.0 } else { p[k] });
        for increments in &mut recording.increments {
            increments.angle = increments.angle * gyro;
            increments.velocity = increments.velocity * accel;
        }
        for turned in recording.table_angle.iter_mut().flatten() {
            *turned *= angle;
        }
    }),
};

/// Axes that are others than was said.
pub static AXIS_CONVENTION: Term = Term {
    id: "axis_convention",
    also: &[],
    name: "wrong axes",
    cause: "a log's axes were taken for others: x = -2 says that what is read as x is minus what happens along y",
    equation: "read_i = sgn(a_i) true_|a_i|, a_i among ±1, ±2, ±3; 0 leaves i as it is",
    source: "signed permutations of three axes",
    parameters: &[
        parameter("x", Unit::ONE, Prior::Anywhere(2.0, 3.0)),
        parameter("y", Unit::ONE, Prior::Anywhere(1.0, 3.0)),
        parameter("z", Unit::ONE, Prior::Anywhere(1.0, 2.0)),
    ],
    settings: &[Setting {
        kind: SettingKind::Triads,
        name: "sensors",
        meaning: "0: both triads; 1: gyros; 2: accelerometers",
        unit: Unit::ONE,
        default: 0.0,
        within: (0.0, 2.0),
    }],
    needs: &[],
    partners: &["table_sense", "mounting"],
    told_apart_by: "a regression of both triads on gravity and the table's rate",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Log(|p, settings, _, recording| {
        let read = |vector: &InFrame<Body>| {
            let v = vector.components();
            let sources = [v.x, v.y, v.z];
            let component = |axis: usize| match p[axis].abs().round() {
                1.0 => v.x * p[axis].signum(),
                2.0 => v.y * p[axis].signum(),
                3.0 => v.z * p[axis].signum(),
                _ => sources[axis],
            };
            InFrame::from_components(Vector3::new(component(0), component(1), component(2)))
        };
        let sensors = settings[0].round();
        for increments in &mut recording.increments {
            if sensors < 1.5 {
                increments.angle = read(&increments.angle);
            }
            if !(0.5..1.5).contains(&sensors) {
                increments.velocity = read(&increments.velocity);
            }
        }
    }),
};

/// A table that turns the other way than was said.
pub static TABLE_SENSE: Term = Term {
    id: "table_sense",
    also: &[],
    name: "wrong sense of the table",
    cause: "the table's angle or rate counts the other way; 1 says that it does, 0 that it does not",
    equation: "angle = -ζ, rate = -ω",
    source: "the two senses of an axis",
    parameters: &[parameter("reversed", Unit::ONE, Prior::Anywhere(1.0, 1.0))],
    settings: &[],
    needs: &[],
    partners: &["axis_convention"],
    told_apart_by: "gyro z and gravity against the table's angle",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Log(|p, _, _, recording| {
        if p[0] != 0.0 {
            let tables = [&mut recording.table_angle, &mut recording.table_rate];
            for value in tables.into_iter().flatten().flatten() {
                *value = -*value;
            }
        }
    }),
};
