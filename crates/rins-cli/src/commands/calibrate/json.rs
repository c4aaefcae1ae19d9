//! A calibration for a machine.

use nalgebra::{DMatrix, Vector3};
use rins_calibration::{Consistency, FreeNavigation, MEASUREMENTS, Verdict};
use rins_estimation::{Departure, Reference, correlation};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G};
use serde_json::{Value, json};

use crate::args::NoiseChoice;
use crate::commands::calibrate::prepared::across_axis;
use crate::commands::calibrate::{Budget, Certificate, CertifiedRun, Drift, EQUATION};
use crate::view::told::{self, coefficient, identifiability_json, meaning};
use crate::view::{euler_json, quantity};

/// Free inertial navigation as JSON: what it ended with.
pub(crate) fn navigation_json(navigation: &FreeNavigation) -> Value {
    json!({
        "velocity_m_s": navigation.velocity.as_slice(),
        "position_error_m": navigation.position_error.as_slice(),
        "attitude_error_deg": euler_json(&navigation.attitude_error),
    })
}

/// What the innovations say of the model, as JSON.
pub(crate) fn consistency_json(consistency: &Consistency) -> Value {
    let dof = consistency.nis_dof;
    json!({
        "nis_mean": consistency.nis_mean,
        // A whole number where all epochs have the same channels.
        "nis_dof": (1..=MEASUREMENTS)
            .find(|count| (*count as f64 - dof).abs() < 1e-9)
            .map_or_else(|| json!(dof), |count| json!(count)),
        "nis_p": consistency.nis_p,
        "whiteness_p": consistency.whiteness_p,
        "channel_rms": consistency.channel_rms,
        "model_fits": consistency.verdict() != Verdict::Misfit,
        "verdict": match consistency.verdict() {
            Verdict::Fits => "fits",
            Verdict::NoiseOverstated => "noise_overstated",
            Verdict::Misfit => "misfit",
        },
    })
}

/// The whole of a calibration with any model.
pub(super) fn certificate(certificate: &Certificate) -> Value {
    let fit = &certificate.fit;
    let parameters: Vec<Value> =
        (0..fit.parameters.len()).map(|place| parameter_json(certificate, place)).collect();
    let iterations: Vec<Value> = fit
        .iterations
        .iter()
        .map(|i| json!({"step_sigma": i.step, "log_likelihood": i.log_likelihood}))
        .collect();
    let first = &certificate.runs[0];
    let names: Vec<&str> = certificate.runs.iter().map(|run| run.prepared.name.as_str()).collect();
    let runs: Vec<Value> = certificate
        .runs
        .iter()
        .enumerate()
        .map(|(place, run)| run_json(certificate, place, run))
        .collect();
    json!({
        "schema": 1,
        "command": "calibrate",
        "model": certificate.model,
        "rig": names[0],
        "rigs": names,
        "parameters": parameters,
        "correlation": rows(&correlation(&fit.covariance)),
        "axis_attitude_deg": euler_json(&first.nav_from_table.euler_angles()),
        "navigation": {
            "before": navigation_json(&first.before),
            "after": navigation_json(&first.after),
        },
        "consistency": consistency_json(&certificate.consistency),
        "prior_consistency": prior_consistency(certificate),
        "iterations": iterations,
        "log_likelihood": fit.log_likelihood,
        "noise": noise_json(certificate),
        "identifiability": identifiability_json(&certificate.told),
        "error_budget": budget_json(&ids(certificate, first), &first.budget),
        "compensation": EQUATION,
        "static_intervals": statics(&runs),
        "runs": runs,
        "notes": certificate.remarks,
    })
}

/// The static intervals of all runs; of several, each with the run that it is in.
fn statics(runs: &[Value]) -> Vec<Value> {
    let of_run = |(place, run): (usize, &Value)| {
        let intervals = run["static_intervals"].as_array().cloned().unwrap_or_default();
        intervals.into_iter().map(move |mut interval| {
            interval["run"] = json!(place + 1);
            interval
        })
    };
    runs.iter().enumerate().flat_map(of_run).collect()
}

/// The ids of what was estimated of a run and of the IMU, in the order of the run's budget.
fn ids<'c>(certificate: &'c Certificate, run: &CertifiedRun) -> Vec<&'c str> {
    run.places
        .iter()
        .map(|&place| certificate.fit.parameters[place].parameter.id.as_str())
        .collect()
}

pub(super) fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

