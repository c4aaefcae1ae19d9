//! The report page of a check.

use rins_frames::Increments;
use rins_frames::units::DEG;
use rins_inspection::Inspection;
use rins_io::{Loaded, shown};
use rins_report::{Item, Plot, Report, Section, Series, Style, Tone};

use super::Check;
use super::mends::mends_in_words;
use super::text::{judged, rests, rows};
use super::words::suspicion_in_words;
use crate::log::statics_in_words;
use crate::table::report_table;

/// The report page of a check.
pub(super) fn page(check: &Check<'_>) -> Report {
    let Check { log, inspection, oddities, mends, verdicts } = check;
    let loaded = &log.loaded;
    let mut rows = rows(inspection, loaded);
    rows.insert(0, ["", ""].map(String::from).to_vec());
    let verdict = if inspection.suspicions.is_empty() {
        "Units, signs and axes agree with gravity and with the table, as far as this log shows them."
    } else {
        "Something is wrong with units, signs or axes: see below before you use this log."
    };
    let mut summary = vec![verdict.to_owned()];
    summary.extend(oddities.iter().cloned());
    summary.extend(statics_in_words(&inspection.static_intervals, &loaded.rig));
    let mut items: Vec<Item> = inspection
        .suspicions
        .iter()
        .map(|suspicion| Item::Note(Tone::Bad, suspicion_in_words(suspicion)))
        .collect();
    if let Some(mend) = mends_in_words(mends) {
        items.push(Item::Note(Tone::Bad, format!("Correction: {mend}.")));
    }
    items.push(Item::Table(report_table(&rows)));
    if inspection.rests.len() > 1 {
        items.push(Item::Table(report_table(&rests(inspection, loaded))));
    }
    Report {
        title: check.title(),
        subtitle: format!("rins check: {}", shown(&loaded.rig.log.path)),
        summary,
        sections: vec![
            Section { heading: "What is in it".into(), intro: String::new(), items },
            Section {
                heading: "Verdicts".into(),
                intro: "One on each thing that can be wrong with a log: good, a fact that is neither, odd, or bad.".into(),
                items: vec![Item::Table(report_table(&judged(verdicts)))],
            },
            Section {
                heading: "Readings".into(),
                intro: "Mean rates and specific forces over each interval, along the body axes."
                    .into(),
                items: readings(inspection, loaded),
            },
        ],
    }
}

/// One plot for each kind of reading in the run.
fn readings(inspection: &Inspection, loaded: &Loaded) -> Vec<Item> {
    let recording = &loaded.recording;
    let curve = |title: &str, y_label: &str, y: Vec<f64>, style: Style| {
        Item::Plot(Plot {
            title: title.into(),
            x_label: "Time [s]".into(),
            y_label: y_label.into(),
            series: vec![Series { name: title.into(), x: recording.times.clone(), y, style }],
            ..Plot::default()
        })
    };
    let plot = |title: &str, y_label: &str, of: &dyn Fn(usize) -> Vec<f64>| {
        Item::Plot(Plot {
            title: title.into(),
            x_label: "Time [s]".into(),
            y_label: y_label.into(),
            series: ["x", "y", "z"]
                .iter()
                .enumerate()
                .map(|(axis, name)| Series {
                    name: (*name).into(),
                    x: recording.times.clone(),
                    y: of(axis),
                    style: Style::Line,
                })
                .collect(),
            ..Plot::default()
        })
    };
    let rate = |s: &Increments, axis: usize| s.rates().angular_rate.components()[axis] / DEG;
    let force = |s: &Increments, axis: usize| s.rates().specific_force.components()[axis];
    let samples = &recording.increments;
    let mut items = vec![
        plot("Angular rate", "Rate [deg/s]", &|axis| {
            samples.iter().map(|sample| rate(sample, axis)).collect()
        }),
        plot("Specific force", "Force [m/s^2]", &|axis| {
            samples.iter().map(|sample| force(sample, axis)).collect()
        }),
    ];
    if let Some(angle) = &recording.table_angle {
        let turns = angle.iter().map(|angle| angle / (360.0 * DEG)).collect();
        items.push(curve("Table angle", "Angle [turns]", turns, Style::Line));
    }
    if let Some(rate) = &recording.table_rate {
        let rates = rate.iter().map(|rate| rate / DEG).collect();
        items.push(curve("Table rate", "Rate [deg/s]", rates, Style::Steps));
    }
    if inspection.timing.jitter > 0.0 || !inspection.timing.gaps.is_empty() {
        let intervals = samples.iter().map(|sample| sample.interval * 1e3).collect();
        items.push(curve("Sample interval", "Interval [ms]", intervals, Style::Points));
    }
    items
}
