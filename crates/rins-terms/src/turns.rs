//! The way a table's rate changed last.

use rins_motion::median;

/// How far a rate has to change for that to be more than a servo that holds it \[rad/s\].
const LEAST_CHANGE: f64 = 5e-3;

/// A rate that has not yet changed is within this part of [`LEAST_CHANGE`] of where it was furthest ...
const STEADY: f64 = 0.05;

/// ... or within so many σ of its noise, if these are more, but never beyond [`LEAST_CHANGE`].
const SIGMAS: f64 = 8.0;

/// Rates are taken over so many samples, so that they have less of the angles' noise.
const OVER: usize = 9;

/// The way the rate changed last at each sample: 1, -1, or 0 before it ever changed, as it does from rest.
///
/// `rate` is the mean one from one sample on to before another \[rad/s\]. That it changes is seen after a change of
/// [`LEAST_CHANGE`], and dated back to when it began: from a steady rate where it left that, between two ramps and at the
/// crest of a wave where it was furthest.
pub(crate) fn turns(samples: usize, rate: impl Fn(usize, usize) -> f64) -> Vec<f32> {
    let smooth = |at: usize| {
        let start = at.saturating_sub(OVER / 2);
        rate(start, (start + OVER).min(samples))
    };
    let rates: Vec<f64> = (0..samples).map(smooth).collect();
    let band = (SIGMAS * noise(&rates)).clamp(STEADY * LEAST_CHANGE, LEAST_CHANGE);
    let mut turns = vec![0.0; samples];
    let mut way = 0.0_f32;
    // Before the first sample it rested.
    let (mut furthest, mut last) = (0.0_f64, None);
    for (at, &rate) in rates.iter().enumerate() {
        let onward =
            if way == 0.0 { -(rate - furthest).abs() } else { f64::from(way) * (rate - furthest) };
        if onward < -LEAST_CHANGE {
            way = if rate > furthest { 1.0 } else { -1.0 };
            let began = last.map_or(0, |last| began(&rates[..=at], last, furthest, band));
            turns[began..at].fill(way);
            (furthest, last) = (rate, Some(at));
        } else if onward > -band {
            last = Some(at);
            if onward > 0.0 {
                furthest = rate;
            }
        }
        turns[at] = way;
    }
    turns
}

/// The first sample of a change that is seen at the last of `rates`, after `last` was the last within a band of the
/// furthest rate.
fn began(rates: &[f64], last: usize, furthest: f64, band: f64) -> usize {
    let within = |rate: &&f64| (*rate - furthest).abs() < band;
    let held = rates[..=last].iter().rev().take_while(within).count();
    // A rate that was held for longer than the change took was steady.
    if held < rates.len() - last { last + 1 - held / 2 } else { last + 1 }
}

