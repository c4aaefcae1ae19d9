//! The paper's model: one run, three gyro errors, the filter of twelve states.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::Context;
use nalgebra::{DMatrix, Matrix3, Vector3};
use rins_calibration::{
    Calibration, MEASUREMENTS, Parameter, calibrate, likely_wobble, table_angles,
};
use rins_frames::SignedAxes;
use rins_frames::units::DEG;
use rins_inspection::Repeats;
use rins_io::{Covariance, Loaded, ModelFile};
use rins_terms::{Model, Role, Surroundings, Track};
use serde_json::{Value, json};

use crate::commands::calibrate::budget::{Asked, Truth};
use crate::commands::calibrate::gates::refuse_standing;
use crate::commands::calibrate::json::{budget_json, consistency_json};
use crate::commands::calibrate::prepared::repeats_in_words;
use crate::commands::calibrate::{Budget, EQUATION, navigation_json};
use crate::commands::check::refuse_mistaken;
use crate::commands::range::covered;
use crate::commands::setup::setup;
use crate::commands::statics::{static_intervals, statics_json};
use crate::outcome::Outcome;
use crate::progress;
use crate::view::told::OBSERVABLE;
use crate::view::{
    SYSTEMATIC_NOTE, budget_section, calibration_report, calibration_text, compensation_section,
    euler_json, meaning,
};
use rins_io::shown;

/// A mean NIS above this is no matter of a sensor error more or less.
const ABSURD_NIS: f64 = 100.0;

/// Calibrates a run, with progress shown; what repeats in it is taken out first, and told in words.
pub(crate) fn calibrated(loaded: &mut Loaded) -> anyhow::Result<(Calibration, Option<String>)> {
    let mut setup = setup(loaded)?;
    refuse_mistaken(loaded)?;
    refuse_standing(loaded)?;
    let repeats = Repeats::take_out_of(&mut loaded.recording).map(|repeats| {
        format!(
            "{} The paper's filter takes the rate over them for constant; --model full weighs what is not known of it.",
            repeats_in_words(repeats)
        )
    });
    if loaded.rig.table.as_ref().is_none_or(|table| table.wobble.is_none()) {
        setup.table.wobble = likely_wobble(&loaded.recording, &setup)
            .with_context(|| shown(&loaded.rig.log.path))?;
    }
    let bar = progress::bar(loaded.recording.len(), "calibrating");
    let calibration = calibrate(&loaded.recording, &setup, |done| bar.set_position(done as u64));
    bar.finish_and_clear();
    let calibration = calibration.with_context(|| shown(&loaded.rig.log.path))?;
    Ok((calibration, repeats))
}

/// A calibration as JSON, text, report and calibration file.
pub(crate) fn outcome(
    (calibration, remark): &(Calibration, Option<String>),
    loaded: &Loaded,
    rig: &Path,
) -> anyhow::Result<Outcome> {
    let axes = SignedAxes::from(loaded.rig.spin);
    let model = model(calibration);
    let budget = budget(calibration, &model, loaded)?;
    let calibration = &along_own(calibration, &model, &axes);
    let title = format!("Calibration of {}", shown(rig));
    let span = &calibration.span;
    let subtitle = format!(
        "rins calibrate, model paper12: {} samples from {:.2} s to {:.2} s of {}",
        span.len(),
        loaded.recording.times[span.start],
        loaded.recording.times[span.end - 1],
        loaded.rig.log.path.file_name().map_or_else(String::new, |name| shown(Path::new(name))),
    );
    let file = rins_io::Calibration {
        sigmas: calibration.parameters.iter().map(sigma).collect(),
        notes: calibration.parameters.iter().filter_map(combination_note).collect(),
        covariance: Some(covariance(calibration)),
        spin: loaded.rig.spin,
        range: covered([&loaded.recording.slice(span.start, span.end)]),
        ..rins_io::Calibration::of(calibration.imu_error)
    };
    let ids: Vec<&str> =
        calibration.parameters.iter().map(|parameter| parameter.id.as_str()).collect();
    let mut report = calibration_report(calibration, &title, &subtitle);
    report.sections.push(compensation_section(&model));
    report.sections.push(budget_section("Error budget", &ids, &budget));
    let mut result = json(calibration, rig);
    let mut text = calibration_text(calibration, &title);
    if let Some(remark) = remark {
        result["notes"] = json!([SYSTEMATIC_NOTE, remark]);
        report.summary.push(remark.clone());
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {remark}");
    }
    result["error_budget"] = budget_json(&ids, &budget);
    result["compensation"] = EQUATION.into();
    result["static_intervals"] = statics_json(&static_intervals(loaded), |interval| {
        (interval.span.start > 0).then(|| {
            "static, but this method uses only the interval that the log starts with".into()
        })
    });
    Ok(Outcome {
        json: result,
        text,
        failure: absurd(calibration),
        report: Some(report),
        files: vec![
            ("calibration.toml".into(), file.to_toml().into_bytes()),
            (
                "model.toml".into(),
                ModelFile::of(model).with_axes(loaded.rig.spin).to_toml().into_bytes(),
            ),
        ],
        ..Outcome::default()
    })
}

