//! A single channel that repeats its reading while the others go on.

use std::ops::Range;

use crate::comb::comb;
use crate::median::median;

/// Readings whose noise is less than so many teeth of their comb, or than this part of the largest, say the same for long while
/// nothing happens.
const TEETH: f64 = 3.0;
const ROUNDING: f64 = 1e-9;

/// So many times as often as chance, ...
const BEYOND_CHANCE: f64 = 10.0;

/// ... but in no more than this share of all samples: then it is how the channel reads.
const MOST: f64 = 0.2;

/// The rows in which a channel sticks, and how many samples would repeat the one before by chance.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sticking {
    /// Each without the reading that it repeats.
    pub(crate) rows: Vec<Range<usize>>,
    pub(crate) by_chance: f64,
}

impl Sticking {
    /// Where `readings` repeat to within rounding, as `same` says, without those samples that are `passed` over; nowhere if they
    /// are coarse or without noise, if they repeat by chance, or if they are at the end of what the sensor reads.
    pub(crate) fn of(
        readings: &[f64],
        same: impl Fn(f64, f64) -> bool,
        passed: impl Fn(usize) -> bool,
    ) -> Self {
        let none = Self::default();
        let ends = readings.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| {
            (least.min(*x), most.max(*x))
        });
        let repeats = |sample: usize, back: usize| {
            sample >= back && same(readings[sample - back], readings[sample])
        };
        let counts = |sample: &usize| {
            let is_end = same(readings[*sample], ends.0) || same(readings[*sample], ends.1);
            !passed(*sample) && !is_end
        };
        let mut rows: Vec<Range<usize>> = Vec::new();
        for sample in (1..readings.len()).filter(counts).filter(|&sample| repeats(sample, 1)) {
            match rows.last_mut().filter(|row| row.end == sample) {
                Some(row) => row.end += 1,
                None => rows.push(sample..sample + 1),
            }
        }
        let samples = rows.iter().map(Range::len).sum::<usize>() as f64;
        if samples == 0.0 || samples > MOST * readings.len() as f64 {
            return none;
        }
        // By chance a reading is that before the last one as often. One more: that none was seen does not say that there is none.
        let alternates = |&sample: &usize| repeats(sample, 2) && !repeats(sample, 1);
        let by_chance = 1.0 + (2..readings.len()).filter(counts).filter(alternates).count() as f64;
        if samples < 1.0 + BEYOND_CHANCE * by_chance {
            return none;
        }
        // Without noise a row of equal readings may be what there was.
        let most = ends.0.abs().max(ends.1.abs());
        let step = comb(readings).map_or(0.0, |comb| comb.step);
        if noise(readings) < (TEETH * step).max(ROUNDING * most) {
            return none;
        }
        Self { rows, by_chance }
    }
}

/// The noise of readings: what their fourth differences are of, in which nothing is left of what is slow, or nothing if these are no
/// larger than the third.
fn noise(readings: &[f64]) -> f64 {
    let differences =
        |values: &[f64]| -> Vec<f64> { values.windows(2).map(|pair| pair[1] - pair[0]).collect() };
    let size = |values: &[f64]| {
        median(values.iter().map(|x| x.abs()).filter(|x| *x > 0.0)).unwrap_or_default()
    };
    let third = differences(&differences(&differences(readings)));
    let fourth = size(&differences(&third));
    // Of white noise it has 70 times the variance.
    if fourth > size(&third) { fourth / 70.0_f64.sqrt() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sticking(readings: &[f64]) -> Vec<Range<usize>> {
        #[expect(clippy::float_cmp, reason = "a repeated reading is the same to the last bit")]
        Sticking::of(readings, |a, b| a == b, |_| false).rows
    }

    fn random(count: u32) -> Vec<f64> {
        (0..count).map(|at| (43_758.545 * f64::from(at + 1).sin()).fract()).collect()
    }

    #[test]
    fn rows_of_a_reading_that_sticks_are_found() {
        let mut readings = random(3000);
        // A table that turns moves gravity by more than noise is.
        for (at, reading) in readings.iter_mut().enumerate() {
            *reading = 0.1 * *reading + 100.0 * (0.02 * at as f64).sin();
        }
        for row in [100..120, 2000..2001, 2500..2503] {
            let held = readings[row.start - 1];
            readings[row].fill(held);
        }
        assert_eq!(sticking(&readings), [100..120, 2000..2001, 2500..2503]);
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