/// The scatter of rates over [`OVER`] samples each, from those that have no sample in common.
fn noise(rates: &[f64]) -> f64 {
    let apart: Vec<f64> = rates.iter().copied().step_by(OVER).collect();
    // Fourth differences, in which nothing is left of a wave.
    let bend = |some: &[f64]| (some[0] + some[4] - 4.0 * (some[1] + some[3]) + 6.0 * some[2]).abs();
    let usual = median(apart.windows(5).map(bend)).unwrap_or_default();
    // An angle's noise is in both rates that share it: of the angles, these are fifth differences.
    1.4826 * usual / (252.0_f64 / 2.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const INTERVAL: f64 = 0.02;

    /// When the way changes, and to which, of a table with these angles that scatter so much \[s\].
    fn changes(samples: usize, noise: f64, angle: impl Fn(f64) -> f64) -> Vec<(f64, f32)> {
        let scatter = |at: usize| noise * ((at * at % 97) as f64 / 48.0 - 1.0);
        let read = |at: usize| angle(at as f64 * INTERVAL) + scatter(at);
        let turns =
            turns(samples, |from, to| (read(to) - read(from)) / ((to - from) as f64 * INTERVAL));
        let mut before = 0.0;
        let mut changes = Vec::new();
        for (at, &way) in turns.iter().enumerate() {
            if (way - before).abs() > 0.5 {
                changes.push((at as f64 * INTERVAL, way));
            }
            before = way;
        }
        changes
    }

    fn assert_changes(found: &[(f64, f32)], want: &[(f64, f32)], within: f64) {
        assert_eq!(found.len(), want.len(), "{found:?}");
        for (found, want) in found.iter().zip(want) {
            let same = (found.0 - want.0).abs() < within && (found.1 - want.1).abs() < 0.5;
            assert!(same, "{found:?} {want:?}");
        }
    }

    /// A gentle wave: half a second after its crest the rate is less by the least change.
    #[test]
    fn rate_of_a_wave_turns_at_its_crests() {
        let (rate, period) = (0.2, 30.0);
        let per_radian = period / std::f64::consts::TAU;
        for noise in [0.0, 1e-6] {
            let angle = |time: f64| -rate * per_radian * (time / per_radian).cos();
            let want = [(0.0, 1.0), (7.5, -1.0), (22.5, 1.0), (37.5, -1.0)];
            assert_changes(&changes(2500, noise, angle), &want, 0.15);
        }
    }

    /// Ramps that follow each other turn at once, and such with a steady rate between them where that ends.
    #[test]
    fn rate_that_is_held_changes_when_it_is_left() {
        // From rest up to ten seconds, held for so long, and down.
        let angle = |held: f64| {
            move |time: f64| {
                let up = time.min(10.0);
                let steady = (time - 10.0).clamp(0.0, held);
                let down = (time - 10.0 - held).max(0.0);
                0.005 * up * up + 0.1 * (steady + down) - 0.005 * down * down
            }
        };
        for noise in [0.0, 1e-6] {
            for (held, samples) in [(0.0, 1000), (15.0, 1750)] {
                let want = [(0.0, 1.0), (10.0 + held, -1.0)];
                assert_changes(&changes(samples, noise, angle(held)), &want, 0.1);
            }
        }
    }

    /// A change is dated to where the rate leaves its noise: never before it began, and no later than where it is seen without
    /// noise. A little noise hardly moves it.
    #[test]
    fn a_noisy_rate_changes_when_it_is_left() {
        const ACCELERATION: f64 = 0.01;
        const SAMPLES_OF_A_RATE: f64 = OVER as f64 * INTERVAL;
        let angle = |time: f64| {
            let up = time.min(10.0);
            let steady = (time - 10.0).clamp(0.0, 15.0);
            let down = (time - 25.0).max(0.0);
            0.5 * ACCELERATION * (up * up - down * down) + 0.1 * (steady + down)
        };
        let seen = LEAST_CHANGE / ACCELERATION;
        for (noise, late) in [(1e-6, 0.1), (1e-5, 0.1), (3e-5, 0.2), (1e-4, seen)] {
            let found = changes(1750, noise, angle);
            let [(up, 1.0), (down, -1.0)] = found[..] else { panic!("{noise}: {found:?}") };
            for since in [up, down - 25.0] {
                assert!(since >= -0.5 * SAMPLES_OF_A_RATE && since < late, "{noise}: {found:?}");
            }
        }
    }

    /// What a servo leaves of a steady rate is no change of it, however slow.
    #[test]
    fn ripple_of_a_steady_rate_is_none() {
        let angle = |time: f64| 0.2 * time - 1e-4 * (time / 10.0).cos();
        assert_eq!(changes(10_000, 1e-6, angle), [(0.0, 1.0)]);
    }

    /// A rate that swings by less than a servo may is steady until it is left, wherever its last crest was.
    #[test]
    fn a_steady_rate_with_ripple_changes_when_it_is_left() {
        let angle = |time: f64| {
            let down = (time - 100.0).max(0.0);
            0.2 * time - 1e-3 * (time.min(100.0) / 10.0).cos() - 0.005 * down * down
        };
        assert_changes(&changes(5500, 0.0, angle), &[(0.0, 1.0), (100.0, -1.0)], 0.2);
    }
}
