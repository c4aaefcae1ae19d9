//! What was true, from what was read: a model's terms undone.

use rins_frames::{InFrame, Increments};
use rins_imu::ImuCompensationError;
use rins_motion::Recording;

use crate::acting::Acting;
use crate::kinematic_state::KinematicState;
use crate::model::Model;
use crate::signals::{Signals, values};
use crate::surroundings::Surroundings;
use crate::track::Track;

/// The most often that readings are compensated; each time leaves of an error what the terms make of it.
const MOST_ROUNDS: usize = 60;

/// What may change in a last round, relative to the largest reading.
const SETTLED: f64 = 1e-13;

/// Why a model's terms cannot be undone.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NotUndone {
    /// The biases, scale errors and misalignments leave too little of what was true.
    #[error(transparent)]
    Triads(#[from] ImuCompensationError),
    /// The terms are so large that undoing them does not come to an end.
    #[error(
        "the terms cannot be compensated: after {MOST_ROUNDS} iterations the readings still change by \
         {change:.1e} of the largest"
    )]
    Endless {
        /// By how much readings changed in the last round, relative to the largest.
        change: f64,
    },
}

/// The recording that sensors and an encoder without the errors of `model` would have made.
///
/// It is `true = measured - signals(true)`, iterated: terms act on the rates and forces that are found, so that
/// it holds for any motion. What moves the table itself, tilts or ripples, is true and stays. How the table turns is
/// taken from the z gyro less the Earth's rate; the encoder, if there is one, says where it
/// stands, but is not differenced. Terms of noise and of logging cannot be undone, and are passed over.
///
/// # Errors
/// [`NotUndone`] if the terms are too large, or a triad's readings hold nothing of what was true.
///
/// # Examples
/// A gyro that reads 1e-3 of the rate too much:
/// ```
/// use rins_frames::{Dcm, InFrame, Increments, Site};
/// use rins_motion::{Recording, Station};
/// use rins_terms::{TermInstance, Model, Surroundings, catalogue, compensated};
///
/// let site = Site { latitude: 0.6, longitude: 1.9, height: 400.0 };
/// let around = Surroundings::new(Station::with_normal_gravity(site), Dcm::identity());
/// let sample = Increments {
///     angle: InFrame::new(0.0, 0.0, 1.001e-2),
///     velocity: InFrame::new(0.0, 0.0, 0.5),
///     interval: 0.05,
/// };
/// let read = Recording { times: vec![0.05], increments: vec![sample], ..Recording::default() };
/// let scale = TermInstance::new(&catalogue::GYRO_SCALE).with_values(&[0.0, 0.0, 1e-3]);
/// let undone = compensated(&Model { terms: vec![scale] }, around, &read)?;
/// assert!((undone.increments[0].angle.components().z - 1e-2).abs() < 1e-16);
/// # Ok::<(), rins_terms::NotUndone>(())
/// ```
pub fn compensated(
    model: &Model,
    surroundings: Surroundings,
    recording: &Recording,
) -> Result<Recording, NotUndone> {
    model.split().0.compensation()?;
    let mut found = recording.clone();
    let Some(first) = recording.increments.first() else { return Ok(found) };
    let size = |vectors: &dyn Fn(&Increments) -> f64| {
        recording.increments.iter().map(vectors).fold(f64::MIN_POSITIVE, f64::max)
    };
    let largest_angle = size(&|k| k.angle.norm());
    let largest_velocity = size(&|k| k.velocity.norm());
    let start = recording.times[0] - first.interval;
    let mut change = f64::INFINITY;
    for _ in 0..MOST_ROUNDS {
        let track = turning(&found, surroundings, start);
        let terms = Acting::present(model, &track);
        change = 0.0;
        let mut moments = track.moments();
        for sample in 0..track.len() {
            let Some(moment) = moments.advance() else { break };
            let moment = standing(moment, &track, &found, sample);
            let signals = errors(&terms, &moment);
            let (read, interval) = (&recording.increments[sample], moment.interval);
            let next = Increments {
                angle: read.angle - InFrame::from_components(values(&signals.gyro) * interval),
                velocity: read.velocity
                    - InFrame::from_components(values(&signals.accel) * interval),
                interval,
            };
            let last = std::mem::replace(&mut found.increments[sample], next);
            change = largest(change, (next.angle - last.angle).norm() / largest_angle);
            change = largest(change, (next.velocity - last.velocity).norm() / largest_velocity);
            if let (Some(true_angle), Some(read)) = (&mut found.table_angle, &recording.table_angle)
            {
                let next = read[sample] - signals.angle.re;
                let off = (next - true_angle[sample]).abs();
                change = largest(change, off / next.abs().max(1.0));
                true_angle[sample] = next;
            }
        }
        // Delays compare angles of the whole track, which are rounded.
        let farthest = track.angles().iter().fold(0.0, |most: f64, angle| most.max(angle.abs()));
        if change <= SETTLED + 4.0 * f64::EPSILON * farthest / largest_angle {
            return Ok(found);
        }
    }
    Err(NotUndone::Endless { change })
}

/// What the terms add to readings. A term that moves the table is a true motion, and is left in them.
fn errors(terms: &[Acting<'_>], moment: &KinematicState) -> Signals {
    let mut sum = Signals::default();
    for acting in terms {
        let signals = acting.signals(moment);
        if signals.tilt == Signals::default().tilt {
            sum.add(&signals);
        }
    }
    sum
}

/// The larger number; what is not a number is larger than any.
fn largest(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// The track of a table that turns as the z gyro says, and begins where the encoder's first reading puts it.
fn turning(recording: &Recording, surroundings: Surroundings, start: f64) -> Track {
    let times = &recording.times;
    let turn = |sample: usize, increments: &Increments| {
        // Where samples are missing the table is taken to have gone on as it did.
        let before = if sample == 0 { start } else { times[sample - 1] };
        let rate = increments.angle.components().z / increments.interval;
        (rate - surroundings.earth_rate.z) * (times[sample] - before)
    };
    let mut angles = Vec::with_capacity(times.len() + 1);
    let first = recording.increments.first().map_or(0.0, |increments| turn(0, increments));
    angles.push(recording.table_angle.as_ref().map_or(0.0, |angle| angle[0] - first));
    for (sample, increments) in recording.increments.iter().enumerate() {
        angles.push(angles[sample] + turn(sample, increments));
    }
    let intervals = recording.increments.iter().map(|increments| increments.interval).collect();
    Track::new(surroundings, times.clone(), intervals, angles, recording.temperature.clone())
}

/// The moment of a table that turns as `track` does and stands where the encoder, if there is one, says; what is felt is
/// what was found.
fn standing<'a>(
    moment: &KinematicState<'a>,
    track: &Track,
    recording: &Recording,
    sample: usize,
) -> KinematicState<'a> {
    let mut moment = moment.feeling(&recording.increments[sample]);
    if let Some(angle) = &recording.table_angle {
        let off = angle[sample] - track.angles()[sample + 1];
        moment.mean.angle += off;
        moment.end.angle += off;
    }
    moment
}

#[cfg(test)]
mod tests;
