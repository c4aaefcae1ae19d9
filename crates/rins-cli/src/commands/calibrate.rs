//! `rins calibrate`: from a run to sensor errors, and what compensating them gains.

use std::path::Path;

use anyhow::Context;
use rins_calibration::{
    Calibration, FreeNavigation, MEASUREMENTS, Parameter, Verdict, calibrate, likely_wobble,
};
use rins_frames::units::DEG;
use rins_io::Loaded;
use rins_motion::Suspicion;
use serde_json::{Value, json};

use crate::args::{Calibrate, Model};
use crate::commands::check::{inspected, suspicion_in_words};
use crate::commands::setup::{load, setup, shown};
use crate::outcome::Outcome;
use crate::progress;
use crate::view::{SYSTEMATIC_NOTE, calibration_report, calibration_text, euler_json, meaning};

/// A mean NIS above this is no matter of a sensor error more or less.
const ABSURD_NIS: f64 = 100.0;

/// A table that turns by less in all \[rad\] stands still.
const LEAST_TURN: f64 = 1.0 * DEG;

pub(crate) fn run(arguments: &Calibrate) -> anyhow::Result<Outcome> {
    let Model::Paper12 = arguments.model;
    let rig = &arguments.input.rig;
    let loaded = load(rig)?;
    let calibration = calibrated(&loaded)?;
    Ok(outcome(&calibration, &loaded, rig).of_log(&loaded))
}

/// Calibrates a run, with progress shown.
pub(crate) fn calibrated(loaded: &Loaded) -> anyhow::Result<Calibration> {
    let mut setup = setup(loaded)?;
    refuse_mistaken(loaded)?;
    if loaded.rig.table.as_ref().is_none_or(|table| table.wobble.is_none()) {
        setup.table.wobble = likely_wobble(&loaded.recording, &setup)
            .with_context(|| loaded.rig.log.path.display().to_string())?;
    }
    let bar = progress::bar(loaded.recording.len(), "calibrating");
    let calibration = calibrate(&loaded.recording, &setup, |done| bar.set_position(done as u64));
    bar.finish_and_clear();
    calibration.with_context(|| loaded.rig.log.path.display().to_string())
}

/// Refuses a run whose units, signs or axes are wrong: estimates from it would mean nothing.
fn refuse_mistaken(loaded: &Loaded) -> anyhow::Result<()> {
    let Loaded { rig, recording, .. } = loaded;
    let inspection = inspected(loaded);
    let mistaken: Vec<String> = inspection
        .suspicions
        .iter()
        // A coarse accelerometer may well say the same throughout.
        .filter(|suspicion| !matches!(suspicion, Suspicion::StuckChannel { .. }))
        .map(suspicion_in_words)
        .collect();
    anyhow::ensure!(mistaken.is_empty(), "{}: {}", rig.path.display(), mistaken.join("; and "));
    let turned = match (&recording.table_angle, &recording.table_rate) {
        (Some(angle), _) => {
            let most = angle.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            most - angle.iter().copied().fold(f64::INFINITY, f64::min)
        }
        (None, Some(rate)) => {
            rate.iter().zip(&recording.increments).map(|(rate, s)| rate.abs() * s.interval).sum()
        }
        (None, None) => return Ok(()),
    };
    anyhow::ensure!(
        turned > LEAST_TURN,
        "{}: the table turns by {:.3} deg in all, the z gyro by {:.2}: gyro errors along the spin axis do not show",
        rig.log.path.display(),
        turned / DEG,
        inspection.turns * 360.0
    );
    Ok(())
}

