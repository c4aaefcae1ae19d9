//! Base motion: tilt, sway, rotation, rolling.

use nalgebra::Vector3;

use crate::catalogue::parameters::{DURATION, FREQUENCY, TIME, named, parameter, usual};
use crate::signals::add_constant;
use crate::term::{Action, Owner, Parity, Prevalence, Prior, Term};
use crate::unit::Unit;
use crate::waves::sin_cos;

/// Tilt ramp of the base.
pub static BASE_TILT_RAMP: Term = Term {
    id: "base_tilt_ramp",
    also: &[],
    name: "tilt ramp of the base",
    cause: "the slab under the table settles, or the sun heats one side of the pier",
    equation: "(θ_x, θ_y) = p t",
    source: "first term of the series of a slow tilt",
    parameters: &named(["x", "y"], Unit::ARCSEC_PER_HOUR, Prior::Anywhere(0.1, 60.0)),
    settings: &[],
    needs: &[],
    partners: &["cable_torque_tilt", "clock_drift", "base_rotation", "accel_bias_ramp"],
    told_apart_by: "rotate in both directions",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| add_constant(&mut out.tilt, p, moment.end.time)),
};

/// Tilt step of the base.
pub static BASE_TILT_STEP: Term = Term {
    id: "base_tilt_step",
    also: &[],
    name: "tilt step of the base",
    cause: "a person steps on the slab, or a foot of the table slips",
    equation: "θ = p H(t - t0), linear over the duration around t0; z if the spin axis is not vertical",
    source: "step in time",
    parameters: &named(["x", "y", "z"], Unit::ARCSEC, Prior::Anywhere(0.5, 60.0)),
    settings: &[TIME, DURATION],
    needs: &[],
    partners: &["accel_bias_step", "gyro_bias_step"],
    told_apart_by: "it affects gyros and accelerometers at the same time",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, settings, moment, out| {
        let (since, duration) = (moment.end.time - settings[0], settings[1]);
        let part = if since.abs() < 0.5 * duration {
            since / duration + 0.5
        } else {
            f64::from(u8::from(since >= 0.0))
        };
        if part > 0.0 {
            add_constant(&mut out.tilt, p, part);
        }
    }),
};

/// Sway of the base.
pub static BASE_SWAY: Term = Term {
    id: "base_sway",
    also: &[],
    name: "sway of the base",
    cause: "a building, a pier or a support oscillates at its natural frequency",
    equation: "θ = c cos 2πft + s sin 2πft; z if the spin axis is not vertical",
    source: "one mode of a structure",
    parameters: &named(
        ["x_cos", "x_sin", "y_cos", "y_sin", "z_cos", "z_sin"],
        Unit::ARCSEC,
        Prior::Anywhere(0.1, 5.0),
    ),
    settings: &[FREQUENCY],
    needs: &[],
    partners: &["interference_line", "table_wobble"],
    told_apart_by: "rotate at another rate: the frequency stays the same, in gyros and accelerometers at the same time",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, settings, moment, out| {
        let (sin, cos) = sin_cos(std::f64::consts::TAU * settings[0] * moment.end.time);
        for axis in 0..3 {
            out.tilt[axis] += p[2 * axis] * cos + p[2 * axis + 1] * sin;
        }
    }),
};

/// Rotation of the base.
pub static BASE_ROTATION: Term = Term {
    id: "base_rotation",
    also: &[],
    name: "rotation of the base",
    cause: "the base rotates about the vertical at a constant rate",
    equation: "θ = p t u, u the vertical in the axis frame",
    source: "definition of a constant rate",
    // Small IMUs are also rotated on chairs and vehicles.
    parameters: &[parameter(
        "up",
        Unit::DEG_PER_HOUR,
        usual((0.01, 10.0), (0.01, 10.0), (0.01, 36_000.0)),
    )],
    settings: &[],
    needs: &[],
    partners: &["gyro.bias", "base_tilt_ramp", "wrong_latitude"],
    told_apart_by: "rotate a tilted table: the rate is constant relative to the base, a bias in the body frame",
    owner: Owner::Run,
    prevalence: Prevalence::Particular,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        let up = moment.surroundings.specific_force.normalize();
        out.add_tilt(p[0] * moment.end.time, &up);
    }),
};

/// Rolling of the base: the axis is that of a wheel.
pub static BASE_ROLLING: Term = Term {
    id: "base_rolling",
    also: &[],
    name: "rolling of the base",
    cause: "the IMU is on a wheel of radius R that rolls on the ground; R < 0: the axis points to the other side",
    equation: "accel += R (ω' t + 2 ω_ie×ω t), t = z×u, z the spin axis and u the vertical",
    source: "rolling without slip; groves2013",
    parameters: &[parameter("radius", Unit::MILLIMETRE, Prior::Anywhere(20.0, 600.0))],
    settings: &[],
    needs: &[],
    partners: &["accel_lever_arm", "accel_bias_step"],
    told_apart_by: "change the rate quickly: a lever arm turns with the wheel, the acceleration along the ground does not",
    owner: Owner::Run,
    prevalence: Prevalence::Particular,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        let up = moment.surroundings.specific_force.normalize();
        let ahead = Vector3::z().cross(&up);
        let coriolis = moment.surroundings.earth_rate.cross(&ahead) * (2.0 * moment.mean.rate);
        out.add_accel(p[0], &moment.in_body(&(ahead * moment.mean.acceleration + coriolis)));
    }),
};