/// A calibration of a run with these axes along the sensors' own axes; `model` is the run's.
fn along_own(calibration: &Calibration, model: &Model, axes: &SignedAxes) -> Calibration {
    let full = Model::full();
    let own = |id: &str| -> (String, f64) {
        let place = |of: &Model| of.find(id).map(|at| (of.terms[at.0].clone(), at));
        let found = place(model).or_else(|| place(&full));
        found.map_or_else(
            || (id.to_owned(), 1.0),
            |(chosen, (_, parameter))| {
                let (name, sign) = chosen.own(parameter, axes);
                (format!("{}.{name}", chosen.term.id), sign)
            },
        )
    };
    let mut along = calibration.clone();
    let mut signs = Vector3::repeat(1.0);
    for (parameter, of) in along.parameters.iter_mut().zip(signs.iter_mut()) {
        let (id, sign) = own(&parameter.id);
        (parameter.id, *of) = (id, sign);
        parameter.value *= sign;
        for partner in &mut parameter.partners {
            let (id, of_partner) = own(&partner.id);
            partner.id = id;
            partner.share *= sign * of_partner;
        }
    }
    along.correlation = Matrix3::from_fn(|row, column| {
        signs[row] * signs[column] * calibration.correlation[(row, column)]
    });
    for point in &mut along.history {
        point.estimate.component_mul_assign(&signs);
    }
    along.imu_error = calibration.imu_error.along(&axes.inverse().matrix());
    along
}

/// The paper's model with the estimates in it.
fn model(calibration: &Calibration) -> Model {
    calibration.parameters.iter().fold(Model::paper12(), |model, parameter| {
        model
            .with_value(&parameter.id, parameter.value)
            .with_role(&parameter.id, Role::Within(parameter.sigma))
    })
}

/// The covariance of the estimates, in the products of their units.
fn covariance(calibration: &Calibration) -> Covariance {
    let parameters = &calibration.parameters;
    let sigma = |place: usize| parameters[place].sigma / parameters[place].kind.factor();
    Covariance {
        ids: parameters.iter().map(|parameter| parameter.id.clone()).collect(),
        matrix: DMatrix::from_fn(parameters.len(), parameters.len(), |row, column| {
            calibration.correlation[(row, column)] * sigma(row) * sigma(column)
        }),
    }
}

/// What each estimate is worth over the calibrated span.
fn budget(calibration: &Calibration, model: &Model, loaded: &Loaded) -> anyhow::Result<Budget> {
    let (span, recording) = (&calibration.span, &loaded.recording);
    let latency = loaded.rig.log.table_angle().and_then(|angle| angle.latency);
    let angles = table_angles(recording, latency.unwrap_or_default()).unwrap_or_default();
    let mut undone = recording.slice(span.start, span.end);
    let compensation = calibration.imu_error.compensation()?;
    for sample in &mut undone.increments {
        *sample = compensation.compensate(sample);
    }
    let track = Track::new(
        Surroundings::new(loaded.station, calibration.nav_from_table),
        undone.times.clone(),
        undone.increments.iter().map(|sample| sample.interval).collect(),
        angles[span.start..=span.end].to_vec(),
        undone.temperature.clone(),
    );
    let asked: Vec<Asked<'_>> = calibration
        .parameters
        .iter()
        .filter_map(|estimate| {
            let (term, parameter) = model.find(&estimate.id)?;
            let (value, sigma) = (estimate.value, estimate.sigma);
            Some(Asked { chosen: &model.terms[term], parameter, value, sigma })
        })
        .collect();
    let covariance = DMatrix::from_fn(asked.len(), asked.len(), |row, column| {
        calibration.correlation[(row, column)] * asked[row].sigma * asked[column].sigma
    });
    let truth = Truth {
        station: &loaded.station,
        nav_from_table: calibration.nav_from_table,
        recording: &undone,
        track: &track,
    };
    Ok(Budget::of(&truth, &asked, &covariance))
}

/// A parameter's sigma as a calibration file holds it.
fn sigma(parameter: &Parameter) -> rins_io::Parameter {
    let (value, unit) = (parameter.sigma / parameter.kind.factor(), parameter.kind.unit());
    rins_io::Parameter { id: parameter.id.clone(), value, unit }
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
        "consistency": consistency_json(&calibration.consistency),
        "identifiability": identifiability_json(&calibration.parameters),
        "notes": [SYSTEMATIC_NOTE],
    })
}

fn parameter_json(parameter: &Parameter) -> Value {
    let factor = parameter.kind.factor();
    let coefficients: Vec<f64> = parameter
        .partners
        .iter()
        .map(|partner| partner.share * partner.kind.factor() / factor)
        .collect();
    let summands = parameter.partners.iter().zip(&coefficients);
    let combination: Vec<Value> = summands
        .map(|(partner, coefficient)| json!({"id": partner.id, "coefficient": coefficient}))
        .collect();
    json!({
        "id": parameter.id,
        "value": parameter.value / factor,
        "sigma": parameter.sigma / factor,
        "unit": parameter.kind.unit(),
        "identifiable": parameter.identifiable(),
        "observability": if parameter.identifiable() { OBSERVABLE } else { "combination" },
        "shown": if parameter.identifiable() { "alone" } else { "combination" },
        "aliases": parameter.partners.iter().map(|partner| partner.id.as_str()).collect::<Vec<_>>(),
        "alias_coefficients": coefficients,
        "combination": combination,
        "meaning": meaning(parameter),
    })
}

fn identifiability_json(parameters: &[Parameter]) -> Value {
    let ids = |alone: bool| -> Vec<&str> {
        let chosen = parameters.iter().filter(|parameter| parameter.identifiable() == alone);
        chosen.map(|parameter| parameter.id.as_str()).collect()
    };
    json!({
        "unknowns": parameters.len(),
        "alone": ids(true),
        "in_combination": ids(false),
        "not_shown": [],
        "gauges": [],
    })
}
