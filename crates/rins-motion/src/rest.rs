//! The mean output of a stationary IMU.

use std::ops::Range;

use nalgebra::Vector3;
use rins_frames::{InFrame, Rates};

use crate::recording::Recording;

/// The mean rates over a static interval, and their uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestMean {
    /// The means.
    pub rates: Rates,
    /// The duration of the interval \[s\].
    pub duration: f64,
    /// The 1σ of each gyro's mean, from the scatter of partial means \[rad/s\].
    pub angular_rate_sigma: Vector3<f64>,
    /// The same for each accelerometer's mean \[m/s²\].
    pub specific_force_sigma: Vector3<f64>,
}

impl RestMean {
    /// The means over samples `span` of a recording, or `None` if the span is out of range or has fewer than two samples,
    /// which do not determine the scatter.
    ///
    /// Their sigma is the standard deviation of up to 20 batch means, divided by the square root of their number. It is
    /// correct for white noise and for drifts that are short compared with the span, and does not contain constant biases.
    /// Its relative uncertainty is one sixth.
    pub fn of(recording: &Recording, span: Range<usize>) -> Option<Self> {
        const BATCHES: usize = 20;
        let samples = recording.increments.get(span).filter(|samples| samples.len() > 1)?;
        let (rates, duration) = mean(samples);
        let size = samples.len().div_ceil(BATCHES);
        let batches: Vec<Rates> = samples.chunks_exact(size).map(|batch| mean(batch).0).collect();
        let count = batches.len() as f64;
        let spread = |of: fn(&Rates) -> Vector3<f64>| {
            let square = |sum: Vector3<f64>, batch: &Rates| {
                let off = of(batch) - of(&rates);
                sum + off.component_mul(&off)
            };
            let variance = batches.iter().fold(Vector3::zeros(), square) / (count - 1.0);
            variance.map(|variance| (variance / count).sqrt())
        };
        Some(Self {
            rates,
            duration,
            angular_rate_sigma: spread(|rates| *rates.angular_rate.components()),
            specific_force_sigma: spread(|rates| *rates.specific_force.components()),
        })
    }
}

fn mean(samples: &[rins_frames::Increments]) -> (Rates, f64) {
    let mut duration = 0.0;
    let (mut angle, mut velocity) = (Vector3::zeros(), Vector3::zeros());
    for sample in samples {
        angle += sample.angle.components();
        velocity += sample.velocity.components();
        duration += sample.interval;
    }
    let rates = Rates {
        angular_rate: InFrame::from_components(angle / duration),
        specific_force: InFrame::from_components(velocity / duration),
    };
    (rates, duration)
}
