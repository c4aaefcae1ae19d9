//! The way of a base that nothing reads: what the gyros say that it sways by, if gravity says so too.

use nalgebra::{Rotation3, Vector3};
use rins_frames::Increments;

use crate::run::{Reference, Run};

/// The attitude of the body in the axis frame over a rest, as the gyros have it but for their mean.
///
/// A reference that follows the base keeps errors small where it sways by more than the gyros' noise: what is linear is
/// what differs from it. Their mean holds the Earth's rate and the biases, and is left to the model.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sway {
    /// The mean of what the gyros read \[rad/s\].
    pub(crate) mean_rate: Vector3<f64>,
    /// In the middle of each sample, and at its end.
    pub(crate) attitudes: Vec<[Rotation3<f64>; 2]>,
}

impl Sway {
    /// That of a run at rest whose base sways; of any other, none.
    ///
    /// What the gyros wander by while the base stands is no attitude: only if the specific force is steadier when turned
    /// back by it does the base sway.
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

/// How many times less the specific force must scatter where the sway is turned back.
const STEADIER: f64 = 4.0;

/// The time over which the specific force is averaged \[s\].
const AVERAGED: f64 = 1.0;

/// The variance of the specific force, averaged over a second, where each sample is turned back.
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