/// A calibration as JSON, text, report and calibration file.
pub(crate) fn outcome(calibration: &Calibration, loaded: &Loaded, rig: &Path) -> Outcome {
    let title = format!("Calibration of {}", shown(rig));
    let span = &calibration.span;
    let subtitle = format!(
        "rins calibrate, model paper12: {} samples from {:.2} s to {:.2} s of {}",
        span.len(),
        loaded.recording.times[span.start],
        loaded.recording.times[span.end - 1],
        loaded.rig.log.path.file_name().map_or_else(String::new, |name| name.display().to_string()),
    );
    let file = rins_io::Calibration {
        sigmas: calibration.parameters.iter().map(sigma).collect(),
        notes: calibration.parameters.iter().filter_map(combination_note).collect(),
        ..rins_io::Calibration::of(calibration.imu_error)
    };
    Outcome {
        json: json(calibration, rig),
        text: calibration_text(calibration, &title),
        failure: absurd(calibration),
        report: Some(calibration_report(calibration, &title, &subtitle)),
        files: vec![("calibration.toml", file.to_toml().into_bytes())],
        ..Outcome::default()
    }
}

/// A parameter's sigma as a calibration file holds it.
fn sigma(parameter: &Parameter) -> rins_io::Parameter {
    let (value, unit) = (parameter.sigma / parameter.kind.factor(), parameter.kind.unit());
    rins_io::Parameter { id: parameter.id.into(), value, unit }
}

/// What a calibration file says of a parameter that is estimated together with a bias.
fn combination_note(parameter: &Parameter) -> Option<String> {
    let partner = parameter.partners.first()?;
    Some(format!(
        "{}: {}; compensating it also undoes {} at a table rate of {:.4} deg/s, and at no other",
        parameter.id,
        meaning(parameter),
        partner.id,
        1.0 / partner.share / DEG
    ))
}

/// Why estimates mean nothing, if the innovations are beyond what any sensor error explains.
fn absurd(calibration: &Calibration) -> Option<String> {
    let nis = calibration.consistency.nis_mean;
    (nis > ABSURD_NIS).then(|| {
        format!(
            "the innovations are {:.0} times larger than the rig's figures allow: units, axes, signs, attitude or table \
             profile are wrong, and so are the estimates",
            (nis / MEASUREMENTS as f64).sqrt()
        )
    })
}

fn json(calibration: &Calibration, rig: &Path) -> Value {
    let consistency = &calibration.consistency;
    let correlation: Vec<Vec<f64>> = (0..3)
        .map(|row| (0..3).map(|column| calibration.correlation[(row, column)]).collect())
        .collect();
    json!({
        "schema": 1,
        "command": "calibrate",
        "model": "paper12",
        "rig": shown(rig),
        "parameters": calibration.parameters.iter().map(parameter_json).collect::<Vec<_>>(),
        "correlation": correlation,
        "axis_attitude_deg": euler_json(&calibration.nav_from_table.euler_angles()),
        "navigation": {
            "before": navigation_json(&calibration.before),
            "after": navigation_json(&calibration.after),
        },
        "consistency": {
            "nis_mean": consistency.nis_mean,
            "nis_dof": consistency.nis_dof,
            "nis_p": consistency.nis_p,
            "whiteness_p": consistency.whiteness_p,
            "channel_rms": consistency.channel_rms,
            "model_fits": consistency.verdict() != Verdict::Misfit,
            "verdict": match consistency.verdict() {
                Verdict::Fits => "fits",
                Verdict::NoiseOverstated => "noise_overstated",
                Verdict::Misfit => "misfit",
            },
        },
        "notes": [SYSTEMATIC_NOTE],
    })
}

fn parameter_json(parameter: &Parameter) -> Value {
    let factor = parameter.kind.factor();
    json!({
        "id": parameter.id,
        "value": parameter.value / factor,
        "sigma": parameter.sigma / factor,
        "unit": parameter.kind.unit(),
        "identifiable": parameter.identifiable(),
        "aliases": parameter.partners.iter().map(|partner| partner.id).collect::<Vec<_>>(),
        "meaning": meaning(parameter),
    })
}

/// Free navigation as JSON: what it ended with.
pub(crate) fn navigation_json(navigation: &FreeNavigation) -> Value {
    json!({
        "velocity_m_s": navigation.velocity.as_slice(),
        "position_error_m": navigation.position_error.as_slice(),
        "attitude_error_deg": euler_json(&navigation.attitude_error),
    })
}
