//! The trajectory of the table, as known before the estimation.

use nalgebra::Vector2;
use rayon::prelude::*;
use rins_terms::{Acting, KinematicStates, Model, Surroundings, Track};

use crate::run::{Reference, Run};
use crate::smoothing::Differences;

/// The largest error of the angle whose square is negligible \[rad\].
const SMALL_ERROR: f64 = 1e-4;

/// Larger errors are subtracted until they change by less than this \[rad\]: the error due to a latency depends on the table
/// rate, which depends on the corrected angle, ...
const SAME_ERROR: f64 = 1e-7;

/// ... but at most this number of times.
const MOST_PASSES: usize = 5;

/// The number of samples that a thread processes in one task.
const SAMPLES_AT_A_TIME: usize = 4096;

/// The trajectory of the table at which a run is linearized.
///
/// The reference determines its low frequencies, the z gyro its high frequencies above the one at which they are equally noisy
/// ([`Differences::smoothed`]); those of a quantized reference begin below the rate of the epochs, which have `epoch` samples.
pub(crate) fn track(run: &Run, surroundings: Surroundings, model: &Model, epoch: usize) -> Track {
    let mut known = vec![0.0; run.recording.len()];
    let mut track = through(run, surroundings, &known, epoch);
    let Reference::Encoder { .. } = run.rig.reference else { return track };
    for pass in 0..MOST_PASSES {
        let errors = errors(&track, model);
        let change = known.iter().zip(&errors).map(|(known, error)| (error - known).abs());
        let small = if pass == 0 { SMALL_ERROR } else { SAME_ERROR };
        if change.fold(0.0, f64::max) < small {
            break;
        }
        track = through(run, surroundings, &errors, epoch);
        known = errors;
    }
    track
}

/// The error of the table angle according to the model, at the end of each sample \[rad\].
fn errors(track: &Track, model: &Model) -> Vec<f64> {
    let present = Acting::present(model, track);
    let starts = (0..track.len()).step_by(SAMPLES_AT_A_TIME);
    let of = |mut moments: KinematicStates<'_>| -> Vec<f64> {
        let mut error = || Some(Acting::together(&present, moments.advance()?).angle.re);
        (0..SAMPLES_AT_A_TIME).map_while(|_| error()).collect()
    };
    let errors: Vec<Vec<f64>> = track.moments_from(starts).into_par_iter().map(of).collect();
    errors.concat()
}

/// The trajectory if the table angle has these errors.
fn through(run: &Run, surroundings: Surroundings, errors: &[f64], epoch: usize) -> Track {
    let recording = &run.recording;
    let gyro = integrated_gyro(run, &surroundings);
    let correction = match run.rig.reference {
        Reference::Rest => gyro.iter().map(|angle| -angle).collect(),
        Reference::Gravity => correction_by_gravity(run, &surroundings, &gyro),
        Reference::Encoder { .. } | Reference::Command { .. } => {
            let read = readings(run).unwrap_or_default();
            let read: Vec<f64> =
                read.iter().zip(errors).map(|(read, error)| read - error).collect();
            let differences = Differences {
                times: &recording.times,
                readings: &read,
                values: read.iter().zip(&gyro[1..]).map(|(read, gyro)| read - gyro).collect(),
                linked: (0..recording.len())
                    .map(|sample| sample > 0 && !recording.gap_before(sample))
                    .collect(),
            };
            // Rounding errors are not white: a smoothed angle must not follow the grid.
            differences.smoothed(run.angle_steps.map(|_| epoch as f64))
        }
    };
    let angles = gyro.iter().zip(&correction).map(|(gyro, correction)| gyro + correction).collect();
    Track::new(
        surroundings,
        recording.times.clone(),
        recording.increments.iter().map(|sample| sample.interval).collect(),
        angles,
        recording.temperature.clone(),
    )
}

/// The table angle at the end of each sample according to the reference \[rad\], if the reference is an angle.
pub(crate) fn readings(run: &Run) -> Option<Vec<f64>> {
    let recording = &run.recording;
    match run.rig.reference {
        Reference::Encoder { .. } => recording.table_angle.clone(),
        Reference::Command { .. } => {
            let mut angle = 0.0;
            let mut before = recording.times[0] - recording.increments[0].interval;
            let rates = recording.table_rate.as_ref()?;
            let step = |(&rate, &time): (&f64, &f64)| {
                angle += rate * (time - before);
                before = time;
                angle
            };
            Some(rates.iter().zip(&recording.times).map(step).collect())
        }
        Reference::Rest => Some(vec![0.0; recording.len()]),
        Reference::Gravity => None,
    }
}

/// The table angle from the z gyro, which is zero before the first sample \[rad\].
fn integrated_gyro(run: &Run, surroundings: &Surroundings) -> Vec<f64> {
    let mut angle = 0.0;
    let steps = run.recording.increments.iter().map(|sample| {
        angle += sample.angle.components().z - surroundings.earth_rate.z * sample.interval;
        angle
    });
    std::iter::once(0.0).chain(steps).collect()
}

/// Linear interpolation of `knots` at 0, 1, ..., with extrapolation beyond the outer knots.
fn interpolated(knots: &[(f64, f64)], length: usize) -> Vec<f64> {
    let mut segment = 0;
    (0..length)
        .map(|place| {
            let place = place as f64;
            if knots.len() < 2 {
                return knots.first().map_or(0.0, |knot| knot.1);
            }
            while segment + 2 < knots.len() && place > knots[segment + 1].0 {
                segment += 1;
            }
            let ((x0, y0), (x1, y1)) = (knots[segment], knots[segment + 1]);
            y0 + (y1 - y0) * (place - x0) / (x1 - x0)
        })
        .collect()
}

/// The correction of the gyro angle by the direction of gravity in the plane of rotation: one value for each revolution.
///
/// A constant in the body, such as a bias or the centripetal acceleration of a lever arm, cancels over a whole revolution.
fn correction_by_gravity(run: &Run, around: &Surroundings, gyro: &[f64]) -> Vec<f64> {
    let expected = around.specific_force.y.atan2(around.specific_force.x);
    let increments = &run.recording.increments;
    let mut knots = Vec::new();
    let mut first = 0;
    let mut sum = Vector2::<f64>::zeros();
    let mut before: Option<f64> = None;
    for (index, sample) in increments.iter().enumerate() {
        let velocity = sample.velocity.components();
        let (sin, cos) = (0.5 * (gyro[index] + gyro[index + 1])).sin_cos();
        sum.x += velocity.x * cos - velocity.y * sin;
        sum.y += velocity.x * sin + velocity.y * cos;
        let turned = (gyro[index + 1] - gyro[first]).abs();
        if turned >= std::f64::consts::TAU || index + 1 == increments.len() {
            let whole = turned >= std::f64::consts::PI;
            if whole || knots.is_empty() {
                // The phase is the angle by which the gyro's axes must be rotated further to agree with gravity.
                let mut phase = expected - sum.y.atan2(sum.x);
                if let Some(before) = before {
                    let turns = ((phase - before) / std::f64::consts::TAU).round();
                    phase -= turns * std::f64::consts::TAU;
                }
                before = Some(phase);
                knots.push((0.5 * (first + index + 1) as f64, phase));
            }
            first = index + 1;
            sum = Vector2::zeros();
        }
    }
    interpolated(&knots, gyro.len())
}
