//! The content of a log as rows of tables.

use rins_frames::units::{DEG, DEG_PER_HOUR};
use rins_inspection::{CHANNELS, Inspection};
use rins_io::{Loaded, shown};

use super::inspected::{LISTED, extremes, gaps, longest, step_in_words};
use super::verdicts::Verdict;

pub(super) fn rows(inspection: &Inspection, loaded: &Loaded) -> Vec<Vec<String>> {
    let recording = &loaded.recording;
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let duration: f64 = recording.increments.iter().map(|sample| sample.interval).sum();
    let timing = &inspection.timing;
    let mut rows = vec![
        row("log", shown(&loaded.rig.log.path)),
        row("samples", format!("{} over {duration:.2} s", recording.len())),
        row(
            "rate",
            format!("{:.3} Hz, jitter {:.3} ms rms", 1.0 / timing.interval, timing.jitter * 1e3),
        ),
        row("gaps", gaps(inspection, loaded)),
        row("static intervals", rest(inspection)),
        row(
            "turns",
            format!(
                "{:.2} revolutions about body {}, sum of both directions",
                inspection.turns,
                loaded.rig.spin.spin_name()
            ),
        ),
    ];
    if let Some(rest) = longest(inspection) {
        let seen = rest.mean.rates.specific_force.norm();
        rows.push(row(
            "gravity",
            format!(
                "{seen:.5} m/s^2 in the longest static interval, {:+.0} ppm relative to the site's {:.5}",
                (seen / loaded.station.gravity - 1.0) * 1e6,
                loaded.station.gravity
            ),
        ));
        let rate = rest.mean.rates.angular_rate.norm() / DEG_PER_HOUR;
        rows.push(row(
            "static rate",
            if inspection.earth_rate_visible {
                format!("{rate:.3} deg/h in the longest one; that of the Earth is 15.041")
            } else {
                format!("{rate:.0} deg/h; the Earth's 15.041 is not visible in it")
            },
        ));
    }
    for (channel, resolution) in inspection.resolution.iter().enumerate() {
        if let Some(step) = resolution {
            rows.push(row(
                &format!("{} resolution", CHANNELS[channel]),
                format!("{} an increment", step_in_words(channel, *step)),
            ));
        }
    }
    rows.push(row("table", table_in_words(loaded)));
    if let Some(ratio) = inspection.spin_ratio {
        let value =
            format!("rotation by the gyro about the spin axis over the table's: {ratio:.6}");
        rows.push(row("spin", value));
    }
    if let (Some(first), Some(last)) = (
        recording.temperature.as_ref().and_then(|t| t.first()),
        recording.temperature.as_ref().and_then(|t| t.last()),
    ) {
        rows.push(row(
            "temperature",
            format!("{first:.2} degC at the start, {last:.2} at the end"),
        ));
    }
    rows
}

/// The verdicts as rows of a table, after a row of headings.
pub(super) fn judged(verdicts: &[Verdict]) -> Vec<Vec<String>> {
    let head = ["on", "verdict", ""].map(String::from).to_vec();
    let row =
        |verdict: &Verdict| vec![verdict.item.into(), verdict.word().into(), verdict.says.clone()];
    let rows = verdicts.iter().map(row);
    std::iter::once(head).chain(rows).collect()
}

fn rest(inspection: &Inspection) -> String {
    let lasting = inspection.rests.iter().fold(0.0, |sum, rest| sum + rest.mean.duration);
    match inspection.rests.len() {
        0 => "none of a second or more".into(),
        1 => format!("1 span of {lasting:.1} s"),
        spans => format!("{spans} spans, {lasting:.1} s in all"),
    }
}

fn table_in_words(loaded: &Loaded) -> String {
    let recording = &loaded.recording;
    match (&recording.table_angle, &recording.table_rate) {
        (Some(angle), _) => {
            let (least, most) = extremes(angle);
            format!(
                "table angle from {:.3} to {:.3} revolutions",
                least / (360.0 * DEG),
                most / (360.0 * DEG)
            )
        }
        (None, Some(rate)) => {
            let (least, most) = extremes(rate);
            format!("table rate from {:.4} to {:.4} deg/s", least / DEG, most / DEG)
        }
        (None, None) if !loaded.rotations.is_empty() => {
            let turned: f64 = loaded.rotations.iter().map(|turn| turn.angle.abs()).sum();
            format!(
                "{} rotation(s) of known angle, {:.1} deg in all",
                loaded.rotations.len(),
                turned / DEG
            )
        }
        (None, None) => "neither angle nor rate".into(),
    }
}

pub(super) fn rests(inspection: &Inspection, loaded: &Loaded) -> Vec<Vec<String>> {
    let mut rows = vec![
        ["from [s]", "to [s]", "gravity [m/s^2]", "rate [deg/h]", ""].map(String::from).to_vec(),
    ];
    rows.extend(inspection.rests.iter().take(LISTED).map(|rest| {
        let times = &loaded.recording.times;
        vec![
            format!("{:.2}", times[rest.span.start]),
            format!("{:.2}", times[rest.span.end - 1]),
            format!("{:.5}", rest.mean.rates.specific_force.norm()),
            format!("{:.3}", rest.mean.rates.angular_rate.norm() / DEG_PER_HOUR),
            String::new(),
        ]
    }));
    if inspection.rests.len() > LISTED {
        rows.push(vec![format!("and {} more", inspection.rests.len() - LISTED)]);
    }
    rows
}
