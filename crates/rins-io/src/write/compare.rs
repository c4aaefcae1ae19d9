//! Comparison of a written log with the original recording.

use rins_frames::Increments;
use rins_motion::Recording;

use super::LogFile;

/// The difference of a signal after writing and reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// The signal, with its unit.
    pub signal: &'static str,
    /// The number of numbers that differ.
    pub numbers: usize,
    /// The largest difference, in SI units; infinite if numbers are missing.
    pub largest: f64,
}

/// The signals that are not bit-identical. `commanded` is the table rate of the profile.
pub(super) fn differences(
    old: &Recording,
    new: &Recording,
    commanded: Option<&[f64]>,
    format: LogFile,
) -> Vec<Difference> {
    // EuRoC stamps get a new origin, an integer second near the first of them.
    let origin = match (old.times.first(), new.times.first()) {
        (Some(old), Some(new)) if format == LogFile::Euroc => (old - new).round(),
        _ => 0.0,
    };
    let times = new.times.iter().map(|time| time + origin);
    let mut all = vec![
        difference("time [s]", old.times.iter().copied(), times),
        between("interval [s]", [old, new], |sample| [sample.interval]),
        between("angle [rad]", [old, new], |sample| (*sample.angle.components()).into()),
        between("velocity [m/s]", [old, new], |sample| (*sample.velocity.components()).into()),
    ];
    let list = |signal, old: Option<&[f64]>, new: Option<&Vec<f64>>| {
        let [old, new] = [old, new.map(Vec::as_slice)].map(Option::unwrap_or_default);
        difference(signal, old.iter().copied(), new.iter().copied())
    };
    if format.holds_more_than_the_imu() {
        let angle = old.table_angle.as_deref();
        all.push(list("table angle [rad]", angle, new.table_angle.as_ref()));
        let temperature = old.temperature.as_deref();
        all.push(list("temperature [degC]", temperature, new.temperature.as_ref()));
    }
    let rate = commanded.or(old.table_rate.as_deref());
    if rate.is_some() && (commanded.is_some() || format.holds_more_than_the_imu()) {
        all.push(list("table rate [rad/s]", rate, new.table_rate.as_ref()));
    }
    all.into_iter().flatten().collect()
}

/// The difference of a part of each sample.
fn between<const N: usize>(
    signal: &'static str,
    runs: [&Recording; 2],
    part: fn(&Increments) -> [f64; N],
) -> Option<Difference> {
    let [old, new] = runs.map(|run| run.increments.iter().flat_map(part));
    difference(signal, old, new)
}

fn difference(
    signal: &'static str,
    mut old: impl Iterator<Item = f64>,
    mut new: impl Iterator<Item = f64>,
) -> Option<Difference> {
    let (mut numbers, mut largest) = (0, 0.0_f64);
    loop {
        let off = match (old.next(), new.next()) {
            (None, None) => break,
            (Some(old), Some(new)) => (new - old).abs(),
            // One of the signals is missing.
            _ => f64::INFINITY,
        };
        if off > 0.0 {
            numbers += 1;
            largest = largest.max(off);
        }
    }
    (numbers > 0).then_some(Difference { signal, numbers, largest })
}
