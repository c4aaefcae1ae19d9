//! A single channel that repeats its reading while the others change.

use std::ops::Range;

use crate::quantization_grid::comb;
use crate::rows::{BEYOND_CHANCE, LONGEST, MOST, alike, rows_of};
use rins_motion::median;

/// Readings whose noise is less than this number of grid steps, or than this fraction of the largest, may be constant for
/// long in a static interval.
const TEETH: f64 = 3.0;
const ROUNDING: f64 = 1e-9;

/// The spans in which a channel is stuck, and the expected number of repeats by chance.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sticking {
    /// The spans without the reading that is repeated.
    pub(crate) rows: Vec<Range<usize>>,
    pub(crate) by_chance: f64,
}

impl Sticking {
    /// The spans in which `readings` repeat, without the samples in `passed`; empty if the readings are coarse or without
    /// noise, if chance explains the repeats, or if they are at the ends of the sensor's range.
    pub(crate) fn of(readings: &[f64], passed: &[bool]) -> Self {
        let none = Self::default();
        let ends = readings.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| {
            (least.min(*x), most.max(*x))
        });
        let repeats = |sample: usize, back: usize| {
            sample >= back && alike(readings[sample - back], readings[sample])
        };
        let counts = |sample: &usize| {
            let is_end = alike(readings[*sample], ends.0) || alike(readings[*sample], ends.1);
            !passed[*sample] && !is_end
        };
        let sticks = |sample: usize| counts(&sample) && repeats(sample, 1);
        let mut rows = rows_of(&(0..readings.len()).map(sticks).collect::<Vec<bool>>());
        let total = |rows: &[Range<usize>]| rows.iter().map(Range::len).sum::<usize>() as f64;
        if total(&rows) > MOST * readings.len() as f64 {
            // A sensor slower than the log repeats most readings; it is stuck only if it does so for long.
            rows.retain(|row| row.len() > LONGEST);
        }
        let samples = total(&rows);
        if samples == 0.0 {
            return none;
        }
        // By chance a reading equals the last but one equally often. One more: zero occurrences do not imply a probability of
        // zero.
        let alternates = |&sample: &usize| repeats(sample, 2) && !repeats(sample, 1);
        let by_chance = 1.0 + (2..readings.len()).filter(counts).filter(alternates).count() as f64;
        if samples < 1.0 + BEYOND_CHANCE * by_chance {
            return none;
        }
        // Without noise a span of equal readings may be real.
        if is_noisy(readings) { Self { rows, by_chance } } else { none }
    }
}

/// The spans of repeated readings that are the largest or the smallest of all.
pub(crate) fn at_ends(readings: &[f64]) -> Vec<Range<usize>> {
    let least = readings.iter().copied().fold(f64::INFINITY, f64::min);
    let most = readings.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let repeats = |sample: usize| {
        sample > 0
            && alike(readings[sample - 1], readings[sample])
            && [least, most].iter().any(|end| alike(*end, readings[sample]))
    };
    rows_of(&(0..readings.len()).map(repeats).collect::<Vec<bool>>())
}

/// Whether readings have so much noise that equal ones are not real.
pub(crate) fn is_noisy(readings: &[f64]) -> bool {
    let most = readings.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let step = comb(readings).map_or(0.0, |comb| comb.step);
    let noise = noise(readings);
    noise > 0.0 && noise >= (TEETH * step).max(ROUNDING * most)
}

/// The differences of successive readings.
pub(crate) fn steps(readings: &[f64]) -> Vec<f64> {
    readings.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// The noise of readings, from their fourth differences, which contain no slow changes; zero if these are not larger than the
/// third differences.
fn noise(readings: &[f64]) -> f64 {
    let size = |values: &[f64]| {
        median(values.iter().map(|x| x.abs()).filter(|x| *x > 0.0)).unwrap_or_default()
    };
    let third = steps(&steps(&steps(readings)));
    let fourth = size(&steps(&third));
    // For white noise it has 70 times the variance.
    if fourth > size(&third) { fourth / 70.0_f64.sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sticking(readings: &[f64]) -> Vec<Range<usize>> {
        Sticking::of(readings, &vec![false; readings.len()]).rows
    }

    fn random(count: u32) -> Vec<f64> {
        (0..count).map(|at| (43_758.545 * f64::from(at + 1).sin()).fract()).collect()
    }

    #[test]
    fn rows_of_a_reading_that_sticks_are_found() {
        let mut readings = random(3000);
        // A rotating table changes the components of gravity by more than the noise.
        for (at, reading) in readings.iter_mut().enumerate() {
            *reading = 0.1 * *reading + 100.0 * (0.02 * at as f64).sin();
        }
        for row in [100..120, 2000..2001, 2500..2503] {
            let held = readings[row.start - 1];
            readings[row].fill(held);
        }
        assert_eq!(sticking(&readings), [100..120, 2000..2001, 2500..2503]);
    }

    /// A sensor with a new reading in every second sample repeats half of them and is not stuck, except if it repeats for
    /// long. One that repeats a few percent of its readings is as fast as the log, and is stuck wherever it repeats.
    #[test]
    fn a_sensor_slower_than_its_log_sticks_only_for_long() {
        let every = |samples: usize| -> Vec<f64> {
            let new = random(3000);
            (0..3000).map(|at| new[at / samples]).collect()
        };
        assert!(sticking(&every(2)).is_empty());
        let mut readings = every(2);
        let held = readings[1000];
        readings[1001..1002 + 2 * LONGEST].fill(held);
        let rows = sticking(&readings);
        let [row] = &rows[..] else { panic!("{rows:?}") };
        assert!(row.contains(&1001) && row.contains(&(1000 + 2 * LONGEST)), "{row:?}");

        // A tenth of all samples.
        let mut fast = every(1);
        let rows: Vec<_> = (1..149).map(|at| 20 * at..20 * at + 2).collect();
        for row in &rows {
            let held = fast[row.start - 1];
            fast[row.clone()].fill(held);
        }
        assert_eq!(sticking(&fast), rows);
    }

    #[test]
    fn what_is_coarse_smooth_or_cut_off_does_not_stick() {
        let noise = random(3000);
        let coarse = |step: f64| noise.iter().map(|x| (x / step).round() * step).collect();
        let smooth = |at: u32| if at < 300 { 0.0 } else { (0.01 * f64::from(at - 300)).sin() };
        let cut: Vec<f64> = noise.iter().map(|x| x.min(0.95)).collect();
        for readings in
            [noise.clone(), coarse(0.5), coarse(0.01), (0..3000).map(smooth).collect(), cut]
        {
            assert!(sticking(&readings).is_empty());
        }
    }
}