/// What lies further off than was stated beforehand, the furthest first.
fn prior_consistency(certificate: &Certificate) -> Vec<Value> {
    let one = |of: &Departure| {
        let (id, unit) = quantity(certificate, of.of);
        json!({
            "id": id,
            "value": of.value / unit.factor,
            "expected": of.expected / unit.factor,
            "sigma": of.sigma / unit.factor,
            "sigmas": of.sigmas,
            "unit": unit.symbol,
        })
    };
    certificate.departed().into_iter().map(one).collect()
}

fn parameter_json(certificate: &Certificate, place: usize) -> Value {
    let Certificate { fit, told, .. } = certificate;
    let estimate = &fit.parameters[place];
    let factor = estimate.parameter.unit.factor;
    let (value, sigma) = certificate.value(place);
    let mut parameter = told::parameter_json(told, place);
    let aliases = &told.seen[place].aliases;
    let coefficients: Vec<f64> =
        aliases.iter().map(|alias| coefficient(told, place, alias)).collect();
    parameter["value"] = json!(value / factor);
    parameter["sigma"] = json!(sigma / factor);
    parameter["alias_coefficients"] = json!(coefficients);
    parameter["alone"] =
        json!({"value": estimate.value / factor, "sigma": estimate.sigma / factor});
    parameter["meaning"] = json!(meaning(told, place));
    parameter
}

pub(crate) fn noise_json(certificate: &Certificate) -> Value {
    let imu = certificate.fit.noise[0].imu;
    json!({
        "found": certificate.noise == NoiseChoice::Likely,
        "gyro": {
            "white_deg_h_sqrt_hz": imu.gyro.white / DEG_PER_HOUR,
            "flicker_deg_h": imu.gyro.flicker / DEG_PER_HOUR,
            "random_walk_deg_h_sqrt_h": imu.gyro.walk * 60.0 / DEG_PER_HOUR,
        },
        "accel": {
            "white_ug_sqrt_hz": imu.accel.white / MICRO_G,
            "flicker_ug": imu.accel.flicker / MICRO_G,
            "random_walk_ug_sqrt_h": imu.accel.walk * 60.0 / MICRO_G,
        },
    })
}

fn run_json(certificate: &Certificate, place: usize, run: &CertifiedRun) -> Value {
    let noise = &certificate.fit.noise[place];
    let reference = run.prepared.run.rig.reference;
    let encoder = matches!(reference, Reference::Encoder { .. });
    json!({
        "rig": run.prepared.name,
        "reference": match reference {
            Reference::Encoder { .. } => "table_angle",
            Reference::Command { .. } => "table_rate",
            Reference::Gravity => "gravity",
            Reference::Rest => "rest",
        },
        "samples": run.prepared.samples(),
        "static_intervals": run.prepared.static_intervals,
        "rests": (!run.prepared.others.is_empty()).then_some(
            run.prepared.others.len() + usize::from(reference == Reference::Rest)
        ),
        "axis_attitude_deg": euler_json(&run.nav_from_table.euler_angles()),
        "gravity_across_axis_m_s2":
            across_axis(run.prepared.loaded.station.gravity, &run.nav_from_table),
        "wobble_arcsec": noise.wobble / ARCSEC,
        "encoder_noise_arcsec": encoder.then_some(noise.encoder / ARCSEC),
        "encoder_jitter_us": encoder.then_some(noise.imu.jitter * 1e6),
        "base_velocity_m_s": noise.velocity,
        "base_sway_arcsec_sqrt_s": noise.sway.map(|sway| sway / ARCSEC),
        "navigation": {
            "before": navigation_json(&run.before),
            "after": navigation_json(&run.after),
        },
        "consistency": consistency_json(&run.consistency),
        "error_budget": budget_json(&ids(certificate, run), &run.budget),
    })
}

/// An error budget, of parameters with these ids.
pub(super) fn budget_json(ids: &[&str], budget: &Budget) -> Value {
    let vector = |v: Vector3<f64>| v.as_slice().to_vec();
    let drift = |drift: &Drift| {
        json!({
            "velocity_m_s": vector(drift.velocity),
            "attitude_deg": vector(drift.attitude / DEG),
        })
    };
    let parameters: Vec<Value> = ids
        .iter()
        .zip(&budget.worth)
        .map(|(id, worth)| {
            json!({
                "id": id,
                "by_sigma": drift(&worth.by_sigma),
                "by_value": drift(&worth.by_value),
            })
        })
        .collect();
    json!({
        "after_s": budget.after,
        "parameters": parameters,
        "total_1_sigma": drift(&budget.total),
    })
}
