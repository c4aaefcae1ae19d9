//! A recording: the increments and the table readings of a run.

use std::ops::Range;

use rins_frames::Increments;

/// The samples of one run, in order of time, all in SI units.
///
/// Sample `k` covers the interval that ends at `times[k]`. Every list is as long as `times`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// The end of each sample's interval \[s\], strictly increasing.
    pub times: Vec<f64>,
    /// The increments of the IMU over each interval.
    pub increments: Vec<Increments>,
    /// The table angle at the end of each interval, unwrapped \[rad\].
    pub table_angle: Option<Vec<f64>>,
    /// The mean commanded table rate over each interval \[rad/s\].
    pub table_rate: Option<Vec<f64>>,
    /// The temperature at the end of each interval \[°C\].
    pub temperature: Option<Vec<f64>>,
}

impl Recording {
    /// The interval relative to the usual one above which samples are missing.
    pub const GAP: f64 = 1.5;

    /// The number of samples.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Whether more than half a sample is missing before a sample, so that the motion in between is unknown.
    ///
    /// # Panics
    /// If there is no such sample.
    pub fn gap_before(&self, sample: usize) -> bool {
        sample > 0
            && self.times[sample] - self.times[sample - 1]
                > Self::GAP * self.increments[sample].interval
    }

    /// The samples between gaps, in order.
    pub fn between_gaps(&self) -> impl Iterator<Item = Range<usize>> {
        let mut start = 0;
        let ends = (1..=self.len()).filter(|&end| end == self.len() || self.gap_before(end));
        ends.map(move |end| std::mem::replace(&mut start, end)..end)
    }

    /// The mean interval of a sample \[s\].
    pub fn mean_interval(&self) -> f64 {
        let total: f64 = self.increments.iter().map(|sample| sample.interval).sum();
        total / self.increments.len() as f64
    }

    /// The longest interval without missing samples \[s\].
    pub fn longest_interval(&self) -> f64 {
        Self::GAP * self.mean_interval()
    }

    /// The samples from index `first` up to, not including, `end`.
    ///
    /// # Panics
    /// If `first..end` is not a range of this recording.
    #[must_use]
    pub fn slice(&self, first: usize, end: usize) -> Self {
        let of = |list: &Option<Vec<f64>>| list.as_ref().map(|list| list[first..end].to_vec());
        Self {
            times: self.times[first..end].to_vec(),
            increments: self.increments[first..end].to_vec(),
            table_angle: of(&self.table_angle),
            table_rate: of(&self.table_rate),
            temperature: of(&self.temperature),
        }
    }
}
