//! A navigator on a flat Earth that does not rotate, without linearization.

use nalgebra::{Matrix3, Vector3};
use rins_frames::{Body, Dcm, InFrame, Nav, cross_matrix};

use super::errors::{ConstantTurn, NavErrors, SpinAxisErrors, attitude_error};

/// The errors of attitude and velocity after `time` \[s\], exact for errors of any size.
///
/// The gyros measure the constant rate `ω (z + m)`, with the spin axis errors `m`, so that
/// `C~ = exp(-φ(0)×) C_s^n exp(ω t (z + m)×)`; the accelerometers measure `Rz(ωt)ᵀ f^s`. The velocity is the integral of products
/// of the two rotations' sines and cosines, here in closed form. The vertical velocity is held. Position is not calculated.
pub fn flat_navigation(
    turn: &ConstantTurn,
    errors: &SpinAxisErrors,
    initial: &NavErrors,
    time: f64,
) -> NavErrors {
    let start = Dcm::<Nav, Nav>::from_rotation_vector(&-initial.attitude.components())
        * turn.nav_from_body(0.0);
    let reported = Vector3::z() + errors.vector();
    let computed =
        start * Dcm::<Body, Body>::from_rotation_vector(&(reported * (turn.rate * time)));

    let reaction = -turn.station.gravity_vector();
    let f_b: InFrame<Body> = turn.nav_from_body(0.0).inverse() * reaction;
    let gain_b = turns_integrated(&reported, turn.rate, time) * f_b.components();
    let gain = start * InFrame::from_components(gain_b) - reaction * time;
    let level = InFrame::new(gain.components().x, gain.components().y, 0.0);
    NavErrors {
        attitude: attitude_error(computed, turn.nav_from_body(time)),
        velocity: initial.velocity + level,
        ..NavErrors::none()
    }
}

/// `∫ exp(ω t r×) Rz(-ω t) dt` from 0 to `time`, with `r` the `reported` axis.
fn turns_integrated(reported: &Vector3<f64>, rate: f64, time: f64) -> Matrix3<f64> {
    let (fast, slow) = (rate * reported.norm(), rate);
    let axis = reported.normalize();
    let (along, cross) = (axis * axis.transpose(), cross_matrix(&axis));
    let across = Matrix3::identity() - along;
    let z = Vector3::z();
    let (z_along, z_cross) = (z * z.transpose(), cross_matrix(&z));
    let z_across = Matrix3::identity() - z_along;

    let (cos_sum, cos_apart) =
        (cosine_integral(fast + slow, time), cosine_integral(fast - slow, time));
    let (sin_sum, sin_apart) = (sine_integral(fast + slow, time), sine_integral(fast - slow, time));
    let (cos_fast, sin_fast) = (cosine_integral(fast, time), sine_integral(fast, time));
    let (cos_slow, sin_slow) = (cosine_integral(slow, time), sine_integral(slow, time));
    let with_axis = z_along * time + z_across * cos_slow - z_cross * sin_slow;
    let with_cos = z_along * cos_fast + z_across * (0.5 * (cos_apart + cos_sum))
        - z_cross * (0.5 * (sin_sum - sin_apart));
    let with_sin = z_along * sin_fast + z_across * (0.5 * (sin_sum + sin_apart))
        - z_cross * (0.5 * (cos_apart - cos_sum));
    along * with_axis + across * with_cos + cross * with_sin
}

/// `∫ cos at dt = sin aT / a`.
fn cosine_integral(rate: f64, time: f64) -> f64 {
    let angle = rate * time;
    if angle == 0.0 { time } else { time * angle.sin() / angle }
}

/// `∫ sin at dt = 2 sin²(aT / 2) / a`.
fn sine_integral(rate: f64, time: f64) -> f64 {
    let half = 0.5 * rate * time;
    if half == 0.0 { 0.0 } else { time * half.sin().powi(2) / half }
}
