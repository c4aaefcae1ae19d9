//! What follows a table's angle or its temperature slowly, as the warmth of a sensor does.

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

/// By how much `1/(1 + τ d/dt)` of the temperature is above it, in the middle of each of a track's samples \[K\]: settled at the start,
/// and exact for a temperature that changes evenly from the end of one sample to that of the next. Zero where it is not known.
pub(crate) fn behind(track: &Track, time_constant: f64) -> Vec<f64> {
    let mut last: Option<(f64, f64)> = None;
    let follow = |sample: usize| {
        let Some(temperature) = track.temperature(sample) else { return 0.0 };
        let (before, follows) = last.unwrap_or((temperature, 0.0));
        let elapsed = track.over(sample).1;
        // How far behind an even change it stays.
        let settled = (before - temperature) * (time_constant / elapsed);
        let after = |elapsed: f64| settled + (follows - settled) * (-elapsed / time_constant).exp();
        last = Some((temperature, after(elapsed)));
        after(elapsed - 0.5 * track.intervals[sample])
    };
    (0..track.len()).map(follow).collect()
}
