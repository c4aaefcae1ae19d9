//! What a recording holds, and what looks wrong with it.

use std::ops::Range;

use nalgebra::Vector3;
use rins_frames::EARTH_RATE;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, STANDARD_GRAVITY};

use crate::recording::Recording;
use crate::rest::{RestMean, rest_spans};
use crate::station::Station;

/// An interval that is longer than the median by this factor is a gap.
const GAP_RATIO: f64 = 1.5;

/// How far a ratio may be from a suspected factor: a sensor as it comes from the factory may be off
/// by ten percent and more, a wrong unit by seven times at least.
const FACTOR_WITHIN: f64 = 0.2;

/// The shortest rest that is reported \[s\].
const SHORTEST_REST: f64 = 1.0;

/// A mean rate at rest up to this many times the Earth's still shows the Earth's.
const EARTH_RATE_VISIBLE: f64 = 2.0;

/// The names of the six channels, in the order of every list here.
pub const CHANNELS: [&str; 6] = ["gyro.x", "gyro.y", "gyro.z", "accel.x", "accel.y", "accel.z"];

/// How regularly samples came.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// The median interval \[s\].
    pub interval: f64,
    /// The root mean square of the intervals' distance from it, gaps left out \[s\].
    pub jitter: f64,
    /// The intervals that are longer by half or more: index and length \[s\].
    pub gaps: Vec<(usize, f64)>,
}

/// What was seen in a stretch of rest.
#[derive(Clone, Debug, PartialEq)]
pub struct RestSeen {
    /// The samples.
    pub span: Range<usize>,
    /// The means over them.
    pub mean: RestMean,
}

/// A mistake that the data point to, and the factor or sign by which they do.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Suspicion {
    /// The specific force at rest is not gravity.
    Gravity {
        /// Its magnitude at rest \[m/s²\].
        seen: f64,
        /// What the station has \[m/s²\].
        expected: f64,
        /// The mistake that would explain it.
        cause: Option<&'static str>,
    },
    /// The turn that the gyro counts is not the table's.
    SpinScale {
        /// The gyro's turn over the table's.
        ratio: f64,
        /// The mistake that would explain it.
        cause: Option<&'static str>,
    },
    /// Another axis than z counts the table's turn.
    SpinAxis {
        /// The channel that follows the table.
        channel: &'static str,
        /// Its turn over the table's.
        ratio: f64,
    },
    /// A channel repeats one value throughout.
    StuckChannel {
        /// The channel.
        channel: &'static str,
    },
}

/// What a recording holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspection {
    /// How regularly samples came.
    pub timing: Timing,
    /// When the IMU stood still.
    pub rests: Vec<RestSeen>,
    /// How many turns were made about body z, forwards and backwards added up.
    pub turns: f64,
    /// For each channel the step between neighbouring readings, if there are few of them (SI units of an increment).
    pub resolution: [Option<f64>; 6],
    /// For each channel the longest run of equal readings.
    pub longest_repeat: [usize; 6],
    /// Whether the mean rate at rest is near enough to the Earth's to show it.
    pub earth_rate_visible: bool,
    /// What looks wrong.
    pub suspicions: Vec<Suspicion>,
}

/// Looks through a recording; `station` tells what gravity to expect.
pub fn inspect(recording: &Recording, station: Option<&Station>) -> Inspection {
    let channels: [Vec<f64>; 6] = std::array::from_fn(|channel| {
        recording.increments.iter().map(|sample| reading(sample, channel)).collect()
    });
    let rests: Vec<RestSeen> = rest_spans(recording, SHORTEST_REST)
        .into_iter()
        .filter_map(|span| {
            RestMean::of(recording, span.clone()).map(|mean| RestSeen { span, mean })
        })
        .collect();
    let longest_repeat = std::array::from_fn(|channel| longest_repeat(&channels[channel]));
    let mut suspicions: Vec<Suspicion> = (0..6)
        .filter(|&channel| !recording.is_empty() && longest_repeat[channel] == recording.len())
        .map(|channel| Suspicion::StuckChannel { channel: CHANNELS[channel] })
        .collect();
    let timing = timing(recording);
    suspicions.extend(station.and_then(|station| gravity_suspicion(&rests, station, &timing)));
    suspicions.extend(spin_suspicion(recording, &timing));
    Inspection {
        turns: recording.increments.iter().map(|s| s.angle.components().z.abs()).sum::<f64>()
            / std::f64::consts::TAU,
        resolution: std::array::from_fn(|channel| resolution(&channels[channel])),
        longest_repeat,
        earth_rate_visible: rests
            .iter()
            .any(|rest| rest.mean.rates.angular_rate.norm() < EARTH_RATE_VISIBLE * EARTH_RATE),
        rests,
        timing,
        suspicions,
    }
}

fn reading(sample: &rins_frames::Increments, channel: usize) -> f64 {
    if channel < 3 {
        sample.angle.components()[channel]
    } else {
        sample.velocity.components()[channel - 3]
    }
}

