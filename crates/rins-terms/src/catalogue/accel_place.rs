//! Accelerometers that are not on the spin axis.

use nalgebra::Vector3;

use crate::catalogue::parameters::{named, usual};
use crate::kinematic_state::KinematicState;
use crate::term::{Action, Owner, Parity, Prevalence, Prior, Term};
use crate::unit::Unit;

/// Specific force one meter off the spin axis along `place`, minus that on the axis \[1/s²\].
///
/// The centripetal, the tangential and the Coriolis acceleration. The Earth's own centripetal
/// acceleration is part of gravity.
fn felt_at(moment: &KinematicState, place: &Vector3<f64>) -> Vector3<f64> {
    let spin = Vector3::z() * moment.mean.rate;
    let velocity = spin.cross(place);
    let earth = moment.rate - spin;
    spin.cross(&velocity)
        + Vector3::z().cross(place) * moment.mean.acceleration
        + earth.cross(&velocity) * 2.0
}

/// Positions of the accelerometers: from navigation-grade IMUs centered on the axis to phones off the axis.
const PLACES: Prior = usual((0.5, 300.0), (0.5, 300.0), (0.5, 300.0));

/// All accelerometers at one position off the spin axis.
///
/// A position along the axis has no effect.
pub static ACCEL_LEVER_ARM: Term = Term {
    id: "accel_lever_arm",
    also: &[],
    name: "lever arm of the accelerometers",
    cause: "the accelerometers are off the spin axis, at the position r in the body frame",
    equation: "accel += ω×(ω×r) + ω'×r + 2 ω_ie×(ω×r), ω of the table",
    source: "kinematics of a rigid body; groves2013",
    parameters: &named(["r_x", "r_y"], Unit::MILLIMETRE, PLACES),
    settings: &[],
    needs: &[],
    partners: &["accel_size_effect", "accel.bias", "accel_vibration_rectification"],
    told_apart_by: "rotate at two rates; change the rate quickly; move the IMU on the table",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| {
        out.add_accel(p[0], &felt_at(moment, &Vector3::x()));
        out.add_accel(p[1], &felt_at(moment, &Vector3::y()));
    }),
};

/// Each accelerometer at its own position.
///
/// The effect on accelerometer z is only the Coriolis acceleration and is neglected.
pub static ACCEL_SIZE_EFFECT: Term = Term {
    id: "accel_size_effect",
    also: &[],
    name: "size effect",
    cause: "accelerometers x and y are at different positions; x_r_y: y coordinate of accelerometer x",
    equation: "accel_i += [ω×(ω×r_i) + ω'×r_i + 2 ω_ie×(ω×r_i)]_i, i = x, y",
    source: "kinematics of a rigid body; groves2013",
    parameters: &named(
        ["x_r_x", "x_r_y", "y_r_x", "y_r_y"],
        Unit::MILLIMETRE,
        usual((1.0, 60.0), (1.0, 60.0), (0.1, 10.0)),
    ),
    settings: &[],
    needs: &[],
    partners: &["accel_lever_arm", "accel.bias"],
    told_apart_by: "ramps of the rate: both axes have the same lever arm if the position is the same; two rates",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
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
