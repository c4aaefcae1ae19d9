//! When a base tips over: within an epoch, but the gyros show in which sample.

use std::ops::Range;

use rins_estimation::Fit;
use rins_terms::{Chosen, Track};

use crate::case::Case;
use crate::residuals::residuals;

/// Readings of so many sigmas are part of a jolt.
const PART: f64 = 4.0;

/// What the gyros across the axis show of jolts in some runs.
pub(crate) struct Jolts {
    runs: Vec<Shown>,
}

/// The readings of a run that are part of a jolt.
struct Shown {
    /// Of each the middle of its sample since the start \[s\], and its size \[rad/s\].
    parts: Vec<(f64, f64)>,
    /// The length of an epoch \[s\].
    epoch: f64,
}

impl Case<'_> {
    /// What is left of the gyros' readings across the axis, where it is no noise.
    pub(crate) fn jolts(&self, present: &Fit) -> Jolts {
        let of_run = |(run, recorded)| {
            let linear = &present.linear[run];
            let [x, y, ..] = residuals(recorded, present, run);
            let across = || x.iter().zip(&y).map(|(x, y)| x.hypot(*y));
            let mut sizes: Vec<f64> = across().collect();
            let middle = sizes.len() / 2;
            // Half of all are below 1.18 sigma.
            let (_, &mut median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
            let least = PART * median / 1.18;
            let begin = linear.track().start();
            let samples = recorded.recording.times.iter().zip(&recorded.recording.increments);
            let middles = samples.map(|(end, sample)| end - 0.5 * sample.interval - begin);
            let parts = middles.zip(across()).filter(|(_, size)| *size > least).collect();
            Shown { parts, epoch: linear.mean_epoch() }
        };
        Jolts { runs: self.runs.iter().enumerate().map(of_run).collect() }
    }
}

impl Jolts {
    /// The middle of the one about this time since the start, within an epoch of it, if there is one \[s\].
    pub(crate) fn about(&self, time: f64) -> Option<f64> {
        let of_run = |shown: &Shown| {
            let near = shown.parts.iter().filter(|(at, _)| (at - time).abs() < shown.epoch);
            let (sum, moment) =
                near.fold((0.0, 0.0), |(sum, moment), (at, size)| (sum + size, moment + size * at));
            (sum > 0.0).then_some((sum, moment / sum))
        };
        let found = self.runs.iter().filter_map(of_run);
        found.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, time)| time)
    }
}

/// The samples in which a base steps: not at once, and what it does in between no step describes.
pub(crate) fn around(step: &Chosen, track: &Track, epoch: f64) -> Range<usize> {
    let first = |after: f64| track.times().partition_point(|time| time - track.start() < after);
    first(step.settings[0] - epoch)..first(step.settings[0] + epoch)
}
