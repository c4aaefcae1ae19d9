//! Errors of single channels: resolution, repeats, spikes and clipping.

use rins_frames::Increments;

use super::expected::{CHANNELS, Expected};
use super::suspicion::Suspicion;
use crate::quantization_grid::{QuantizationGrid, alike, comb};
use crate::sticking::steps;
use rins_motion::{Recording, median};

/// The ratio of a spike to the robust scatter of the differences between successive readings ...
const SPIKE_RATIO: f64 = 50.0;

/// ... and to the largest difference nearby: an impact has other differences beside it ...
const SPIKE_ALONE: f64 = 10.0;

/// ... and to the excursions of single samples that more than one in so many samples exceeds: those are noise, as of a coarse sensor
/// whose readings were rounded once more ...
const RARE: usize = 100;

/// ... unless at most this number of readings are so large, and the tail of the others predicts more than this number of
/// them: noise with heavy tails has a largest reading too.
const OF_TAIL: (usize, f64) = (2, 1e-3);

/// The number of largest values from which the tail is extrapolated.
const TAIL: usize = 32;

/// The ratio to its scatter from which a reading belongs to the spike of another sensor.
const BESIDE: f64 = 6.0;

/// The number of samples on each side that are nearby.
const NEARBY: usize = 25;

/// A span of equal extreme readings is clipped if the expected number of such spans by chance is below this.
const LEAST_CHANCE: f64 = 1e-9;

/// If a sensor is so coarse that it repeats more than this fraction of its readings, equal readings may be a constant rate.
const MOST_REPEATS: f64 = 0.2;

/// The shortest span of equal readings that is clipped.
const SHORTEST_TOP: usize = 5;

/// A reading with fewer changes away from it may be a clipped one that noise interrupts.
const LEAST_LEAVINGS: usize = 20;

/// The errors of the six channels, one at a time. `stands` marks the samples in static intervals.
pub(super) fn suspicions(
    recording: &Recording,
    expected: &Expected,
    stands: &[bool],
) -> Vec<Suspicion> {
    let mut found = Vec::new();
    let channels: Vec<Vec<f64>> = (0..CHANNELS.len()).map(|of| readings(recording, of)).collect();
    let mut alone = Vec::new();
    for (channel, name) in CHANNELS.into_iter().enumerate() {
        let readings = &channels[channel];
        let range = if channel < 3 { expected.gyro.range } else { expected.accel.range };
        if let Some(spikes) = spikes(readings) {
            alone.push((channel, spikes));
        }
        let cut = range.and_then(|range| saturated(readings, range, name, recording));
        found.extend(cut.or_else(|| flat_top(readings, stands, name, recording)));
    }
    if is_jolt(&alone, &channels) {
        return found;
    }
    found.extend(alone.iter().map(|(channel, spikes)| Suspicion::Spike {
        channel: CHANNELS[*channel],
        count: spikes.count,
        time: recording.times[spikes.largest],
        reading: channels[*channel][spikes.largest],
    }));
    found
}

/// The readings of a channel as mean rates \[rad/s\] or specific forces \[m/s²\].
fn readings(recording: &Recording, channel: usize) -> Vec<f64> {
    let of_sample = |sample: &Increments| {
        let rates = sample.rates();
        if channel < 3 {
            rates.angular_rate.components()[channel]
        } else {
            rates.specific_force.components()[channel - 3]
        }
    };
    recording.increments.iter().map(of_sample).collect()
}

/// Single readings of a channel far outside of the previous and the next ones.
#[derive(Clone, Copy, Debug)]
struct Spikes {
    count: usize,
    /// The sample of the largest one.
    largest: usize,
}

/// Whether the only spikes are those of gyros in the same samples, of both x and y, or of one of these while the other has a
/// smaller one too: a tilt step of the base within an epoch, which also rotates about the axis unless that is vertical. A
/// damaged line of a log, or a faulty sensor, affects other channels or one alone.
fn is_jolt(found: &[(usize, Spikes)], channels: &[Vec<f64>]) -> bool {
    let Some(&(_, first)) = found.first() else { return false };
    let at_once = |&(channel, spikes): &(usize, Spikes)| {
        channel < 3 && (spikes.count, spikes.largest) == (first.count, first.largest)
    };
    let across: Vec<usize> =
        found.iter().map(|(channel, _)| *channel).filter(|channel| *channel < 2).collect();
    let is_shown = |channel: usize| {
        let steps = steps(&channels[channel]);
        let Some(scatter) = scatter(&channels[channel], &steps) else { return false };
        let least = BESIDE * scatter;
        let out = |at: usize| steps.get(at).is_some_and(|step| step.abs() > least);
        out(first.largest - 1) && out(first.largest)
    };
    found.iter().all(at_once)
        && match across[..] {
            [_, _] => true,
            [one] => first.count == 1 && is_shown(1 - one),
            _ => false,
        }
}

