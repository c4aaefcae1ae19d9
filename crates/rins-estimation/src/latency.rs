//! Readings at the times of the motion that they are of.

use std::sync::Arc;

use rins_motion::{Recording, whole};
use rins_terms::{Model, Term, catalogue};

use crate::run::{Reference, Run};

/// Readings are moved if the latency is at least this number of samples: within a sample the motion is known well.
const FEWEST: usize = 2;

/// A latency above a whole number of samples by up to this part less than the next one is moved by that next one: common
/// latencies, of whole and of half samples, are then far from where the number changes.
const NEXT: f64 = 0.25;

/// Sampling is uniform if no interval differs by more than this part from the mean.
const UNIFORM: f64 = 1e-3;

/// The run with its readings moved by the whole samples of their latencies according to the model, and the model with the rest of the
/// latencies; `None` if they are less than two samples or sampling is not uniform.
///
/// The motion that a late reading shows is then that of its epoch, and so are its errors: they are processed with those of the
/// other sensors that belong to it. Latencies that are equivalent, such as that of the angle and those of all sensors with the
/// other sign, have the same likelihood. The time is that of the readings of the gyros.
pub(crate) fn without_latency(run: &Run, model: &Model) -> Option<(Run, Model)> {
    let Reference::Encoder { .. } = run.rig.reference else { return None };
    let recording = &run.recording;
    let interval = recording.mean_interval();
    let mut rest = model.clone();
    let mut samples = |term: &'static Term| {
        let mut moved = 0;
        for chosen in rest.terms.iter_mut().filter(|chosen| chosen.term.is(term)) {
            let latency = chosen.values[0];
            let size = whole((latency.abs() / interval + NEXT).floor());
            if (FEWEST..recording.len()).contains(&size) {
                chosen.values[0] -= (size as f64).copysign(latency) * interval;
                moved += if latency < 0.0 { -size.cast_signed() } else { size.cast_signed() };
            }
        }
        moved
    };
    let latencies = [&catalogue::GYRO_LAG, &catalogue::ACCEL_LATENCY, &catalogue::ENCODER_LATENCY];
    let [gyro, accel, angle] = latencies.map(&mut samples);
    let mut intervals = recording.increments.iter().map(|sample| sample.interval);
    if [gyro, accel, angle] == [0; 3]
        || intervals.any(|one| (one - interval).abs() > UNIFORM * interval)
    {
        return None;
    }
    // Gyros stay: a shift of all readings together is one of the time.
    let moved = Arc::new(moved(recording, accel - gyro, angle - gyro));
    Some((Run { recording: moved, ..run.clone() }, rest))
}

/// The recording with the accelerometers and the angle of later samples, by these numbers. Beyond a gap the nearest sample counts, and for
/// the angle the rotation of the gyro.
fn moved(recording: &Recording, accel: isize, angle: isize) -> Recording {
    let mut moved = recording.clone();
    for span in recording.between_gaps() {
        let last = span.end - 1;
        let nearest = |sample: usize, by: isize| {
            // Saturates at zero.
            sample.saturating_add_signed(by).clamp(span.start, last)
        };
        for sample in span.clone() {
            let source = nearest(sample, accel);
            moved.increments[sample].velocity = recording.increments[source].velocity;
        }
        let Some(angles) = &mut moved.table_angle else { continue };
        let read = recording.table_angle.as_deref().unwrap_or_default();
        for (sample, moved) in angles.iter_mut().enumerate().take(span.end).skip(span.start) {
            let source = nearest(sample, angle);
            let beyond = sample as f64 + angle as f64 - source as f64;
            let turn = recording.increments[source].angle.components().z;
            *moved = read[source] + beyond * turn;
        }
    }
    moved
}
