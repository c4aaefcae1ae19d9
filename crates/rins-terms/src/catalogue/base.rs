//! Alignment of the table: attitude of the spin axis, mounting of the IMU, zero of the encoder.

use nalgebra::Vector3;

use crate::signals::add_constant;
use crate::term::{Action, Need, Owner, Parameter, Parity, Prevalence, Prior, Term};
use crate::unit::Unit;
use crate::waves::sin_cos;

/// The error of a survey is up to some arc minutes.
const fn angle(name: &'static str, high: f64) -> Parameter {
    Parameter { name, unit: Unit::ARCSEC, prior: Prior::Anywhere(1.0, high) }
}

/// The error of the surveyed attitude of the axis.
pub static AXIS_ATTITUDE: Term = Term {
    id: "axis.attitude",
    also: &[],
    name: "attitude of the spin axis",
    cause: "the attitude of the axis frame differs from the surveyed one",
    equation: "C_s^n Rot(θ) instead of C_s^n, θ constant in the axis frame",
    source: "nie2019, eq. (5)",
    parameters: &[angle("x", 360.0), angle("y", 360.0), angle("z", 360.0)],
    settings: &[],
    needs: &[],
    partners: &["encoder.zero", "accel.scale", "wrong_latitude"],
    told_apart_by: "z is not distinguishable from the zero of the encoder; x and y: tilt the spin axis to other angles",
    owner: Owner::Placement,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, _, out| add_constant(&mut out.tilt, p, 1.0)),
};

/// Orientation of the body axes relative to the spin axis.
pub static MOUNTING: Term = Term {
    id: "mounting",
    also: &[],
    name: "mounting of the IMU on the table",
    cause: "the z axis of the body frame is not parallel to the spin axis",
    equation: "C_b^s = Rz(ζ) Rot(m), m constant in the body frame",
    source: "gauge: z of the body frame is the spin axis unless a model states a mounting",
    parameters: &[angle("x", 600.0), angle("y", 600.0)],
    settings: &[],
    needs: &[],
    partners: &["gyro.misalignment", "accel.misalignment"],
    told_apart_by: "no test: it is a choice of body axes; fix the misalignments xz and yz of one triad instead",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| {
        let (sin, cos) = sin_cos(moment.end.angle);
        out.add_tilt(p[0], &Vector3::new(cos, sin, 0.0));
        out.add_tilt(p[1], &Vector3::new(-sin, cos, 0.0));
    }),
};

/// Reading of the encoder at the zero of the axis frame.
pub static ENCODER_ZERO: Term = Term {
    id: "encoder.zero",
    also: &[],
    name: "zero of the encoder",
    cause: "the zero of the encoder differs from that of the axis frame",
    equation: "angle += z0",
    source: "gauge: the zero of the axis frame unless a model states another",
    parameters: &[angle("angle", 3600.0)],
    settings: &[],
    needs: &[Need::TableAngle],
    partners: &["axis.attitude"],
    told_apart_by: "no test: fix one of the two",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, _, out| out.angle += p[0]),
};
