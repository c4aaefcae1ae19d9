//! When a base tips over: within an epoch, but the gyros show in which sample.

use rins_estimation::Fit;

use crate::case::Case;
use crate::residuals::residuals;

/// Readings of so many sigmas are part of a jolt.
const PART: f64 = 4.0;

impl Case<'_> {
    /// The middle of what the gyros across the axis show about this time since the start, within an epoch of it, if they
    /// show anything \[s\].
    pub(crate) fn jolt(&self, present: &Fit, time: f64) -> Option<f64> {
        let of_run = |(run, recorded)| {
            let linear = &present.linear[run];
            let [x, y, ..] = residuals(recorded, present, run);
            let across = || x.iter().zip(&y).map(|(x, y)| x.hypot(*y));
            let mut sizes: Vec<f64> = across().collect();
            let middle = sizes.len() / 2;
            // Half of all are below 1.18 sigma.
            let (_, &mut median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
            let least = PART * median / 1.18;
            let (begin, epoch) = (linear.track().start(), linear.mean_epoch());
            let (mut sum, mut moment) = (0.0, 0.0);
            for ((size, end), sample) in
                across().zip(&recorded.recording.times).zip(&recorded.recording.increments)
            {
                let at = end - 0.5 * sample.interval - begin;
                if size > least && (at - time).abs() < epoch {
                    sum += size;
                    moment += size * at;
                }
            }
            (sum > 0.0).then_some((sum, moment / sum))
        };
        let found = self.runs.iter().enumerate().filter_map(of_run);
        found.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, time)| time)
    }
}
