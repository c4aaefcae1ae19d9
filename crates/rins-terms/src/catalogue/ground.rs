//! A base that does not stand still.

use crate::catalogue::parameters::{DURATION, FREQUENCY, TIME, named, parameter, usual};
use crate::signals::add_constant;
use crate::term::{Action, Owner, Parity, Prior, Term};
use crate::unit::Unit;
use crate::waves::sin_cos;

/// A base that settles.
pub static BASE_TILT_RAMP: Term = Term {
    id: "base_tilt_ramp",
    also: &[],
    name: "base that settles",
    cause: "the slab under the table settles, or the sun warms one side of the pier",
    equation: "(θ_x, θ_y) = p t",
    source: "the first term of a slow tilt's series",
    parameters: &named(["x", "y"], Unit::ARCSEC_PER_HOUR, Prior::Anywhere(0.1, 60.0)),
    settings: &[],
    needs: &[],
    partners: &["cable_torque_tilt", "clock_drift", "base_rotation", "accel_bias_ramp"],
    told_apart_by: "turn the table both ways",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| add_constant(&mut out.tilt, p, moment.end.time)),
};

/// A base that is pushed.
pub static BASE_TILT_STEP: Term = Term {
    id: "base_tilt_step",
    also: &[],
    name: "base that gives way",
    cause: "somebody steps on the slab, or a foot of the table slips",
    equation: "θ = p H(t - t0), evenly over some time about t0, about the axis too if that is not upright",
    source: "a step in time",
    parameters: &named(["x", "y", "z"], Unit::ARCSEC, Prior::Anywhere(0.5, 60.0)),
    settings: &[TIME, DURATION],
    needs: &[],
    partners: &["accel_bias_step", "gyro_bias_step"],
    told_apart_by: "it shows in gyros and accelerometers at once",
    owner: Owner::Run,
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

/// A base that sways.
pub static BASE_SWAY: Term = Term {
    id: "base_sway",
    also: &[],
    name: "sway of the base",
    cause: "a building, a pier or a chair rocks at a frequency of its own",
    equation: "θ = c cos 2πft + s sin 2πft, about the axis too if that is not upright",
    source: "one mode of a structure",
    parameters: &named(
        ["x_cos", "x_sin", "y_cos", "y_sin", "z_cos", "z_sin"],
        Unit::ARCSEC,
        Prior::Anywhere(0.1, 5.0),
    ),
    settings: &[FREQUENCY],
    needs: &[],
    partners: &["interference_line", "table_wobble"],
    told_apart_by: "turn at another rate: it keeps its frequency, and shows in gyros and accelerometers at once",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, settings, moment, out| {
        let (sin, cos) = sin_cos(std::f64::consts::TAU * settings[0] * moment.end.time);
        for axis in 0..3 {
            out.tilt[axis] += p[2 * axis] * cos + p[2 * axis + 1] * sin;
        }
    }),
};

/// A base that turns.
pub static BASE_ROTATION: Term = Term {
    id: "base_rotation",
    also: &[],
    name: "base that turns",
    cause: "what the table stands on turns about the vertical at a constant rate",
    equation: "θ = p t u, u the vertical in the axis frame",
    source: "the definition of a constant rate",
    // Small units are turned on chairs and on vehicles, too.
    parameters: &[parameter(
        "up",
        Unit::DEG_PER_HOUR,
        usual((0.01, 10.0), (0.01, 10.0), (0.01, 36_000.0)),
    )],
    settings: &[],
    needs: &[],
    partners: &["gyro.bias", "base_tilt_ramp", "wrong_latitude"],
    told_apart_by: "turn a tilted table: the rate stays with the base, a bias with the body",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        let up = moment.surroundings.specific_force.normalize();
        out.add_tilt(p[0] * moment.end.time, &up);
    }),
};
