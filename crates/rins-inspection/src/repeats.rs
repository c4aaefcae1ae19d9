//! Samples that are bitwise equal to the previous one, as delivered by a driver without new samples.

use std::ops::Range;

use rins_frames::Increments;

use crate::rows::{BEYOND_CHANCE, LONGEST, MOST, alike, rows_of};
use crate::sticking::{Sticking, at_ends, is_noisy};
use rins_motion::Recording;

/// The repeated samples in a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeats {
    /// The number of samples that equal the previous one.
    pub samples: usize,
    /// The number of spans of such samples.
    pub rows: usize,
    /// The expected number of such samples by chance.
    pub by_chance: f64,
    /// The channels, gyros and accelerometers x, y and z, that repeat while others change.
    pub alone: [bool; 6],
}

impl Repeats {
    /// Removes the samples in which all six readings, or those of one channel, equal those of the previous sample, as if they
    /// were lost: the first new sample after each span covers its time.
    ///
    /// `None`, without any change, if there are none, if coarse readings explain their number, or if they are so many or so
    /// long in succession that the cause is another one.
    pub fn take_out_of(recording: &mut Recording) -> Option<Self> {
        let is_together = repeats(recording);
        let together = rows_of(&is_together);
        let samples: usize = together.iter().map(Range::len).sum();
        let longest = together.iter().map(Range::len).max().unwrap_or_default();
        let mut by_chance = equal_by_chance(recording, &together);
        let few = (samples as f64) < MOST * recording.len() as f64 && longest <= LONGEST;
        let are_lost = few && (samples as f64) >= 1.0 + BEYOND_CHANCE * by_chance;
        let mut lost = if are_lost { is_together.clone() } else { vec![false; recording.len()] };
        let mut alone = [false; 6];
        for (channel, alone) in alone.iter_mut().enumerate() {
            let sticking = sticking(recording, channel, &is_together);
            let rows = sticking.rows.into_iter().filter(|row| row.len() <= LONGEST);
            for row in rows {
                *alone = true;
                lost[row].fill(true);
            }
            if *alone {
                by_chance += sticking.by_chance;
            }
        }
        let rows = rows_of(&lost);
        let samples: usize = rows.iter().map(Range::len).sum();
        if samples == 0 {
            return None;
        }
        for row in &rows {
            let lost: f64 = recording.increments[row.clone()].iter().map(|one| one.interval).sum();
            if let Some(after) = recording.increments.get_mut(row.end) {
                *after = after.rates().over(after.interval + lost);
            }
        }
        let stays: Vec<bool> = lost.iter().map(|lost| !lost).collect();
        let keep = |list: &mut Vec<f64>| retain(list, &stays);
        retain(&mut recording.increments, &stays);
        keep(&mut recording.times);
        [&mut recording.table_angle, &mut recording.table_rate, &mut recording.temperature]
            .into_iter()
            .flatten()
            .for_each(keep);
        Some(Self { samples, rows: rows.len(), by_chance, alone })
    }
}

/// The spans in which each channel is stuck for longer than a driver's delay, alone or with all others, the longest first.
pub(crate) fn stuck_for_long(recording: &Recording) -> [Vec<Range<usize>>; 6] {
    let together = repeats(recording);
    std::array::from_fn(|channel| {
        let mut rows = sticking(recording, channel, &together).rows;
        if together.contains(&true) && is_noisy(&of_channel(recording, channel)) {
            rows.extend(rows_of(&together));
        }
        rows.retain(|row| row.len() > LONGEST);
        rows.sort_by_key(|row| std::cmp::Reverse(row.len()));
        rows
    })
}

/// The spans in which a channel repeats its largest or smallest reading for as long, the longest first: it is stuck or
/// saturated there.
pub(crate) fn stuck_at_ends(recording: &Recording, channel: usize) -> Vec<Range<usize>> {
    let readings = of_channel(recording, channel);
    let mut rows = if is_noisy(&readings) { at_ends(&readings) } else { Vec::new() };
    rows.retain(|row| row.len() > LONGEST && row.len() + 1 < readings.len());
    rows.sort_by_key(|row| std::cmp::Reverse(row.len()));
    rows
}

fn sticking(recording: &Recording, channel: usize, together: &[bool]) -> Sticking {
    Sticking::of(&of_channel(recording, channel), together)
}

fn of_channel(recording: &Recording, channel: usize) -> Vec<f64> {
    recording.increments.iter().map(|sample| readings(sample)[channel]).collect()
}

/// Whether each sample equals the previous one.
fn repeats(recording: &Recording) -> Vec<bool> {
    let is_repeat = |sample: usize| {
        sample > 0 && {
            let pair = [sample - 1, sample].map(|at| readings(&recording.increments[at]));
            (0..6).all(|channel| same(pair, channel))
        }
    };
    (0..recording.len()).map(is_repeat).collect()
}

