//! Samples of a static interval at even time steps, with lost samples filled in.

use std::ops::Range;

use rins_frames::{Increments, Rates};
use rins_motion::{Recording, median};

/// An interval between samples that exceeds the usual one by this factor contains a gap.
const GAP: f64 = 1.5;

/// Lost samples are filled in up to this fraction of all samples.
pub(super) const MOST_FILLED: f64 = 0.01;

/// Samples at even time steps, with lost samples filled in.
pub(super) struct Filled {
    pub(super) samples: Vec<Increments>,
    /// The mean time step \[s\].
    pub(super) interval: f64,
    pub(super) lost: usize,
}

impl Filled {
    /// The samples of `span`, unchanged.
    pub(super) fn whole(recording: &Recording, span: Range<usize>) -> Self {
        let samples = recording.increments[span].to_vec();
        let duration: f64 = samples.iter().map(|sample| sample.interval).sum();
        Self { interval: duration / samples.len().max(1) as f64, samples, lost: 0 }
    }

    /// The samples of `span` with lost samples filled in; `None` if more are lost than may be filled in.
    ///
    /// If the sensor continued to accumulate during the gap, the sum of the lost samples is known. Otherwise each lost sample
    /// becomes the mean of the samples before and after it. That has half the variance of white noise, so that one lost sample in
    /// a hundred reduces the Allan variance at the shortest averaging time by half a percent.
    pub(super) fn of(recording: &Recording, span: Range<usize>, accumulated: bool) -> Option<Self> {
        let samples = &recording.increments[span.clone()];
        let usual = median(samples.iter().map(|sample| sample.interval))?;
        let mut filled = Vec::with_capacity(samples.len());
        let mut lost = 0;
        for (place, sample) in samples.iter().enumerate() {
            let missing = missing(sample.interval, usual);
            if missing == 0 {
                filled.push(*sample);
                continue;
            }
            lost += missing;
            if lost as f64 > MOST_FILLED * samples.len() as f64 {
                return None;
            }
            let part = sample.interval / (missing + 1) as f64;
            let own = sample.rates();
            let between = match place.checked_sub(1).filter(|_| !accumulated) {
                Some(before) => {
                    let before = samples[before].rates();
                    Rates {
                        angular_rate: (before.angular_rate + own.angular_rate) * 0.5,
                        specific_force: (before.specific_force + own.specific_force) * 0.5,
                    }
                }
                None => own,
            };
            filled.extend(std::iter::repeat_n(between.over(part), missing));
            filled.push(own.over(part));
        }
        let duration: f64 = samples.iter().map(|sample| sample.interval).sum();
        Some(Self { interval: duration / filled.len() as f64, samples: filled, lost })
    }

    /// The fraction of the samples that is filled in.
    pub(super) fn share(&self) -> f64 {
        self.lost as f64 / self.samples.len() as f64
    }
}

/// The number of samples that are missing in an interval.
fn missing(interval: f64, usual: f64) -> usize {
    if interval <= GAP * usual {
        return 0;
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is more than one, and gaps are of a second at most"
    )]
    let samples = (interval / usual).round() as usize;
    samples.saturating_sub(1)
}

/// The longest part of these samples without a gap.
pub(super) fn unbroken(recording: &Recording, span: Range<usize>) -> Range<usize> {
    let samples = &recording.increments;
    let usual = median(samples[span.clone()].iter().map(|sample| sample.interval));
    let longest = GAP * usual.unwrap_or_default();
    let gaps = span.clone().filter(|k| samples[*k].interval > longest);
    let mut parts = Vec::new();
    let mut start = span.start;
    for gap in gaps.chain([span.end]) {
        parts.push(start..gap);
        start = gap + 1;
    }
    parts.into_iter().max_by_key(ExactSizeIterator::len).unwrap_or(span)
}
