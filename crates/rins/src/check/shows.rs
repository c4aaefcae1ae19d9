//! The information in a run: the commands that can use it, and the parameters that are observable.

use rins_frames::units::DEG;
use rins_inspection::Inspection;
use rins_io::Loaded;
use rins_motion::Recording;

use super::inspected::{extremes, longest};

/// The shortest static interval that is used for alignment \[s\].
const SHORTEST_REST: f64 = 5.0;

/// The span over which a rate is tested for constancy \[s\]; the next constant is the tolerance for the difference of its halves.
const STRETCH: f64 = 4.0;
const STEADY: f64 = 0.02;

/// Rates with a smaller difference \[rad/s\], or a smaller difference relative to the larger, count as equal.
const APART: f64 = 0.1 * DEG;
const APART_RELATIVE: f64 = 0.1;

/// The smallest temperature range from which temperature dependence is observable \[K\].
const LEAST_WARMING: f64 = 5.0;

/// The information in the run, one sentence per item.
pub(super) fn shows(inspection: &Inspection, loaded: &Loaded) -> Vec<String> {
    let mut found = Vec::new();
    let rest = longest(inspection).map_or(0.0, |rest| rest.mean.duration);
    if rest >= SHORTEST_REST {
        let north = if inspection.earth_rate_visible { " and azimuth" } else { ", not azimuth" };
        found.push(format!("rins align: tilt{north}, over a static interval of {rest:.0} s"));
    }
    let recording = &loaded.recording;
    if recording.table_angle.is_some() || recording.table_rate.is_some() {
        let rates = steady_rates(recording);
        let words: Vec<String> = rates.iter().map(|rate| format!("{:.2}", rate / DEG)).collect();
        let at = words.join(", ");
        match rates.len() {
            0 => {}
            1 => found.push(format!(
                "rins calibrate: at one rate, {at} deg/s, gyro misalignments and scale error about the spin axis only in \
                 combination with the gyro biases"
            )),
            _ => found.push(format!(
                "rins calibrate: the rates {at} deg/s distinguish gyro misalignments and scale error about the spin axis from \
                 the gyro biases"
            )),
        }
    }
    let warming = recording.temperature.as_deref().map_or(0.0, |list| {
        let (least, most) = extremes(list);
        most - least
    });
    if warming >= LEAST_WARMING {
        found.push(format!("how errors change with temperature, over {warming:.1} K"));
    }
    found
}

/// The distinct constant rates about the spin axis, except zero \[rad/s\].
pub(crate) fn steady_rates(recording: &Recording) -> Vec<f64> {
    let mut rates: Vec<f64> = Vec::new();
    let mut halves = [(0.0, 0.0); 2];
    for sample in &recording.increments {
        let half = &mut halves[usize::from(halves[0].1 >= STRETCH / 2.0)];
        half.0 += sample.angle.components().z;
        half.1 += sample.interval;
        if halves[0].1 + halves[1].1 < STRETCH {
            continue;
        }
        let [before, after] = halves.map(|(angle, time)| angle / time);
        halves = [(0.0, 0.0); 2];
        let rate = before.midpoint(after);
        let apart =
            |a: f64, b: f64| (a - b).abs() > APART.max(APART_RELATIVE * a.abs().max(b.abs()));
        let steady = (before - after).abs() < STEADY * rate.abs();
        if steady && rate.abs() > APART && rates.iter().all(|known| apart(*known, rate)) {
            rates.push(rate);
        }
    }
    rates
}
