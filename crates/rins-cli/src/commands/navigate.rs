//! `rins navigate`: free inertial navigation from rest.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::Context;
use rins_calibration::{FreeNavigation, navigate_freely, table_angles};
use rins_frames::units::DEG;
use rins_frames::{Body, Dcm, EulerAngles, Nav, Table};
use rins_imu::{Compensation, ImuError, TriadError};
use rins_io::Loaded;
use rins_motion::Recording;
use rins_terms::{Model, Surroundings, compensated};
use serde_json::{Value, json};

use crate::args::Navigate;
use crate::commands::align::{found, table};
use crate::commands::calibrate::navigation_json;
use crate::commands::check::refuse_mistaken;
use crate::commands::range::{Beyond, beyond};
use crate::commands::setup::load;
use crate::outcome::Outcome;
use crate::view::table::aligned;
use crate::view::{attitude_plot, position_plot, velocity_plot};
use rins_io::shown;
use rins_report::{Item, Report, Section};

pub(crate) fn run(arguments: &Navigate) -> anyhow::Result<Outcome> {
    let rig = &arguments.input.rig;
    let loaded = load(rig)?;
    refuse_mistaken(&loaded)?;
    let start = start(&loaded)?;
    let mut runs = vec![("as recorded", navigated(&loaded, &start, None))];
    if let Some(bias) = &start.gyro_bias {
        let compensation = bias.compensation()?;
        runs.push(("gyro bias removed", navigated(&loaded, &start, Some(&compensation))));
    }
    let mut found = Beyond::default();
    if let Some(file) = &arguments.calibration {
        let calibration = rins_io::Calibration::read(file)?;
        let (error, terms) = calibration.in_run(&loaded.rig.spin)?;
        found = beyond(&calibration, &terms, &loaded, arguments.extrapolate)?;
        let undone = undone(&loaded, &start, (error, terms)).with_context(|| shown(file))?;
        runs.push(("compensated", undone));
    }
    for (name, run) in &runs {
        let EulerAngles { roll, pitch, yaw } = run.attitude_error;
        let numbers = run.velocity.iter().chain(&run.position_error).copied();
        anyhow::ensure!(
            numbers.chain([roll, pitch, yaw]).all(f64::is_finite),
            "{}: navigation ({name}) leaves the range of numbers: readings or calibration are absurd",
            shown(rig)
        );
    }
    Ok(outcome(&runs, &start, (&loaded, rig), &found).of_log(&loaded))
}

/// Where navigation starts.
struct Start {
    nav_from_table: Dcm<Nav, Table>,
    /// What the rest shows of the gyro biases, where the attitude came from it.
    gyro_bias: Option<ImuError>,
    source: String,
    /// What is navigated: all of the run or, where no table tells how the body stood before, what
    /// follows the start of the rest.
    recording: Recording,
    /// The table angle before each sample and after the last.
    angles: Vec<f64>,
}

fn start(loaded: &Loaded) -> anyhow::Result<Start> {
    let recording = &loaded.recording;
    let angles =
        table_angles(recording, latency(loaded)).unwrap_or_else(|| vec![0.0; recording.len() + 1]);
    if let Some(attitude) = loaded.rig.attitude {
        return Ok(Start {
            nav_from_table: attitude.angles.dcm(),
            gyro_bias: None,
            source: "the attitude that the rig gives".into(),
            recording: recording.clone(),
            angles,
        });
    }
    let found = found(loaded).with_context(|| shown(&loaded.rig.log.path))?;
    let first = if has_table(recording) { 0 } else { found.span.start };
    let angle = angles[found.span.start];
    let table_from_body = Dcm::<Table, Body>::about_z(angle);
    let gyro =
        TriadError { bias: *found.residual.angular_rate.components(), ..TriadError::default() };
    Ok(Start {
        nav_from_table: found.nav_from_body * table_from_body.inverse(),
        gyro_bias: found.north_found().then(|| ImuError { gyro, ..ImuError::default() }),
        source: format!(
            "the attitude{} found over the rest from {:.0} s to {:.0} s, which is part of what is navigated",
            if found.north_found() { " and the gyro bias" } else { ", its yaw any," },
            found.start,
            recording.times[found.span.end - 1]
        ),
        recording: recording.slice(first, recording.len()),
        angles: angles[first..].to_vec(),
    })
}

/// The attitude of a run's axis at table angle zero: given, or found from a rest.
pub(crate) fn axis_attitude(loaded: &Loaded) -> anyhow::Result<Dcm<Nav, Table>> {
    Ok(start(loaded)?.nav_from_table)
}

/// Whether anything tells how the table stood.
const fn has_table(recording: &Recording) -> bool {
    recording.table_angle.is_some() || recording.table_rate.is_some()
}

