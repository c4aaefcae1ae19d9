//! Readings at the times of the motion that they are of.

use std::sync::Arc;

use rins_motion::{Recording, whole};
use rins_terms::{Model, Term, catalogue};

use crate::run::{Reference, Run};

/// Readings are moved if the latency is at least this number of samples: within a sample the motion is known well.
const FEWEST: f64 = 2.0;

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
        let mut moved = 0.0;
        for chosen in rest.terms.iter_mut().filter(|chosen| chosen.term.is(term)) {
            let size = (chosen.values[0].abs() / interval + NEXT).floor();
            if size >= FEWEST {
                let whole = size.copysign(chosen.values[0]);
                chosen.values[0] -= whole * interval;
                moved += whole;
            }
        }
        moved
    };
    let latencies = [&catalogue::GYRO_LAG, &catalogue::ACCEL_LATENCY, &catalogue::ENCODER_LATENCY]
        .map(&mut samples);
    let longest = recording.len() as f64;
    if latencies.iter().all(|moved| *moved == 0.0)
        || latencies.iter().any(|moved| moved.abs() >= longest)
    {
        return None;
    }
    let mut intervals = recording.increments.iter().map(|sample| sample.interval);
    if intervals.any(|one| (one - interval).abs() > UNIFORM * interval) {
        return None;
    }
    // Gyros stay: a shift of all readings together is one of the time.
    let [gyro, accel, angle] = latencies.map(signed);
    let moved = Arc::new(moved(recording, accel - gyro, angle - gyro));
    let moved = Run { recording: moved, ..run.clone() };
    Some((moved, rest))
}

/// A whole number of samples, which may be negative.
fn signed(samples: f64) -> isize {
    if samples == 0.0 {
        return 0;
    }
    let size = isize::try_from(whole(samples.abs())).unwrap_or(isize::MAX);
    if samples < 0.0 { -size } else { size }
}

/// The recording with the accelerometers and the angle of later samples, by these numbers. Beyond a gap the nearest sample counts, and for
/// the angle the rotation of the gyro.
fn moved(recording: &Recording, accel: isize, angle: isize) -> Recording {
    let mut moved = recording.clone();
    let gap = |sample: &usize| recording.gap_before(*sample);
    let starts = std::iter::once(0).chain((1..recording.len()).filter(gap));
    let bounds: Vec<usize> = starts.chain([recording.len()]).collect();
    for span in bounds.windows(2) {
        let last = span[1] - 1;
        let nearest = |sample: usize, by: isize| {
            // Saturates at zero.
            sample.saturating_add_signed(by).clamp(span[0], last)
        };
        for sample in span[0]..=last {
            let source = nearest(sample, accel);
            moved.increments[sample].velocity = recording.increments[source].velocity;
        }
        let Some(angles) = &mut moved.table_angle else { continue };
        let read = recording.table_angle.as_deref().unwrap_or_default();
        for (sample, moved) in angles.iter_mut().enumerate().take(last + 1).skip(span[0]) {
            let source = nearest(sample, angle);
            let beyond = sample as f64 + angle as f64 - source as f64;
            let turn = recording.increments[source].angle.components().z;
            *moved = read[source] + beyond * turn;
        }
    }
    moved
}
