//! Errors of the site: latitude, azimuth, gravity.
//!
//! The parameter is the true value minus the assumed one.

use nalgebra::Vector3;
use num_dual::DualNum;
use rins_frames::{EARTH_RATE, InFrame};

use crate::catalogue::parameters::parameter;
use crate::term::{Action, Need, Owner, Parity, Prevalence, Prior, Term};
use crate::unit::Unit;

/// Error of the latitude.
///
/// Gravity is given separately and does not change with it.
pub static WRONG_LATITUDE: Term = Term {
    id: "wrong_latitude",
    also: &[],
    name: "wrong latitude",
    cause: "the table is farther north than assumed",
    equation: "gyro += C_n^b (ω_ie(L + δ) - ω_ie(L))",
    source: "nie2019, eq. (2)",
    parameters: &[parameter("latitude", Unit::ARCMIN, Prior::Anywhere(0.6, 60.0))],
    settings: &[],
    needs: &[Need::Tilt],
    partners: &["axis.attitude", "gyro.scale", "gyro_magnetic", "base_rotation"],
    told_apart_by: "survey the latitude; or three directions of the spin axis",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
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

/// Unknown or wrong azimuth.
///
/// The readings of the gyros are linear in the parameters: for a heading error of any size, they are its sine and its cosine,
/// so that there are two parameters and one solution.
pub static AXIS_AZIMUTH: Term = Term {
    id: "axis.azimuth",
    also: &[],
    name: "azimuth of the spin axis",
    cause: "the heading of the spin axis differs from the assumed one: horizontal Earth rate, true minus assumed",
    equation: "gyro += C_n^b Δω, Δω horizontal",
    source: "nie2019, eq. (2)",
    parameters: &[
        parameter("north", Unit::DEG_PER_HOUR, Prior::Anywhere(0.01, 30.0)),
        parameter("east", Unit::DEG_PER_HOUR, Prior::Anywhere(0.01, 15.0)),
    ],
    settings: &[],
    needs: &[],
    partners: &["axis.attitude", "gyro_g_sensitivity", "gyro.bias", "wrong_latitude"],
    told_apart_by: "survey the heading, and state it as yaw under [attitude]",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| {
        let in_table = moment.surroundings.nav_from_table.inverse();
        for (rate, way) in p.iter().zip([InFrame::new(0.0, 1.0, 0.0), InFrame::new(1.0, 0.0, 0.0)])
        {
            out.add_gyro(*rate, &moment.in_body((in_table * way).components()));
        }
    }),
};

/// Error of gravity.
pub static WRONG_GRAVITY: Term = Term {
    id: "wrong_gravity",
    also: &[],
    name: "wrong gravity",
    cause: "gravity is larger than assumed, by this fraction",
    equation: "accel += δ f",
    source: "nie2019, eq. (2)",
    parameters: &[parameter("gravity", Unit::PPM, Prior::Anywhere(10.0, 3000.0))],
    settings: &[],
    needs: &[],
    partners: &["accel.scale"],
    told_apart_by: "no test with one IMU: it equals a common scale error; survey gravity",
    owner: Owner::Run,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| out.add_accel(p[0], &moment.force)),
};
