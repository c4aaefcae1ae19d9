//! Whether what was written is read as the same.

use nalgebra::Vector3;
use rins_frames::Increments;
use rins_motion::Recording;

use super::LogFile;

/// How far a signal that was written and read is from what it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// The signal, with its unit.
    pub signal: &'static str,
    /// How many numbers differ.
    pub numbers: usize,
    /// By how much at most, in SI units; infinite if some are missing.
    pub largest: f64,
}

/// What is not the same to the last bit. `commanded` is the table rate that a profile tells.
pub(super) fn differences(
    old: &Recording,
    new: &Recording,
    commanded: Option<&[f64]>,
    format: LogFile,
) -> Vec<Difference> {
    // EuRoC's stamps are counted again from a whole second near the first of them.
    let origin = match (old.times.first(), new.times.first()) {
        (Some(old), Some(new)) if format == LogFile::Euroc => (old - new).round(),
        _ => 0.0,
    };
    let times: Vec<f64> = new.times.iter().map(|time| time + origin).collect();
    let of = |run: &Recording, part: fn(&Increments) -> Vector3<f64>| -> Vec<f64> {
        run.increments.iter().map(part).flat_map(|v| [v.x, v.y, v.z]).collect()
    };
    let intervals = |run: &Recording| -> Vec<f64> {
        run.increments.iter().map(|sample| sample.interval).collect()
    };
    let angle = |sample: &Increments| *sample.angle.components();
    let velocity = |sample: &Increments| *sample.velocity.components();
    let mut all = vec![
        difference("time [s]", &old.times, &times),
        difference("interval [s]", &intervals(old), &intervals(new)),
        difference("angle [rad]", &of(old, angle), &of(new, angle)),
        difference("velocity [m/s]", &of(old, velocity), &of(new, velocity)),
    ];
    let list = |list: Option<&Vec<f64>>| list.cloned().unwrap_or_default();
    if format.holds_more_than_the_imu() {
        let (angle, new_angle) = (list(old.table_angle.as_ref()), list(new.table_angle.as_ref()));
        all.push(difference("table angle [rad]", &angle, &new_angle));
        let temperatures = [old, new].map(|run| list(run.temperature.as_ref()));
        all.push(difference("temperature [degC]", &temperatures[0], &temperatures[1]));
    }
    let rate = commanded.or(old.table_rate.as_deref());
    if let Some(rate) = rate.filter(|_| commanded.is_some() || format.holds_more_than_the_imu()) {
        all.push(difference("table rate [rad/s]", rate, &list(new.table_rate.as_ref())));
    }
    all.into_iter().flatten().collect()
}

fn difference(signal: &'static str, old: &[f64], new: &[f64]) -> Option<Difference> {
    let off = old.iter().zip(new).map(|(old, new)| (new - old).abs());
    let (mut numbers, mut largest) = (old.len().abs_diff(new.len()), 0.0_f64);
    if numbers > 0 {
        largest = f64::INFINITY;
    }
    for off in off.filter(|off| *off > 0.0) {
        numbers += 1;
        largest = largest.max(off);
    }
    (numbers > 0).then_some(Difference { signal, numbers, largest })
}
