//! The inspection of a log against the statements of its rig file.

use rins_frames::units::DEG;
use rins_inspection::{Expected, ExpectedAxis, ExpectedTriad, Inspection, RestSeen, inspect_with};
use rins_io::Loaded;
use rins_report::number::figure;

use super::units::said_units;
use crate::log::static_intervals;

/// The maximum number of gaps and static intervals that are listed individually.
pub(super) const LISTED: usize = 12;

/// Inspects a run against the statements of its rig file.
pub(crate) fn inspected(loaded: &Loaded) -> Inspection {
    let rig = &loaded.rig;
    let units = said_units(&rig.log);
    let triad = |spec: Option<rins_imu::TriadSpec>, unit| ExpectedTriad {
        bias_sigma: spec.map(|spec| spec.bias_sigma),
        range: spec.and_then(|spec| spec.range),
        unit,
    };
    let axis = |attitude: rins_io::InitialAttitude| ExpectedAxis {
        angles: attitude.angles,
        sigma: attitude.sigma,
    };
    let expected = Expected {
        station: Some(loaded.station),
        axis: rig.attitude.map(axis),
        table_latency: rig.log.table_angle().and_then(|angle| angle.latency).unwrap_or_default(),
        table_unit: units.table,
        gyro: triad(rig.imu.map(|imu| imu.gyro), units.gyro),
        accel: triad(rig.imu.map(|imu| imu.accel), units.accel),
    };
    // The rig file and its readers name sensors by their own axes.
    inspect_with(&loaded.recording, &expected, static_intervals(loaded)).along_own(&rig.spin.into())
}

pub(super) fn gaps(inspection: &Inspection, loaded: &Loaded) -> String {
    let timing = &inspection.timing;
    let mut gaps = timing.gaps.clone();
    let Some(longest) = gaps.iter().map(|(_, length)| *length).reduce(f64::max) else {
        return "none".into();
    };
    // If there are too many, the longest are listed.
    let more = if gaps.len() > LISTED { ", ..." } else { "" };
    if gaps.len() > LISTED {
        gaps.sort_by(|a, b| b.1.total_cmp(&a.1));
    }
    let at: Vec<String> = gaps
        .iter()
        .take(LISTED)
        .map(|(index, _)| format!("{:.3}", loaded.recording.times[*index]))
        .collect();
    let single = gaps.iter().filter(|(_, length)| *length < 2.5 * timing.interval).count();
    format!(
        "{}, {single} of them one lost sample; the longest {:.1} ms; at {}{more} s",
        gaps.len(),
        longest * 1e3,
        at.join(", ")
    )
}

pub(super) fn longest(inspection: &Inspection) -> Option<&RestSeen> {
    inspection.rests.iter().max_by(|a, b| a.mean.duration.total_cmp(&b.mean.duration))
}

pub(super) fn step_in_words(channel: usize, step: f64) -> String {
    if channel < 3 {
        format!("{} arcsec", figure(step / DEG * 3600.0, 4))
    } else {
        format!("{} mm/s", figure(step * 1e3, 4))
    }
}

pub(super) fn extremes(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &value| {
        (least.min(value), most.max(value))
    })
}
