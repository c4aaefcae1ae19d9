//! When a base tips over: within an epoch, but the gyros show in which sample.

use std::ops::Range;

use rins_estimation::Fit;
use rins_terms::{Need, SettingKind, TermInstance, Track, catalogue};

use crate::case::Case;
use crate::criticism::residuals::residuals;
use crate::median::median;

/// Readings of so many sigmas are part of a jolt.
const PART: f64 = 4.0;

/// Over a sample in which an encoder jumps it is off by so many of them against the gyro: more than any of a long run's.
const JUMP: f64 = 5.5;

/// How many jumps of an encoder are looked at.
const JUMPS: usize = 3;

/// What the gyros across the axis show of jolts in some runs, and that about it of an encoder's jumps.
pub(crate) struct Jolts {
    runs: Vec<Shown>,
}

/// The readings of a run that are part of a jolt.
struct Shown {
    /// Of each the middle of its sample since the start \[s\], and its size \[rad/s\].
    parts: Vec<(f64, f64)>,
    /// The middles of the samples over which the encoder jumps against the gyro, the largest first \[s\].
    jumps: Vec<f64>,
    /// The length of an epoch \[s\].
    epoch: f64,
    /// The time between samples \[s\].
    interval: f64,
}

impl Case<'_> {
    /// What is left of the gyros' readings across the axis, where it is no noise.
    pub(crate) fn jolts(&self, present: &Fit) -> Jolts {
        let of_run = |(run, recorded)| {
            let linear = &present.linear[run];
            let [x, y, about, ..] = residuals(recorded, present, run);
            let across: Vec<f64> = x.iter().zip(&y).map(|(x, y)| x.hypot(*y)).collect();
            let begin = linear.track().start();
            let samples = recorded.recording.times.iter().zip(&recorded.recording.increments);
            let middles = samples.map(|(end, sample)| end - 0.5 * sample.interval - begin);
            let large = |sizes: &[f64], least: f64| -> Vec<(f64, f64)> {
                let sizes = middles.clone().zip(sizes.iter().copied());
                sizes.filter(|(_, size)| *size > least).collect()
            };
            // Half of all are below 1.18 sigma, of one figure alone below 0.67.
            let parts = large(&across, PART * median(&across) / 1.18);
            let sizes: Vec<f64> = about.iter().map(|rate| rate.abs()).collect();
            // A step more or less is rounding.
            let steps = recorded.angle_steps.map_or(0.0, |steps| 2.0 * steps.step);
            let rounding = steps / recorded.recording.mean_interval();
            let mut jumps = large(&sizes, (JUMP * median(&sizes) / 0.67).max(rounding));
            jumps.sort_by(|a, b| b.1.total_cmp(&a.1));
            let jumps = jumps.into_iter().take(JUMPS).map(|(time, _)| time).collect();
            let interval = recorded.recording.mean_interval();
            Shown { parts, jumps, epoch: linear.mean_epoch(), interval }
        };
        Jolts { runs: self.runs.iter().enumerate().map(of_run).collect() }
    }
}

impl Jolts {
    /// The middle of the one about this time since the start, within an epoch of it, if there is one, and how long it takes
    /// if that is more than a sample \[s\].
    pub(crate) fn about(&self, time: f64) -> Option<(f64, f64)> {
        let found = self.runs.iter().filter_map(|shown| {
            let near = |(at, _): &&(f64, f64)| (at - time).abs() < shown.epoch;
            let near: Vec<(f64, f64)> = shown.parts.iter().filter(near).copied().collect();
            let largest = near.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
            let goes_on = |a: &(f64, f64), b: &(f64, f64)| b.0 - a.0 < 1.5 * shown.interval;
            let jolt = near.chunk_by(goes_on).find(|row| row.contains(largest))?;
            let sum: f64 = jolt.iter().map(|(_, size)| size).sum();
            let middle = jolt.iter().map(|(at, size)| size * at).sum::<f64>() / sum;
            let square = |(at, size): &(f64, f64)| size * (at - middle).powi(2);
            let variance = jolt.iter().map(square).sum::<f64>() / sum;
            // An even step over n samples: (n² - 1) / 12.
            let duration = (12.0 * variance + shown.interval.powi(2)).sqrt();
            Some((sum, middle, if jolt.len() > 1 { duration } else { 0.0 }))
        });
        found.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, middle, duration)| (middle, duration))
    }

    /// When the encoder of a run jumps, the largest jump first \[s\].
    pub(crate) fn jumps(&self, run: usize) -> &[f64] {
        &self.runs[run].jumps
    }

    /// Puts an event of the base or of the encoder to where single samples show it, if they do so within an epoch of it.
    pub(crate) fn pin(&self, event: &mut TermInstance) {
        let Some(place) = event.term.setting(SettingKind::Time) else { return };
        let time = event.settings[place];
        if event.term.is(&catalogue::BASE_TILT_STEP) {
            if let Some((middle, duration)) = self.about(time) {
                *event = event
                    .clone()
                    .with_setting(SettingKind::Time, middle)
                    .with_setting(SettingKind::Duration, duration);
            }
        } else if event.term.needs.contains(&Need::TableAngle) {
            let near = |shown: &Shown| {
                shown.jumps.iter().copied().find(|at| (at - time).abs() < shown.epoch)
            };
            event.settings[place] = self.runs.iter().find_map(near).unwrap_or(time);
        }
    }
}

/// The samples in which a base steps: not at once, and what it does in between no step describes.
pub(crate) fn around(step: &TermInstance, track: &Track, epoch: f64) -> Range<usize> {
    let first = |after: f64| track.times().partition_point(|time| time - track.start() < after);
    let [time, duration] = step.settings[..] else { return 0..0 };
    let reach = epoch + 0.5 * duration;
    first(time - reach)..first(time + reach)
}