fn timing(recording: &Recording) -> Timing {
    let mut sorted: Vec<f64> = recording.increments.iter().map(|sample| sample.interval).collect();
    sorted.sort_by(f64::total_cmp);
    let interval = sorted.get(sorted.len() / 2).copied().unwrap_or_default();
    let mut gaps = Vec::new();
    let (mut square, mut count) = (0.0, 0.0_f64);
    for (index, sample) in recording.increments.iter().enumerate() {
        if sample.interval > GAP_RATIO * interval {
            gaps.push((index, sample.interval));
        } else {
            square += (sample.interval - interval).powi(2);
            count += 1.0;
        }
    }
    Timing { interval, jitter: (square / count.max(1.0)).sqrt(), gaps }
}

fn longest_repeat(readings: &[f64]) -> usize {
    let mut longest = 0;
    let mut run = 0;
    let mut last = f64::NAN;
    for &reading in readings {
        #[expect(clippy::float_cmp, reason = "a repeated reading is the same to the last bit")]
        let same = reading == last;
        run = if same { run + 1 } else { 1 };
        longest = longest.max(run);
        last = reading;
    }
    longest
}

/// The least step between distinct readings, if most readings are shared by several samples.
fn resolution(readings: &[f64]) -> Option<f64> {
    let mut sorted = readings.to_vec();
    sorted.sort_by(f64::total_cmp);
    let range = sorted.last()? - sorted.first()?;
    // Readings that differ by rounding only are one.
    let same = 1e-9 * range;
    let steps: Vec<f64> =
        sorted.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > same).collect();
    let distinct = steps.len() + 1;
    (distinct > 1 && distinct * 4 < readings.len())
        .then(|| steps.iter().copied().fold(f64::INFINITY, f64::min))
}

fn gravity_suspicion(rests: &[RestSeen], station: &Station, timing: &Timing) -> Option<Suspicion> {
    let longest = rests.iter().max_by(|a, b| a.mean.duration.total_cmp(&b.mean.duration))?;
    let (seen, expected) = (longest.mean.rates.specific_force.norm(), station.gravity);
    let cause = named_factor(
        seen / expected,
        &[
            (1.0, ""),
            (STANDARD_GRAVITY, "readings in m/s^2 were declared as g"),
            (1.0 / STANDARD_GRAVITY, "readings in g were declared as m/s^2"),
            (1e3, "readings in mg were declared as g"),
            (1e-3, "readings in g were declared as mg"),
            (timing.interval, "velocity increments were declared as specific force"),
            (1.0 / timing.interval, "specific force was declared as velocity increments"),
        ],
    );
    (cause != Some("")).then_some(Suspicion::Gravity { seen, expected, cause })
}

fn spin_suspicion(recording: &Recording, timing: &Timing) -> Option<Suspicion> {
    let table: Vec<f64> = match (&recording.table_angle, &recording.table_rate) {
        (Some(angle), _) => angle.windows(2).map(|pair| pair[1] - pair[0]).collect(),
        (None, Some(rate)) => {
            let turns = rate.iter().zip(&recording.increments).skip(1);
            turns.map(|(rate, sample)| rate * sample.interval).collect()
        }
        (None, None) => return None,
    };
    // Regression of each gyro on the table, sample by sample; a table at rest says nothing.
    let square: f64 = table.iter().map(|turn| turn * turn).sum();
    let turned: f64 = table.iter().map(|turn| turn.abs()).sum();
    if turned < DEG {
        return None;
    }
    let mut product = Vector3::zeros();
    for (sample, turn) in recording.increments.iter().skip(1).zip(&table) {
        product += sample.angle.components() * *turn;
    }
    let ratio = product / square;
    let axis = ratio.iamax();
    // A sensor whose z axis follows the table at all does so best, whatever its unit.
    if axis != 2 && ratio[axis].abs() > 10.0 * ratio.z.abs() {
        return Some(Suspicion::SpinAxis { channel: CHANNELS[axis], ratio: ratio[axis] });
    }
    let cause = named_factor(
        ratio.z,
        &[
            (1.0, ""),
            (-1.0, "the table's sense is opposite to the gyro's"),
            (1.0 / DEG, "readings in deg were declared as rad, or the table's unit is wrong"),
            (DEG, "readings in rad were declared as deg, or the table's unit is wrong"),
            (DEG / DEG_PER_HOUR, "readings in deg/h were declared as deg/s"),
            (DEG_PER_HOUR / DEG, "readings in deg/s were declared as deg/h"),
            (1.0 / ARCSEC, "readings in arcsec were declared as rad"),
            (timing.interval, "angle increments were declared as rates"),
            (1.0 / timing.interval, "rates were declared as angle increments"),
        ],
    );
    (cause != Some("")).then_some(Suspicion::SpinScale { ratio: ratio.z, cause })
}

fn named_factor(ratio: f64, causes: &[(f64, &'static str)]) -> Option<&'static str> {
    causes
        .iter()
        .find(|(factor, _)| (ratio / factor - 1.0).abs() < FACTOR_WITHIN)
        .map(|(_, cause)| *cause)
}
