//! The uncertainty of the motion during missing samples.

use nalgebra::Vector3;
use rins_frames::Increments;
use rins_motion::{Recording, whole};

use crate::epoch::Epoch;

/// The smallest number of samples on each side from which the variation of the motion is estimated.
const FEWEST_AROUND: usize = 3;

/// Sets the uncertainty due to missing samples in every epoch; `usual` is the usual interval of a sample \[s\].
pub(crate) fn hold(epochs: &mut [Epoch], recording: &Recording, usual: f64) {
    let samples = &recording.increments;
    let longest = Recording::GAP * usual;
    let long = samples.iter().enumerate().filter(|(_, one)| one.interval > longest);
    for (sample, increments) in long {
        let Some(epoch) = epochs.get_mut(epochs.partition_point(|e| e.samples.1 <= sample)) else {
            continue;
        };
        let lasting = increments.interval - usual;
        let [angle, velocity] =
            scatter(samples, sample, lasting / usual).map(|v| v * lasting.powi(2));
        // The readings from the end of this sample on contain it.
        let part = (epoch.samples.1 - sample) as f64 / epoch.count();
        let held = epoch.held.get_or_insert_default();
        held.angle += angle;
        held.angle_with_mean += angle * part;
        held.mean_angle += angle * (part * part);
        held.velocity += velocity;
    }
}

/// The mean squared differences between the rates around a sample and its own, \[rad²/s²\] and \[m²/s⁴\], from as many samples
/// on each side as are `missing`. The body rotates between x and y, which have a common value.
fn scatter(samples: &[Increments], sample: usize, missing: f64) -> [Vector3<f64>; 2] {
    let reach = FEWEST_AROUND.max(whole(missing));
    let around = &samples[sample.saturating_sub(reach)..samples.len().min(sample + reach + 1)];
    let own = samples[sample].rates();
    let mut sums = [Vector3::zeros(); 2];
    for other in around.iter().map(Increments::rates) {
        let gyro = other.angular_rate.components() - own.angular_rate.components();
        let accel = other.specific_force.components() - own.specific_force.components();
        sums[0] += gyro.component_mul(&gyro);
        sums[1] += accel.component_mul(&accel);
    }
    let others = (around.len() - 1).max(1) as f64;
    sums.map(|sum| {
        let across = 0.5 * (sum.x + sum.y);
        Vector3::new(across, across, sum.z) / others
    })
}