fn navigated(
    loaded: &Loaded,
    start: &Start,
    compensation: Option<&Compensation>,
) -> FreeNavigation {
    navigate_freely(
        &start.recording,
        &start.angles,
        start.nav_from_table,
        &loaded.station,
        compensation,
    )
}

/// Navigates what a calibration leaves of the readings.
fn undone(
    loaded: &Loaded,
    start: &Start,
    (error, terms): (ImuError, Model),
) -> anyhow::Result<FreeNavigation> {
    if terms.terms.is_empty() {
        return Ok(navigated(loaded, start, Some(&error.compensation()?)));
    }
    // Terms may depend on how long the run has lasted, so that all of it is compensated.
    let around = Surroundings::new(loaded.station, start.nav_from_table);
    let mut model = Model::from(&error);
    model.terms.extend(terms.terms);
    let whole = compensated(&model, around, &loaded.recording)?;
    let first = whole.len() - start.recording.len();
    let angles = table_angles(&whole, latency(loaded))
        .map_or_else(|| start.angles.clone(), |angles| angles[first..].to_vec());
    let recording = whole.slice(first, whole.len());
    let nav_from_table = start.nav_from_table;
    Ok(navigate_freely(&recording, &angles, nav_from_table, &loaded.station, None))
}

/// How late the table angle was read \[s\].
fn latency(loaded: &Loaded) -> f64 {
    loaded.rig.log.table_angle().and_then(|angle| angle.latency).unwrap_or_default()
}

fn outcome(
    runs: &[(&'static str, FreeNavigation)],
    start: &Start,
    (loaded, rig): (&Loaded, &Path),
    beyond: &Beyond,
) -> Outcome {
    let recording = &start.recording;
    let duration: f64 = recording.increments.iter().map(|sample| sample.interval).sum();
    let mut rows = vec![
        [
            "",
            "v east [m/s]",
            "v north [m/s]",
            "position [m]",
            "roll [deg]",
            "pitch [deg]",
            "yaw [deg]",
        ]
        .map(String::from)
        .to_vec(),
    ];
    rows.extend(runs.iter().map(|(name, run)| {
        let error = &run.attitude_error;
        let mut row = vec![
            (*name).to_owned(),
            format!("{:.4}", run.velocity.x),
            format!("{:.4}", run.velocity.y),
            format!("{:.2}", run.position_error.norm()),
        ];
        row.extend([error.roll, error.pitch, error.yaw].map(|angle| format!("{:.5}", angle / DEG)));
        row
    }));
    let title = format!("Free inertial navigation of {}", shown(rig));
    let summary: Vec<String> = std::iter::once(format!(
        "From {}, over {duration:.0} s with the vertical channel held:",
        start.source
    ))
    .chain(runs.iter().map(|(name, run)| {
        format!(
            "{name}: {:.3} m/s and {:.1} m off at the end.",
            run.velocity.norm(),
            run.position_error.norm()
        )
    }))
    .chain(beyond.notes.iter().cloned())
    .collect();
    let mut text = format!("{title}\n");
    for sentence in &summary {
        let _ = writeln!(text, "  {sentence}");
    }
    text.push('\n');
    text.push_str(&aligned(&rows));
    let intro = if has_table(recording) {
        "The truth is a base that does not move; attitude is told of the axis frame."
    } else {
        "The truth is a base that does not leave its place. Attitude is told against that at the \
         start, so that the base's own sway is in it."
    };
    let named: Vec<(&str, &FreeNavigation)> = runs.iter().map(|(name, run)| (*name, run)).collect();
    let report = Report {
        title,
        subtitle: format!("rins navigate: {}", shown(&loaded.rig.log.path)),
        summary,
        sections: vec![Section {
            heading: "Errors".into(),
            intro: intro.into(),
            items: vec![
                Item::Table(table(&rows)),
                Item::Plot(velocity_plot(&named)),
                Item::Plot(position_plot(&named)),
                Item::Plot(attitude_plot(&named)),
            ],
        }],
    };
    let mut json = json(runs, start, duration, rig);
    json["outside_calibrated_range"] = beyond.json.clone();
    json["notes"] = json!(beyond.notes);
    Outcome { json, text, report: Some(report), ..Outcome::default() }
}

fn json(
    runs: &[(&'static str, FreeNavigation)],
    start: &Start,
    duration: f64,
    rig: &Path,
) -> Value {
    let shown_runs: Vec<Value> = runs
        .iter()
        .map(|(name, run)| {
            let mut value = navigation_json(run);
            value["name"] = json!(name);
            value
        })
        .collect();
    json!({
        "schema": 1,
        "command": "navigate",
        "rig": shown(rig),
        "start": start.source,
        "duration_s": duration,
        "runs": shown_runs,
    })
}
