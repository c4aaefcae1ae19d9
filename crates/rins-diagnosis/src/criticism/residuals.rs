//! What the sensors read beyond what a model says, sample by sample.

use nalgebra::Vector3;
use rins_estimation::{Fit, Reference, Run};
use rins_terms::{Acting, Model, Track, values};

use crate::criticism::structure::CHANNELS;

/// The gyro about the spin axis, which is seen against the encoder.
pub(crate) const ABOUT_AXIS: usize = 2;

/// What the sensors of a run read beyond its model in a fit: rates \[rad/s\] and forces \[m/s²\]. Nothing where samples are
/// missing and one is held for them.
///
/// About the spin axis it is what the gyro reads beyond the encoder: a table that turns unevenly moves both. Without an
/// encoder nothing tells them apart, and nothing is there.
pub(crate) fn residuals(run: &Run, fit: &Fit, of: usize) -> [Vec<f64>; CHANNELS] {
    beyond(run, fit.linear[of].track(), &fit.models[of])
}

/// The same beyond any model, about the table's way in `track`.
pub(crate) fn beyond(run: &Run, track: &Track, model: &Model) -> [Vec<f64>; CHANNELS] {
    let mut all: [Vec<f64>; CHANNELS] = Default::default();
    let encoder = match run.rig.reference {
        Reference::Encoder { .. } => run.recording.table_angle.as_deref(),
        _ => None,
    };
    let mut before: Option<f64> = None;
    let terms = Acting::present(model, track);
    let opening = track.opening().map(|moment| values(&Acting::together(&terms, &moment).tilt));
    let mut tilt_before = opening.unwrap_or_default();
    let samples = &run.recording.increments;
    let longest = run.recording.longest_interval();
    for (index, (moment, sample)) in track.moments().zip(samples).enumerate() {
        let predicted = Acting::together(&terms, &moment);
        let rates = sample.rates();
        // A base that tilts turns the gyros, and the direction of all that is felt.
        let tilt = values(&predicted.tilt);
        let turning = moment.in_body(&(tilt - tilt_before)) / sample.interval;
        let force = &moment.surroundings.specific_force;
        let leaning = moment.in_body(&force.cross(&((tilt + tilt_before) * 0.5)));
        tilt_before = tilt;
        let mut gyro: Vector3<f64> =
            rates.angular_rate.components() - moment.rate - values(&predicted.gyro) - turning;
        gyro.z = 0.0;
        if let Some(angle) = encoder.map(|readings| readings[index] - predicted.angle.re) {
            if let Some(before) = before {
                let turned = (angle - before) / sample.interval;
                let carried = moment.rate.z - moment.mean.rate + values(&predicted.gyro).z;
                gyro.z = rates.angular_rate.components().z - turned - carried;
            }
            before = Some(angle);
        }
        if sample.interval > longest {
            for channel in &mut all {
                channel.push(0.0);
            }
            continue;
        }
        let accel =
            rates.specific_force.components() - moment.force - values(&predicted.accel) - leaning;
        for axis in 0..3 {
            all[axis].push(gyro[axis]);
            all[3 + axis].push(accel[axis]);
        }
    }
    all
}

/// What the gyros across the axis read, turned into the axis frame, where a base that sways is one line.
pub(crate) fn in_axis_frame(track: &Track, of_sensors: &[Vec<f64>; CHANNELS]) -> [Vec<f64>; 2] {
    let across = of_sensors[0].iter().zip(&of_sensors[1]);
    let turned = track.moments().zip(across).map(|(moment, (x, y))| {
        let (sin, cos) = moment.mean.angle.sin_cos();
        (x * cos - y * sin, x * sin + y * cos)
    });
    let (x, y) = turned.unzip();
    [x, y]
}
