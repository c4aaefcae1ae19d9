//! Gross errors of a log or a rig file: units, axes, direction of rotation.

use nalgebra::Vector3;
use rins_frames::{Body, InFrame};

use crate::catalogue::parameters::parameter;
use crate::setting::{Setting, SettingKind};
use crate::term::{Action, Owner, Parity, Prevalence, Prior, Term};
use crate::unit::Unit;

/// Wrong units, such as degrees instead of radians.
pub static UNIT_ERROR: Term = Term {
    id: "unit_error",
    also: &[],
    name: "wrong unit",
    cause: "the unit of a column differs from the unit in the rig file; a factor of zero means none",
    equation: "gyro, accel, angle = factor · true",
    source: "degrees instead of radians 57.3, hours instead of seconds 3600, g instead of m/s² 9.81",
    parameters: &[
        parameter("gyro", Unit::ONE, Prior::Anywhere(0.0175, 57.3)),
        parameter("accel", Unit::ONE, Prior::Anywhere(0.102, 9.81)),
        parameter("angle", Unit::ONE, Prior::Anywhere(0.0175, 57.3)),
    ],
    settings: &[],
    needs: &[],
    partners: &["gyro.scale", "accel.scale"],
    told_apart_by: "gravity in static intervals, and the gyros against the table: factors of 57, 3600 or 9.8",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
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

/// Axes that differ from those of the rig file.
pub static AXIS_CONVENTION: Term = Term {
    id: "axis_convention",
    also: &[],
    name: "wrong axes",
    cause: "the axes of the log are exchanged or reversed: x = -2 means that the reading x is minus the true y",
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
        meaning: "triads with wrong axes: 0 both, 1 gyros, 2 accelerometers",
        unit: Unit::ONE,
        default: 0.0,
        within: (0.0, 2.0),
    }],
    needs: &[],
    partners: &["table_sense", "mounting"],
    told_apart_by: "regression of both triads on gravity and the table rate",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
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

/// Direction of rotation opposite to that of the log.
pub static TABLE_SENSE: Term = Term {
    id: "table_sense",
    also: &[],
    name: "wrong direction of rotation",
    cause: "the table angle or rate has the wrong sign; 1 if it has, 0 if not",
    equation: "angle = -ζ, rate = -ω",
    source: "two directions of rotation",
    parameters: &[parameter("reversed", Unit::ONE, Prior::Anywhere(1.0, 1.0))],
    settings: &[],
    needs: &[],
    partners: &["axis_convention"],
    told_apart_by: "gyro z and gravity against the table angle",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
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
