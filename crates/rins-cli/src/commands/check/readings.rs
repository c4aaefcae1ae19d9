//! The readings of a run as plots.

use rins_frames::Increments;
use rins_frames::units::DEG;
use rins_inspection::Inspection;
use rins_io::Loaded;

use rins_report::{Item, Plot, Series, Style};

/// A plot of each kind of reading that a run has.
pub(super) fn readings(inspection: &Inspection, loaded: &Loaded) -> Vec<Item> {
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
