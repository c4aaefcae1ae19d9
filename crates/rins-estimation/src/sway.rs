//! The trajectory of a base without a measured angle: the motion according to the gyros, if the accelerometers confirm it.

use nalgebra::{Rotation3, Vector3};
use rins_frames::Increments;

use crate::run::{Reference, Run};

/// The attitude of the body in the axis frame during a static run, from the gyros without their mean.
///
/// A reference trajectory that follows the base keeps the errors small where the sway exceeds the gyros' noise: the linear
/// states are deviations from it. The mean contains the Earth's rate and the biases, and is part of the model.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sway {
    /// The mean reading of the gyros \[rad/s\].
    pub(crate) mean_rate: Vector3<f64>,
    /// The attitudes in the middle and at the end of each sample.
    pub(crate) attitudes: Vec<[Rotation3<f64>; 2]>,
}

impl Sway {
    /// The sway of a static run if its base sways; `None` for any other run.
    ///
    /// The drift of the gyros on a stationary base is not an attitude: the base sways only if the specific force varies less
    /// after a transformation with these attitudes.
    pub(crate) fn of(run: &Run) -> Option<Self> {
        if run.rig.reference != Reference::Rest {
            return None;
        }
        let samples = &run.recording.increments;
        let duration: f64 = samples.iter().map(|sample| sample.interval).sum();
        let turned: Vector3<f64> = samples.iter().map(|sample| sample.angle.components()).sum();
        let mean_rate = turned / duration;
        let mut now = Rotation3::identity();
        let attitudes = samples
            .iter()
            .map(|sample| {
                let turn = sample.angle.components() - mean_rate * sample.interval;
                let middle = now * Rotation3::new(turn * 0.5);
                now *= Rotation3::new(turn);
                [middle, now]
            })
            .collect();
        let sway = Self { mean_rate, attitudes };
        let none = scatter(samples, |_| Rotation3::identity());
        (STEADIER * scatter(samples, |sample| sway.attitudes[sample][0]) < none).then_some(sway)
    }
}

/// The factor by which the variance of the specific force must decrease if the sway is real.
const STEADIER: f64 = 4.0;

/// The averaging time of the specific force \[s\].
const AVERAGED: f64 = 1.0;

/// The variance of the specific force, averaged over a second, after a transformation with `turned_back`.
fn scatter(samples: &[Increments], turned_back: impl Fn(usize) -> Rotation3<f64>) -> f64 {
    let mut means = Vec::new();
    let (mut velocity, mut duration) = (Vector3::zeros(), 0.0);
    for (index, sample) in samples.iter().enumerate() {
        velocity += turned_back(index) * sample.velocity.components();
        duration += sample.interval;
        if duration >= AVERAGED {
            means.push(velocity / duration);
            (velocity, duration) = (Vector3::zeros(), 0.0);
        }
    }
    let count = means.len().max(1) as f64;
    let mean = means.iter().sum::<Vector3<f64>>() / count;
    means.iter().map(|of| (of - mean).norm_squared()).sum::<f64>() / count
}