/// The expected number of samples that equal the previous one if the channels repeat independently, each as often as
/// elsewhere.
fn equal_by_chance(recording: &Recording, rows: &[Range<usize>]) -> f64 {
    let mut equal = [0.0; 6];
    let mut row = 0;
    let mut others = 0.0;
    for sample in 1..recording.len() {
        while rows.get(row).is_some_and(|row| row.end <= sample) {
            row += 1;
        }
        if rows.get(row).is_some_and(|row| row.contains(&sample)) {
            continue;
        }
        others += 1.0;
        let pair = [sample - 1, sample].map(|at| readings(&recording.increments[at]));
        for (channel, equal) in equal.iter_mut().enumerate() {
            *equal += f64::from(u8::from(same(pair, channel)));
        }
    }
    // One more of each: zero occurrences do not imply a probability of zero.
    let all = f64::max(others, 1.0);
    recording.len() as f64 * equal.iter().map(|count| (count + 1.0) / (all + 1.0)).product::<f64>()
}

fn readings(increments: &Increments) -> [f64; 6] {
    let rates = increments.rates();
    let (gyro, accel) = (rates.angular_rate.components(), rates.specific_force.components());
    [gyro.x, gyro.y, gyro.z, accel.x, accel.y, accel.z]
}

fn same([before, now]: [[f64; 6]; 2], channel: usize) -> bool {
    alike(before[channel], now[channel])
}

fn retain<T>(list: &mut Vec<T>, stays: &[bool]) {
    let mut stays = stays.iter();
    list.retain(|_| stays.next().copied().unwrap_or(true));
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_frames::InFrame;

    /// Readings of which none equals the previous one; `coarse` ones often do, in every channel.
    fn recording(coarse: bool) -> Recording {
        let reading = |sample: u32, channel: u32| {
            let x = f64::from((sample * 7919 + channel * 104_729) % 1009) / 1009.0;
            if coarse { (1.2 * x).floor() } else { x }
        };
        let sample = |sample: u32| {
            let of = |first: u32| {
                InFrame::new(
                    reading(sample, first),
                    reading(sample, first + 1),
                    reading(sample, first + 2),
                )
            };
            Increments { angle: of(0), velocity: of(3), interval: 0.01 }
        };
        Recording {
            times: (1..=2000).map(|at| 0.01 * f64::from(at)).collect(),
            increments: (0..2000).map(sample).collect(),
            table_angle: Some((0..2000).map(f64::from).collect()),
            ..Recording::default()
        }
    }

    #[test]
    fn repeated_samples_become_gaps() {
        let mut stuck = recording(false);
        for at in [300..303, 1200..1201] {
            for sample in at {
                stuck.increments[sample] = stuck.increments[sample - 1];
            }
        }
        let before = stuck.clone();
        let repeats = Repeats::take_out_of(&mut stuck).unwrap();
        assert_eq!((repeats.samples, repeats.rows, stuck.len()), (4, 2, 1996));
        assert!(repeats.by_chance < 1e-6);
        assert_eq!(stuck.table_angle.as_ref().unwrap()[300..302], [303.0, 304.0]);
        let after = &stuck.increments[300];
        assert!((after.interval - 0.04).abs() < 1e-12);
        let rate = |one: &Increments| *one.rates().angular_rate.components();
        assert!((rate(after) - rate(&before.increments[303])).norm() < 1e-12);
        assert_eq!(Repeats::take_out_of(&mut stuck), None);
    }

    #[test]
    fn a_channel_that_repeats_alone_is_taken_out_too() {
        let mut stuck = recording(false);
        let mut held = 0.0;
        for (sample, increments) in stuck.increments.iter_mut().enumerate() {
            if !(500..540).contains(&sample) {
                held = (43_758.545 * ((sample + 1) as f64).sin()).fract();
            }
            let others = *increments.velocity.components();
            increments.velocity = InFrame::new(others.x, held, others.z);
        }
        let repeats = Repeats::take_out_of(&mut stuck).unwrap();
        assert_eq!((repeats.samples, repeats.rows, stuck.len()), (40, 1, 1960));
        assert_eq!(repeats.alone, [false, false, false, false, true, false]);
    }

    #[test]
    fn what_is_coarse_or_without_noise_does_not_repeat() {
        let mut still = recording(false);
        let first = still.increments[0];
        still.increments[100..200].fill(first);
        for mut fine in [recording(false), recording(true), still] {
            let before = fine.clone();
            assert_eq!(Repeats::take_out_of(&mut fine), None);
            assert_eq!(fine, before);
        }
    }
}
