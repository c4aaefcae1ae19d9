//! What a calibration leaves for other programs: the errors to undo, the model, and how to undo them.

use nalgebra::{DMatrix, DVector};
use rins_estimation::Fit;
use rins_io::{Covariance, ModelFile, Parameter};
use rins_terms::catalogue::REFERENCE_TEMPERATURE;
use rins_terms::{Model, Role, catalogue};

use super::certificate::{Certificate, CertifiedRun};
use super::compensation::of_run_alone;
use crate::identifiability::observability;
use crate::log::{covered, measured, measured_together};

impl Certificate {
    /// The model with the estimates in it, and a calibration file for each run.
    pub(crate) fn calibration_files(&self) -> Vec<(String, Vec<u8>)> {
        let several = self.runs.len() > 1;
        let mut extended = model(self);
        extended.terms.extend(self.besides.iter().cloned());
        let file = ModelFile::of(extended)
            .with_axes(self.fit.run_axes[0].into())
            .with_provenance(self.basis().provenance());
        let mut delivered = vec![("model.toml".into(), file.to_toml().into_bytes())];
        for run in 0..self.runs.len() {
            let name = match (several, run) {
                (true, 1..) => format!("calibration-{}.toml", run + 1),
                _ => "calibration.toml".into(),
            };
            let file = calibration(self, run);
            delivered.push((name, file.to_toml().into_bytes()));
        }
        delivered
    }
}

impl Certificate {
    /// The calibration file of one run.
    pub(crate) fn calibration_file(&self, run: usize) -> rins_io::Calibration {
        calibration(self, run)
    }
}

/// The calibration file of one run: what its sensors and its encoder get wrong, along the sensors' own axes.
///
/// Of what is not observable the file has the value that was expected; a combination stands there as its parts, and a note says
/// under which motion they are that combination.
fn calibration(certificate: &Certificate, run: usize) -> rins_io::Calibration {
    let fit = &certificate.fit;
    let axes = fit.run_axes[run];
    let (error, mut terms) = fit.models[run].split();
    terms.terms.retain(|chosen| !of_run_alone(chosen.term.id));
    let places: Vec<usize> = (0..fit.parameters.len())
        .filter(|&place| {
            let here = fit.in_run(&fit.parameters[place], run);
            here.is_some_and(|here| !of_run_alone(fit.models[run].terms[here.term].term.id))
        })
        .collect();
    let mut sigmas = Vec::new();
    for &place in &places {
        let estimate = &fit.parameters[place];
        let unit = estimate.parameter.unit;
        match terms.find_own(&estimate.parameter.id, &axes) {
            Some((term, parameter)) => {
                terms.terms[term].roles[parameter] = Role::Within(estimate.sigma);
            }
            None => sigmas.push(Parameter {
                id: estimate.parameter.id.clone(),
                value: estimate.sigma / unit.factor,
                unit: unit.symbol,
            }),
        }
    }
    // A term that was held has no sigma, whatever was known of it before.
    for chosen in &mut terms.terms {
        for role in &mut chosen.roles {
            if *role == Role::Free {
                *role = Role::Held;
            }
        }
    }
    rins_io::Calibration {
        notes: notes(certificate, run, &places),
        terms,
        spin: axes.into(),
        reference_temperature: fit.models[run]
            .reference_temperature()
            .unwrap_or(REFERENCE_TEMPERATURE.default),
        range: covered(
            certificate.runs.iter().flat_map(|run| run.prepared.rests()).map(|run| &*run.recording),
        ),
        covariance: covariance(certificate, &places),
        priors: places.iter().filter_map(|&place| prior(fit, place, &sigmas)).collect(),
        measured: measured_together(
            &certificate
                .runs
                .iter()
                .map(|CertifiedRun { prepared, .. }| {
                    measured(&prepared.loaded.rig, prepared.rests().map(|run| &*run.recording))
                })
                .collect::<Vec<_>>(),
        ),
        provenance: certificate.basis().provenance(),
        sigmas,
        ..rins_io::Calibration::of(error.along(&axes.inverse().matrix()))
    }
}

/// What was known beforehand of a parameter that stands among the `sigmas`.
fn prior(fit: &Fit, place: usize, sigmas: &[Parameter]) -> Option<Parameter> {
    let of = &fit.parameters[place].parameter;
    let known = sigmas.iter().find(|sigma| sigma.id == of.id)?;
    Some(Parameter { value: of.sigma / of.unit.factor, ..known.clone() })
}

fn covariance(certificate: &Certificate, places: &[usize]) -> Option<Covariance> {
    let Certificate { fit, contributions, .. } = certificate;
    let of = |place: usize| &fit.parameters[places[place]];
    let n = places.len();
    let unit = |place: usize| of(place).parameter.unit.factor;
    (n > 0).then(|| Covariance {
        ids: (0..n).map(|place| of(place).parameter.id.clone()).collect(),
        matrix: DMatrix::from_fn(n, n, |row, column| {
            fit.covariance[(places[row], places[column])] / (unit(row) * unit(column))
        }),
        references: contributions
            .iter()
            .map(|one| {
                let shift = |place: usize, _| one.moves[places[place]] / unit(place);
                (one.reference.key().into(), DVector::from_fn(n, shift))
            })
            .collect(),
    })
}

fn notes(certificate: &Certificate, run: usize, places: &[usize]) -> Vec<String> {
    let Certificate { fit, identifiability, .. } = certificate;
    let note = |&place: &usize| {
        let mut note = format!(
            "{}: {}",
            identifiability.unknowns[place].id,
            observability(identifiability, place, Some(certificate.value(place)))
        );
        if certificate.held.contains(&place) {
            note += if fit.parameters[place].expected == 0.0 {
                "; not compensated"
            } else {
                "; compensated by the value that was expected"
            };
        }
        note
    };
    let unseen = places.iter().filter(|&&place| !identifiability.parameters[place].identifiable);
    let mut notes: Vec<String> = unseen.map(note).collect();
    if places.iter().any(|&place| !identifiability.parameters[place].aliases.is_empty()) {
        let shared = places.iter().any(|&place| fit.parameters[place].run.is_none());
        let of_all = certificate.runs.iter().filter(|_| shared);
        let alone = certificate.runs[run..=run].iter().filter(|_| !shared);
        let motions: Vec<&str> = of_all.chain(alone).map(|run| run.motion.as_str()).collect();
        notes.push(format!(
            "A combination is compensated by the values of its parts, which make that combination under the motion that \
             was calibrated and under no other: {}.",
            motions.join("; ")
        ));
    }
    notes
}

/// The first run's model with the estimates in it, the sigma of each as what is known of it now.
///
/// What keeps its expected value is as free as it was.
fn model(certificate: &Certificate) -> Model {
    let fit = &certificate.fit;
    let mut model = fit.model().clone();
    for (place, estimate) in fit.parameters.iter().enumerate() {
        if let Some(here) = fit.in_run(estimate, 0).filter(|_| !certificate.held.contains(&place)) {
            model.terms[here.term].roles[here.parameter] = Role::Within(estimate.sigma);
        }
    }
    // What was found without a name is no model of another run.
    model.terms.retain(|chosen| catalogue::term(chosen.term.id).is_some());
    model
}
