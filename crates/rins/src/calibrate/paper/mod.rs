//! The paper's model: one run, three gyro errors, the filter of twelve states.

mod gates;
mod observability;
mod outcome;
mod page;
mod result;

use anyhow::Context;
use nalgebra::{DMatrix, Matrix3, Vector3};
use rins_calibration::{Calibration, Parameter, likely_wobble, table_angles};
use rins_design::{Budget, EstimatedParameter, Truth};
use rins_frames::SignedAxes;
use rins_frames::units::DEG;
use rins_inspection::Repeats;
use rins_io::{Covariance, Loaded, shown};
use rins_terms::{Model, Role, Surroundings, Track};

use self::gates::refuse_standing;
use self::observability::meaning;
use crate::basis::BasisResult;
use crate::log::{Log, covered, measured};
use crate::preparation::{repeats_in_words, screened};
use crate::progress::Progress;

/// The estimates of the paper's filter from one log, and their error budget.
#[derive(Debug)]
pub(crate) struct PaperCalibration {
    /// The log, repeated samples taken out.
    log: Log,
    /// The estimates, along the sensors' own axes.
    calibration: Calibration,
    /// The paper's model of the run with the estimates in it.
    model: Model,
    /// The error budget over the calibrated span.
    budget: Budget,
    /// What was assumed of data sheet and site, and what was taken out of the log.
    remarks: Vec<String>,
    /// Its basis: inputs, repairs and assumptions.
    basis: BasisResult,
}

impl PaperCalibration {
    /// Calibrates a log; what repeats in it is taken out first.
    pub(super) fn of(mut log: Log, progress: &Progress) -> anyhow::Result<Self> {
        let (mut setup, assumptions) = screened(&log.loaded)?;
        let basis = BasisResult::of_log(&log).assuming(assumptions.iter().cloned());
        let loaded = &mut log.loaded;
        refuse_standing(loaded)?;
        let repeated = Repeats::take_out_of(&mut loaded.recording).map(|repeats| {
            format!(
                "{} The paper's filter takes the rate over them for constant; --model full weighs what is not known of it.",
                repeats_in_words(repeats)
            )
        });
        let remarks = assumptions.into_iter().chain(repeated).collect();
        if loaded.rig.table.as_ref().is_none_or(|table| table.wobble.is_none()) {
            setup.table.wobble = likely_wobble(&loaded.recording, &setup)
                .with_context(|| shown(&loaded.rig.log.path))?;
        }
        let stage = progress.begin("calibrating", Some(loaded.recording.len()));
        let calibration =
            rins_calibration::calibrate(&loaded.recording, &setup, |done| stage.done(done));
        drop(stage);
        let calibration = calibration.with_context(|| shown(&loaded.rig.log.path))?;
        let model = model(&calibration);
        let budget = budget(&calibration, &model, loaded)?;
        let calibration = along_own(&calibration, &model, &SignedAxes::from(loaded.rig.spin));
        Ok(Self { log, calibration, model, budget, remarks, basis })
    }

    /// The samples that were estimated from.
    #[cfg(test)]
    pub(super) fn recording(&self) -> &rins_motion::Recording {
        &self.log.loaded.recording
    }

    /// The ids of what was estimated.
    fn ids(&self) -> Vec<&str> {
        self.calibration.parameters.iter().map(|parameter| parameter.id.as_str()).collect()
    }

    /// The calibration file.
    fn file(&self) -> rins_io::Calibration {
        let Self { log, calibration, .. } = self;
        let span = &calibration.span;
        rins_io::Calibration {
            sigmas: calibration.parameters.iter().map(sigma).collect(),
            notes: calibration.parameters.iter().filter_map(combination_note).collect(),
            covariance: Some(covariance(calibration)),
            spin: log.loaded.rig.spin,
            measured: measured(&log.loaded.rig, [&log.loaded.recording]),
            provenance: self.basis.provenance(),
            range: covered([&log.loaded.recording.slice(span.start, span.end)]),
            ..rins_io::Calibration::of(calibration.imu_error)
        }
    }
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
        references: Vec::new(),
    }
}

/// The error budget over the calibrated span.
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
    let asked: Vec<EstimatedParameter<'_>> = calibration
        .parameters
        .iter()
        .filter_map(|estimate| {
            let (term, parameter) = model.find(&estimate.id)?;
            let (value, sigma) = (estimate.value, estimate.sigma);
            Some(EstimatedParameter { chosen: &model.terms[term], parameter, value, sigma })
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