/// The robust scatter of the differences of readings; `None` if all are equal.
fn scatter(readings: &[f64], steps: &[f64]) -> Option<f64> {
    let alike = alike(readings);
    let sizes = || steps.iter().map(|step| step.abs());
    let usual = 1.4826 * median(sizes())?;
    // A coarse sensor often repeats a reading; then its smallest difference is the scatter.
    let coarse = sizes().filter(|size| *size > alike).min_by(f64::total_cmp)?;
    Some(if usual > alike { usual } else { coarse })
}

pub(super) fn longest_repeat(readings: &[f64]) -> usize {
    runs(readings).map(|(_, length)| length).max().unwrap_or_default()
}

/// The largest ratio of the steps of two equal grids.
const SAME_COMB: f64 = 1.1;

/// The resolution of increments: their own, or that of the rates from which they were calculated with unequal intervals,
/// times the mean interval. It is the larger of the two, since products of two rounded numbers have a grid that is far too
/// fine; if both are nearly equal, it is the more precise one.
pub(super) fn resolution_of(
    increments: &[f64],
    recording: &Recording,
    interval: f64,
) -> Option<f64> {
    let samples = increments.iter().zip(&recording.increments);
    let over_one: Vec<f64> =
        samples.map(|(increment, sample)| increment / sample.interval * interval).collect();
    let found = match [increments, &over_one].map(resolution) {
        [Some(of_increments), Some(of_rates)] => {
            let [less, more] = if of_increments.step < of_rates.step {
                [of_increments, of_rates]
            } else {
                [of_rates, of_increments]
            };
            let same = more.step < SAME_COMB * less.step;
            if same && less.sigma < more.sigma { less } else { more }
        }
        [of_increments, of_rates] => of_increments.or(of_rates)?,
    };
    Some(found.step)
}

/// The grid of readings, if most of its values are shared by several samples: the digits of a log are not the resolution of a
/// sensor.
fn resolution(readings: &[f64]) -> Option<QuantizationGrid> {
    let comb = comb(readings)?;
    let mut sorted = readings.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let teeth = 1 + sorted.windows(2).filter(|pair| pair[1] - pair[0] > 0.5 * comb.step).count();
    (4 * teeth < readings.len()).then_some(comb)
}

/// The spans of equal readings: start and length.
fn runs(readings: &[f64]) -> impl Iterator<Item = (usize, usize)> {
    let mut start = 0;
    readings
        .chunk_by(|a, b| {
            #[expect(clippy::float_cmp, reason = "a repeated reading is the same to the last bit")]
            let same = a == b;
            same
        })
        .map(move |run| {
            let first = start;
            start += run.len();
            (first, run.len())
        })
}

fn spikes(readings: &[f64]) -> Option<Spikes> {
    let steps = steps(readings);
    let scatter = scatter(readings, &steps)?;
    let most = readings.iter().fold(0.0, |most: f64, reading| most.max(reading.abs()));
    let sizes: Vec<f64> = steps.windows(2).map(|pair| there_and_back([pair[0], pair[1]])).collect();
    // The rounding error of readings without noise is not a scatter.
    let least = (SPIKE_RATIO * scatter)
        .max(1e-9 * most)
        .max(SPIKE_ALONE * exceeded_by_one_in(RARE, &sizes));
    let alone = |index: usize, size: f64| {
        let nearby = index.saturating_sub(NEARBY)..(index + 1 + NEARBY).min(steps.len());
        nearby.filter(|&other| other + 1 != index && other != index).all(|other| {
            // Differences next to another spike are not part of the motion.
            steps[other].abs() * SPIKE_ALONE < size || is_spike(&steps, other, least)
        })
    };
    let mut count = 0;
    let mut largest = (0.0, 0);
    for (before, &size) in sizes.iter().enumerate() {
        let index = before + 1;
        if size > least && alone(index, size) {
            count += 1;
            if size > largest.0 {
                largest = (size, index);
            }
        }
    }
    let is_tail = || count <= OF_TAIL.0 && expected_beyond(largest.0, sizes, least) > OF_TAIL.1;
    (count > 0 && !is_tail()).then_some(Spikes { count, largest: largest.1 })
}

