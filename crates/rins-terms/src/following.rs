//! What follows a table's angle slowly, as the warmth of a sensor does that turns beside a source of heat.

use nalgebra::Complex;

use crate::kinematic_state::KinematicState;
use crate::track::Track;

/// How `1/(1 + τ d/dt)` follows `exp(iζ)` at a constant rate \[rad/s\], in units of it.
pub(crate) fn settled(rate: f64, time_constant: f64) -> Complex<f64> {
    Complex::new(1.0, rate * time_constant).inv()
}

/// The same along a track, in the middle of each of its samples: settled at the start, and after every change of rate
/// on the way to what settles next.
pub(crate) fn following(track: &Track, time_constant: f64) -> Vec<Complex<f64>> {
    let mut last = None;
    let follow = |moment: KinematicState| {
        let rate = moment.mean.rate;
        let settled = settled(rate, time_constant);
        // The angle goes on meanwhile: what does not follow it turns back in units of it.
        let after = |follows: Complex<f64>, elapsed: f64| {
            let decay = (-elapsed / time_constant).exp();
            settled + (follows - settled) * Complex::from_polar(decay, -rate * elapsed)
        };
        let (before, time) = last.unwrap_or((settled, 0.0));
        let middle = after(before, moment.mean.time - time);
        last = Some((after(middle, 0.5 * moment.interval), moment.end.time));
        middle
    };
    track.moments().map(follow).collect()
}
