//! The regularity of the samples.

use rins_motion::{Recording, median};

/// An interval that is longer than the median by this factor is a gap.
const GAP_RATIO: f64 = 1.5;

/// The regularity of the samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// The median interval \[s\].
    pub interval: f64,
    /// The root mean square deviation of the intervals from it, without gaps \[s\].
    pub jitter: f64,
    /// The intervals that are at least 50 % longer: index and duration \[s\].
    pub gaps: Vec<(usize, f64)>,
}

impl Timing {
    pub(super) fn of(recording: &Recording) -> Self {
        let intervals = recording.increments.iter().map(|sample| sample.interval);
        let interval = median(intervals).unwrap_or_default();
        let mut gaps = Vec::new();
        let (mut square, mut count) = (0.0, 0.0_f64);
        for (index, sample) in recording.increments.iter().enumerate() {
            if sample.interval > GAP_RATIO * interval {
                gaps.push((index, sample.interval));
            } else {
                square += (sample.interval - interval).powi(2);
                count += 1.0;
            }
        }
        Self { interval, jitter: (square / count.max(1.0)).sqrt(), gaps }
    }
}