/// The value that one in `count` of the values exceeds; zero if there are none.
fn exceeded_by_one_in(count: usize, values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    let beyond = values.len() / count;
    match (values.len() - beyond).checked_sub(1) {
        Some(place) => *values.select_nth_unstable_by(place, f64::total_cmp).1,
        None => 0.0,
    }
}

/// The expected number of values beyond `size`, from the largest of those below `least` and a power-law tail (‹hill1975›).
fn expected_beyond(size: f64, mut sizes: Vec<f64>, least: f64) -> f64 {
    sizes.retain(|other| *other < least);
    sizes.sort_unstable_by(|a, b| b.total_cmp(a));
    sizes.truncate(TAIL + 1);
    let Some(smallest) = sizes.pop().filter(|smallest| *smallest > 0.0) else { return 0.0 };
    let count = sizes.len() as f64;
    let mean = sizes.iter().map(|other| (other / smallest).ln()).sum::<f64>() / count;
    count * (-(size / smallest).ln() / mean).exp()
}

/// The size of two successive steps that cancel; zero if they do not.
fn there_and_back([there, back]: [f64; 2]) -> f64 {
    let size = there.abs().min(back.abs());
    if (there + back).abs() < 0.2 * size { size } else { 0.0 }
}

/// Whether the step is one of the two of a spike.
fn is_spike(steps: &[f64], index: usize, least: f64) -> bool {
    let is = |a: f64, b: f64| there_and_back([a, b]) > least;
    let before = index.checked_sub(1).is_some_and(|before| is(steps[before], steps[index]));
    before || steps.get(index + 1).is_some_and(|after| is(steps[index], *after))
}

fn saturated(
    readings: &[f64],
    range: f64,
    channel: &'static str,
    recording: &Recording,
) -> Option<Suspicion> {
    // A nominal range differs from the largest possible count.
    let beyond = |reading: &f64| reading.abs() >= range * (1.0 - 1e-3);
    let first = readings.iter().position(beyond)?;
    let count = readings.iter().filter(|reading| beyond(reading)).count();
    Some(Suspicion::Saturated { channel, count, time: recording.times[first], range })
}

/// Whether a reading is that of a constant rate between two values of a coarse sensor: it changes repeatedly to an adjacent
/// value and back, and hardly ever further.
fn stands_between(readings: &[f64], extreme: f64) -> bool {
    let Some(step) = resolution(readings).map(|comb| comb.step) else { return false };
    #[expect(clippy::float_cmp, reason = "it is one of the readings")]
    let leaving = readings.windows(2).filter(|pair| pair[0] == extreme && pair[1] != extreme);
    let (mut all, mut to_next) = (0, 0);
    for pair in leaving {
        all += 1;
        to_next += usize::from((pair[1] - pair[0]).abs() < 1.5 * step);
    }
    all >= LEAST_LEAVINGS && 10 * to_next >= 9 * all
}

/// Clipping: the largest or the smallest reading, repeated during motion more often than any other reading.
fn flat_top(
    readings: &[f64],
    stands: &[bool],
    channel: &'static str,
    recording: &Recording,
) -> Option<Suspicion> {
    let least = readings.iter().copied().fold(f64::INFINITY, f64::min);
    let most = readings.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    #[expect(clippy::float_cmp, reason = "they are the very readings")]
    let extreme = |index: usize| readings[index] == least || readings[index] == most;
    let (mut repeats, mut others) = (0.0, 0.0_f64);
    let mut top = (0, 0);
    for (start, length) in runs(readings) {
        if !extreme(start) {
            repeats += (length - 1) as f64;
            others += length as f64;
        } else if length > top.1 && !stands[start..start + length].contains(&true) {
            top = (start, length);
        }
    }
    let (start, count) = top;
    // A channel with few other readings than its extremes is stuck or free of noise.
    if count < SHORTEST_TOP || others < 0.1 * readings.len() as f64 {
        return None;
    }
    // One repeat more than observed: zero occurrences do not imply a probability of zero.
    let chance = (repeats + 1.0) / others;
    if chance > MOST_REPEATS {
        return None;
    }
    let by_chance = readings.len() as f64 * chance.powf((count - 1) as f64);
    let is_cut = by_chance < LEAST_CHANCE && !stands_between(readings, readings[start]);
    is_cut.then(|| Suspicion::FlatTop {
        channel,
        count,
        time: recording.times[start],
        reading: readings[start],
    })
}
