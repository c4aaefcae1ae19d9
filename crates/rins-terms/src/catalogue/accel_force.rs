//! Errors of the accelerometers that are not linear in the specific force.

use nalgebra::Vector3;

use crate::catalogue::parameters::{named, per_axis, usual};
use crate::signals::add_scaled;
use crate::term::{Action, Need, Owner, Parity, Prevalence, Term};
use crate::unit::Unit;

/// Error proportional to the square of the specific force.
pub static ACCEL_QUADRATIC: Term = Term {
    id: "accel_quadratic",
    also: &[],
    name: "quadratic accelerometer error, K2",
    cause: "the response of an accelerometer has an even part",
    equation: "accel_i += K2_i f_i²",
    source: "titterton2004",
    parameters: &per_axis(Unit::MICRO_G_PER_G2, usual((5.0, 50.0), (5.0, 20.0), (50.0, 5000.0))),
    settings: &[],
    needs: &[Need::Tilt],
    partners: &["accel_asymmetry", "accel_lever_arm", "accel_cross_coupling", "accel.bias"],
    told_apart_by: "tilt the spin axis by 45 deg and more",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| {
        add_scaled(&mut out.accel, p, &moment.force.map(|f| f * f));
    }),
};

/// Error proportional to the cube of the specific force.
pub static ACCEL_CUBIC: Term = Term {
    id: "accel_cubic",
    also: &[],
    name: "cubic accelerometer error, K3",
    cause: "the scale factor of an accelerometer increases with the specific force",
    equation: "accel_i += K3_i f_i³",
    source: "titterton2004",
    parameters: &per_axis(Unit::MICRO_G_PER_G3, usual((1.0, 20.0), (1.0, 10.0), (20.0, 2000.0))),
    settings: &[],
    needs: &[Need::Tilt],
    partners: &["accel.scale"],
    told_apart_by: "tilt the spin axis by 45 to 90 deg",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Even,
    action: Action::Signal(|p, _, moment, out| {
        add_scaled(&mut out.accel, p, &moment.force.map(|f| f * f * f));
    }),
};

/// Scale factor that depends on the sign of the specific force.
pub static ACCEL_ASYMMETRY: Term = Term {
    id: "accel_asymmetry",
    also: &[],
    name: "asymmetry of the accelerometer scale factor",
    cause: "the scale factor of an accelerometer differs between positive and negative specific force",
    equation: "accel_i += A_i |f_i|",
    source: "even part of a scale factor",
    parameters: &per_axis(Unit::PPM, usual((5.0, 50.0), (1.0, 20.0), (20.0, 2000.0))),
    settings: &[],
    needs: &[Need::Tilt],
    partners: &["accel_quadratic", "accel.bias"],
    told_apart_by: "static intervals every 45 deg of a tilted table; tilt the spin axis by 45 deg and more",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Tensor,
    action: Action::Signal(|p, _, moment, out| {
        add_scaled(&mut out.accel, p, &moment.force.abs());
    }),
};

/// Error proportional to the product of the specific forces along two axes.
pub static ACCEL_CROSS_COUPLING: Term = Term {
    id: "accel_cross_coupling",
    also: &[],
    name: "cross-coupling of the accelerometers",
    cause: "specific force across the input axis of an accelerometer turns that axis; xy: accelerometer x, force along y",
    equation: "accel_i += K_ij f_i f_j, j ≠ i",
    source: "titterton2004",
    parameters: &named(
        ["xy", "xz", "yx", "yz", "zx", "zy"],
        Unit::MICRO_G_PER_G2,
        usual((5.0, 50.0), (2.0, 20.0), (20.0, 2000.0)),
    ),
    settings: &[],
    needs: &[Need::SeveralTilts],
    partners: &["accel_quadratic", "accel.scale", "accel.misalignment"],
    told_apart_by: "tilt the spin axis to other angles",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::LastAxis,
    action: Action::Signal(|p, _, moment, out| {
        let f = moment.force;
        let first = Vector3::new(f.x * f.y, f.y * f.x, f.z * f.x);
        let second = Vector3::new(f.x * f.z, f.y * f.z, f.z * f.y);
        add_scaled(&mut out.accel, &[p[0], p[2], p[4]], &first);
        add_scaled(&mut out.accel, &[p[1], p[3], p[5]], &second);
    }),
};
