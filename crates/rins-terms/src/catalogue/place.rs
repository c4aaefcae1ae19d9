//! A place that is not where it was said to be.
//!
//! The parameter is what is true less what was assumed; the sensors feel the difference.

use nalgebra::Vector3;
use num_dual::DualNum;
use rins_frames::{EARTH_RATE, InFrame};

use crate::catalogue::parameters::parameter;
use crate::term::{Action, Need, Owner, Parity, Prior, Term};
use crate::unit::Unit;

/// A latitude that is wrong.
///
/// Gravity is given apart from it, and does not follow.
pub static WRONG_LATITUDE: Term = Term {
    id: "wrong_latitude",
    also: &[],
    name: "wrong latitude",
    cause: "the table stands further north than was assumed",
    equation: "gyro += C_n^b (ω_ie(L + δ) - ω_ie(L))",
    source: "nie2019, eq. (2)",
    parameters: &[parameter("latitude", Unit::ARCMIN, Prior::Anywhere(0.6, 60.0))],
    settings: &[],
    needs: &[Need::Tilt],
    partners: &["axis.attitude", "gyro.scale", "gyro_magnetic", "base_rotation"],
    told_apart_by: "look it up; or three directions of the axis",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        let around = &moment.surroundings;
        let (sin, cos) = around.station.site.latitude.sin_cos();
        let northward = InFrame::new(0.0, -EARTH_RATE * sin, EARTH_RATE * cos);
        let change = around.nav_from_table.inverse() * northward;
        let in_body = |vector: &Vector3<f64>| moment.in_body(vector);
        let half = (p[0] * 0.5).sin();
        out.add_gyro(p[0].sin(), &in_body(change.components()));
        out.add_gyro(half * half * -2.0, &in_body(&around.earth_rate));
    }),
};

/// An azimuth that is not known, or wrong.
///
/// It is linear in what the gyros feel of it: a heading that is off by any angle, of which they feel a sine and a cosine,
/// has two parameters and one solution.
pub static AXIS_AZIMUTH: Term = Term {
    id: "axis.azimuth",
    also: &[],
    name: "azimuth of the axis",
    cause: "the axis heads otherwise than was assumed: the Earth's horizontal rate there, true less assumed",
    equation: "gyro += C_n^b Δω, Δω horizontal",
    source: "nie2019, eq. (2)",
    parameters: &[
        parameter("north", Unit::DEG_PER_HOUR, Prior::Anywhere(0.01, 30.0)),
        parameter("east", Unit::DEG_PER_HOUR, Prior::Anywhere(0.01, 15.0)),
    ],
    settings: &[],
    needs: &[],
    partners: &["axis.attitude", "gyro_g_sensitivity", "gyro.bias", "wrong_latitude"],
    told_apart_by: "survey the heading, and give it as yaw under [attitude]",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        let in_table = moment.surroundings.nav_from_table.inverse();
        for (rate, way) in p.iter().zip([InFrame::new(0.0, 1.0, 0.0), InFrame::new(1.0, 0.0, 0.0)])
        {
            out.add_gyro(*rate, &moment.in_body((in_table * way).components()));
        }
    }),
};

/// A gravity that is wrong.
pub static WRONG_GRAVITY: Term = Term {
    id: "wrong_gravity",
    also: &[],
    name: "wrong gravity",
    cause: "gravity is stronger than was assumed, by this share",
    equation: "accel += δ f",
    source: "nie2019, eq. (2)",
    parameters: &[parameter("gravity", Unit::PPM, Prior::Anywhere(10.0, 3000.0))],
    settings: &[],
    needs: &[],
    partners: &["accel.scale"],
    told_apart_by: "never from one IMU: it is a common scale error; survey gravity",
    owner: Owner::Run,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| out.add_accel(p[0], &moment.force)),
};
