//! The baseline of the table: where its axis points, how the IMU sits on it, where its encoder's zero is.

use nalgebra::Vector3;

use crate::signals::add_constant;
use crate::term::{Action, Need, Owner, Parameter, Parity, Prior, Term};
use crate::unit::Unit;
use crate::waves::sin_cos;

/// A survey is some minutes of arc off, or none.
const fn angle(name: &'static str, high: f64) -> Parameter {
    Parameter { name, unit: Unit::ARCSEC, prior: Prior::Anywhere(1.0, high) }
}

/// The error of the surveyed attitude of the axis.
pub static AXIS_ATTITUDE: Term = Term {
    id: "axis.attitude",
    also: &[],
    name: "attitude of the axis",
    cause: "the axis frame does not stand as it was surveyed",
    equation: "C_s^n Rot(θ) instead of C_s^n, θ constant in the axis frame",
    source: "nie2019, eq. (5)",
    parameters: &[angle("x", 360.0), angle("y", 360.0), angle("z", 360.0)],
    settings: &[],
    needs: &[],
    partners: &["encoder.zero", "accel.scale", "wrong_latitude"],
    told_apart_by: "z and the encoder's zero are one number; x and y: tilt the axis otherwise",
    owner: Owner::Placement,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, _, out| add_constant(&mut out.tilt, p, 1.0)),
};

/// How the body axes stand against the axis of rotation.
pub static MOUNTING: Term = Term {
    id: "mounting",
    also: &[],
    name: "mounting of the IMU on the table",
    cause: "the body's z axis is not the axis of rotation",
    equation: "C_b^s = Rz(ζ) Rot(m), m constant in the body",
    source: "gauge: body z is the spin axis unless a model says otherwise",
    parameters: &[angle("x", 600.0), angle("y", 600.0)],
    settings: &[],
    needs: &[],
    partners: &["gyro.misalignment", "accel.misalignment"],
    told_apart_by: "never: it is a choice of body axes; hold the misalignments xz and yz of one triad instead",
    owner: Owner::Run,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| {
        let (sin, cos) = sin_cos(moment.end.angle);
        out.add_tilt(p[0], &Vector3::new(cos, sin, 0.0));
        out.add_tilt(p[1], &Vector3::new(-sin, cos, 0.0));
    }),
};

/// What the encoder reads where the axis frame has its zero.
pub static ENCODER_ZERO: Term = Term {
    id: "encoder.zero",
    also: &[],
    name: "zero of the encoder",
    cause: "the encoder's zero is not that of the axis frame",
    equation: "angle += z0",
    source: "gauge: the axis frame's own zero unless a model says otherwise",
    parameters: &[angle("angle", 3600.0)],
    settings: &[],
    needs: &[Need::TableAngle],
    partners: &["axis.attitude"],
    told_apart_by: "never: hold one of both",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, _, out| out.angle += p[0]),
};
