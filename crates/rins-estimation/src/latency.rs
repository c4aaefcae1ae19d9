//! Readings at the times of the motion that they are of.

use std::sync::Arc;

use rins_motion::{Recording, whole};
use rins_terms::{Model, Term, TermInstance, catalogue};

use crate::run::{Reference, Run};

/// Readings are moved if the latency is at least this number of samples: within a sample the motion is known well.
const FEWEST: usize = 2;

/// A latency above a whole number of samples by up to this part less than the next one is moved by that next one: common
/// latencies, of whole and of half samples, are then far from where the number changes.
const NEXT: f64 = 0.25;

/// Sampling is uniform if no interval differs by more than this part from the mean.
const UNIFORM: f64 = 1e-3;

/// The run with its table angle moved by the whole samples of its latency relative to the gyros according to the model, and the model
/// with the rest of the latencies; `None` if they are less than two samples or sampling is not uniform.
///
/// The motion that a late reading shows is then that of its epoch, and so are its errors: angle and gyros are compared where they
/// belong to each other. The time is that of the readings of the gyros. Those of the accelerometers stay with them, whatever
/// their latency, so that every hypothesis has the same noise in the same epochs: the track tells the motion that they show. Latencies
/// that are equivalent, such as that of the angle and those of all sensors with the other sign, have the same likelihood.
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
    let [gyro, angle] = [&catalogue::GYRO_LAG, &catalogue::ENCODER_LATENCY].map(&mut samples);
    let mut intervals = recording.increments.iter().map(|sample| sample.interval);
    if [gyro, angle] == [0; 2] || intervals.any(|one| (one - interval).abs() > UNIFORM * interval) {
        return None;
    }
    // With the time of the gyros that of the accelerometers is moved.
    if gyro != 0 {
        let moved = gyro as f64 * interval;
        match rest.terms.iter_mut().find(|chosen| chosen.term.is(&catalogue::ACCEL_LATENCY)) {
            Some(own) => own.values[0] -= moved,
            None => {
                rest.terms
                    .push(TermInstance::new(&catalogue::ACCEL_LATENCY).with_values(&[-moved]));
            }
        }
    }
    let moved = Arc::new(moved(recording, angle - gyro));
    Some((Run { recording: moved, ..run.clone() }, rest))
}

/// The recording with the table angle of later samples, by this number. Beyond a gap it is the nearest and the rotation of the gyro.
fn moved(recording: &Recording, by: isize) -> Recording {
    let mut moved = recording.clone();
    let (Some(angles), Some(read)) = (&mut moved.table_angle, &recording.table_angle) else {
        return moved;
    };
    for span in recording.between_gaps() {
        let last = span.end - 1;
        for sample in span.clone() {
            // Saturates at zero.
            let source = sample.saturating_add_signed(by).clamp(span.start, last);
            let beyond = sample as f64 + by as f64 - source as f64;
            let turn = recording.increments[source].angle.components().z;
            angles[sample] = read[source] + beyond * turn;
        }
    }
    moved
}
