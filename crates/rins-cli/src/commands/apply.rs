//! `rins apply`: a log without the errors that a calibration has found.

use std::fmt::Write as _;

use anyhow::Context;
use rins_imu::ImuError;
use rins_io::{Calibration, Loaded, LogFile, Overwrite, convert_changed};
use rins_terms::{Model, Surroundings, compensated};
use serde_json::json;

use crate::args::Apply;
use crate::commands::check::refuse_mistaken;
use crate::commands::convert::{format_of, remarks};
use crate::commands::navigate::axis_attitude;
use crate::commands::range::{Beyond, beyond};
use crate::commands::repairs::repairs;
use crate::outcome::Outcome;
use rins_io::shown;

pub(crate) fn run(arguments: &Apply, overwrite: Overwrite) -> anyhow::Result<Outcome> {
    let Apply { rig, calibration: file, output, format, extrapolate } = arguments;
    let format: LogFile = format_of(output, *format)?;
    let calibration = Calibration::read(file)?;
    let mut found = Beyond::default();
    let converted = convert_changed(rig, output, format, overwrite, |loaded| {
        refuse_mistaken(loaded)?;
        let run = calibration.in_run(&loaded.rig.spin)?;
        found = beyond(&calibration, &run.1, loaded, *extrapolate)?;
        undo(run, loaded).with_context(|| shown(file))?;
        anyhow::Ok(format!("Written by `rins apply` with the calibration {}.", shown(file)))
    })?;
    let triads = Model::from(&calibration.error);
    let terms = triads.terms.iter().chain(&calibration.terms.terms);
    let undone: Vec<&str> = terms.map(|chosen| chosen.term.id).collect();
    let mut text = format!(
        "Compensated {} by {}\n  {} samples to {} as {}, read by {}\n  undone: {}\n",
        shown(rig),
        shown(file),
        converted.samples,
        shown(output),
        format.name(),
        shown(&converted.rig),
        undone.join(", ")
    );
    for line in found.notes.iter().cloned().chain(remarks(&converted)) {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {line}");
    }
    let json = json!({
        "schema": 1,
        "command": "apply",
        "rig": shown(rig),
        "calibration": shown(file),
        "log": shown(output),
        "new_rig": shown(&converted.rig),
        "format": format.name(),
        "samples": converted.samples,
        "undone": undone,
        "outside_calibrated_range": found.json,
        "notes": found.notes,
        "exact": converted.differences.is_empty(),
        "left_out": converted.left_out,
        "time_origin_s": converted.time_origin,
        "repairs": repairs(&converted.old, &converted.summary),
    });
    Ok(Outcome { json, text, ..Outcome::default() })
}

/// Takes what a calibration holds out of a run.
fn undo((error, terms): (ImuError, Model), loaded: &mut Loaded) -> anyhow::Result<()> {
    if terms.terms.is_empty() {
        // Eq. (1) is undone sample by sample, wherever the axis points.
        let compensation = error.compensation()?;
        for sample in &mut loaded.recording.increments {
            *sample = compensation.compensate(sample);
        }
        return Ok(());
    }
    let around = Surroundings::new(loaded.station, axis_attitude(loaded)?);
    let mut model = Model::from(&error);
    model.terms.extend(terms.terms);
    loaded.recording = compensated(&model, around, &loaded.recording)?;
    Ok(())
}
