//! Accelerometers that do not sit on the axis of rotation.

use nalgebra::Vector3;

use crate::catalogue::parameters::{named, usual};
use crate::moment::Moment;
use crate::term::{Action, Owner, Parity, Prior, Term};
use crate::unit::Unit;

/// What is felt a metre off the axis along `place`, beyond what is felt on it \[1/s²\].
///
/// The centripetal, the tangential and the Coriolis acceleration. The Earth's own centripetal
/// acceleration is part of gravity.
fn felt_at(moment: &Moment, place: &Vector3<f64>) -> Vector3<f64> {
    let spin = Vector3::z() * moment.mean.rate;
    let velocity = spin.cross(place);
    let earth = moment.rate - spin;
    spin.cross(&velocity)
        + Vector3::z().cross(place) * moment.mean.acceleration
        + earth.cross(&velocity) * 2.0
}

/// Where the accelerometers sit: the navigation-grade ones were brought to the axis, phones were not.
const PLACES: Prior = usual((0.5, 300.0), (0.5, 300.0), (0.5, 300.0));

/// All accelerometers at one place off the axis.
///
/// A place along the axis makes no difference.
pub static ACCEL_LEVER_ARM: Term = Term {
    id: "accel_lever_arm",
    also: &[],
    name: "lever arm of the accelerometers",
    cause: "the accelerometers sit off the axis of rotation, at r in body axes",
    equation: "accel += ω×(ω×r) + ω'×r + 2 ω_ie×(ω×r), ω of the table",
    source: "the kinematics of a rigid body; groves2013",
    parameters: &named(["r_x", "r_y"], Unit::MILLIMETRE, PLACES),
    settings: &[],
    needs: &[],
    partners: &["accel_size_effect", "accel.bias", "accel_vibration_rectification"],
    told_apart_by: "turn at two rates; ramp hard; shift the IMU on the table",
    owner: Owner::Run,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| {
        out.add_accel(p[0], &felt_at(moment, &Vector3::x()));
        out.add_accel(p[1], &felt_at(moment, &Vector3::y()));
    }),
};

/// Each accelerometer at a place of its own.
///
/// Accelerometer z feels no more than the Coriolis acceleration, and has no place here.
pub static ACCEL_SIZE_EFFECT: Term = Term {
    id: "accel_size_effect",
    also: &[],
    name: "size effect",
    cause: "accelerometers x and y sit at two places; x_r_y: how far along y that of accelerometer x is",
    equation: "accel_i += [ω×(ω×r_i) + ω'×r_i + 2 ω_ie×(ω×r_i)]_i, i = x, y",
    source: "the kinematics of a rigid body; groves2013",
    parameters: &named(
        ["x_r_x", "x_r_y", "y_r_x", "y_r_y"],
        Unit::MILLIMETRE,
        usual((1.0, 60.0), (1.0, 60.0), (0.1, 10.0)),
    ),
    settings: &[],
    needs: &[],
    partners: &["accel_lever_arm", "accel.bias"],
    told_apart_by: "ramps, which both axes must feel alike if there is one place; two rates",
    owner: Owner::Sensor,
    parity: Parity::LastAxis,
    action: Action::Signal(|p, _, moment, out| {
        for (column, place) in [Vector3::x(), Vector3::y()].iter().enumerate() {
            let felt = felt_at(moment, place);
            for axis in 0..2 {
                out.accel[axis] += p[2 * axis + column] * felt[axis];
            }
        }
    }),
};
