//! The trajectory of the table, as known before the estimation.

use nalgebra::{Vector2, Vector3};
use rayon::prelude::*;
use rins_terms::{Acting, KinematicStates, Model, Signals, Surroundings, Track, values};

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
    match run.rig.reference {
        Reference::Encoder { .. } => {
            let angle = |signals: &Signals| signals.angle.re;
            let change = |known: &f64, error: &f64| (error - known).abs();
            let through = |errors: &[f64]| through(run, surroundings, (errors, &[]), epoch);
            corrected((model, angle), through, change)
        }
        Reference::Gravity => {
            let force = |signals: &Signals| values(&signals.accel);
            // How far the direction of gravity is off.
            let gravity = surroundings.specific_force.norm();
            let change =
                |known: &Vector3<f64>, error: &Vector3<f64>| (error - known).norm() / gravity;
            let through = |errors: &[_]| through(run, surroundings, (&[], errors), epoch);
            corrected((model, force), through, change)
        }
        Reference::Command { .. } | Reference::Rest => {
            through(run, surroundings, (&[], &[]), epoch)
        }
    }
}

/// The trajectory through readings without their errors, which depend on the trajectory. `through` gets the errors, or none of them at
/// first; `change` of two errors is an angle \[rad\].
fn corrected<E>(
    (model, error): (&Model, impl Fn(&Signals) -> E + Sync),
    through: impl Fn(&[E]) -> Track,
    change: impl Fn(&E, &E) -> f64,
) -> Track
where
    E: Clone + Default + Send,
{
    let mut track = through(&[]);
    let mut known = vec![E::default(); track.len()];
    for pass in 0..MOST_PASSES {
        let errors = errors(&track, model, &error);
        let changes = known.iter().zip(&errors).map(|(known, error)| change(known, error));
        let small = if pass == 0 { SMALL_ERROR } else { SAME_ERROR };
        if changes.fold(0.0, f64::max) < small {
            break;
        }
        track = through(&errors);
        known = errors;
    }
    track
}

/// The errors of the readings of each sample according to the model.
fn errors<E: Clone + Send>(
    track: &Track,
    model: &Model,
    error: &(impl Fn(&Signals) -> E + Sync),
) -> Vec<E> {
    let present = Acting::present(model, track);
    let starts = (0..track.len()).step_by(SAMPLES_AT_A_TIME);
    let of = |mut moments: KinematicStates<'_>| -> Vec<E> {
        let mut error = || Some(error(&Acting::together(&present, moments.advance()?)));
        (0..SAMPLES_AT_A_TIME).map_while(|_| error()).collect()
    };
    let errors: Vec<Vec<E>> = track.moments_from(starts).into_par_iter().map(of).collect();
    errors.concat()
}

/// The trajectory if the table angle and the specific force have these errors; a sample without an entry has none.
fn through(
    run: &Run,
    surroundings: Surroundings,
    (errors, of_force): (&[f64], &[Vector3<f64>]),
    epoch: usize,
) -> Track {
    let recording = &run.recording;
    let gyro = integrated_gyro(run, &surroundings);
    let correction = match run.rig.reference {
        Reference::Rest => gyro.iter().map(|angle| -angle).collect(),
        Reference::Gravity => correction_by_gravity((run, of_force), &surroundings, &gyro),
        Reference::Encoder { .. } | Reference::Command { .. } => {
            let read = readings(run).unwrap_or_default();
            let errors = errors.iter().copied().chain(std::iter::repeat(0.0));
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
/// A constant in the body, such as a bias or the centripetal acceleration of a lever arm, cancels over a whole revolution. The
/// specific force has these errors.
fn correction_by_gravity(
    (run, errors): (&Run, &[Vector3<f64>]),
    around: &Surroundings,
    gyro: &[f64],
) -> Vec<f64> {
    let expected = around.specific_force.y.atan2(around.specific_force.x);
    let increments = &run.recording.increments;
    let mut knots = Vec::new();
    let mut first = 0;
    let mut sum = Vector2::<f64>::zeros();
    let mut before: Option<f64> = None;
    for (index, sample) in increments.iter().enumerate() {
        let error = errors.get(index).copied().unwrap_or_default();
        let velocity = sample.velocity.components() - error * sample.interval;
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
