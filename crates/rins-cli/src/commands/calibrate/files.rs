//! What a calibration leaves for other programs: the errors to undo, the model, and how to undo them.

use nalgebra::DMatrix;
use rins_estimation::Fit;
use rins_io::{Covariance, Parameter};
use rins_terms::catalogue::REFERENCE_TEMPERATURE;
use rins_terms::{Model, Role, catalogue};

use crate::commands::calibrate::Certificate;
use crate::commands::range::covered;
use crate::view::told::observability;

/// The compensation, in one line.
pub(crate) const EQUATION: &str = "true = measured − (bias + [S, M] true + terms(true)); with no terms, true = (I + [S, M])⁻¹ (measured − bias)";

/// The compensation, step by step.
pub(crate) const STEPS: [&str; 5] = [
    "1. Turn the sensors' axes into body axes as the rig file's axes say. Divide increments by their \
     interval: what is measured is a mean rate and a mean specific force.",
    "2. Take what was measured for the first guess of what was true, for gyros and accelerometers both.",
    "3. From that guess compute for each triad bias + [S, M] true, and what each further term of the file adds (its \
     equation is in the catalogue). A value in the file has the sign with which the error enters what was measured.",
    "4. Subtract the sum from what was measured: this is the next guess. Misalignments are read row, column: \
     gyro.misalignment.xz times the rate about z is taken from gyro x.",
    "5. Go back to 3 until nothing changes, three rounds or so; then multiply by the interval. Noise is left as it is.",
];

/// Whether a term of the model describes the run's table alone or has no name, so that there is nothing to undo in
/// another run.
pub(crate) fn of_run_alone(id: &str) -> bool {
    [catalogue::AXIS_ATTITUDE.id, catalogue::AXIS_AZIMUTH.id].contains(&id)
        || catalogue::term(id).is_none()
}

/// The calibration file of one run: what its sensors and its encoder get wrong, along the sensors' own axes.
///
/// Of what is not observable the file has the value that was expected; a combination stands there as its parts, and a note says
/// under which motion they are that combination.
pub(super) fn calibration(certificate: &Certificate, run: usize) -> rins_io::Calibration {
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
        sigmas,
        notes: notes(certificate, run, &places),
        terms,
        spin: axes.into(),
        reference_temperature: fit.models[run]
            .reference_temperature()
            .unwrap_or(REFERENCE_TEMPERATURE.default),
        range: covered(
            certificate.runs.iter().flat_map(|run| run.prepared.rests()).map(|run| &*run.recording),
        ),
        covariance: covariance(fit, &places),
        ..rins_io::Calibration::of(error.along(&axes.inverse().matrix()))
    }
}

fn covariance(fit: &Fit, places: &[usize]) -> Option<Covariance> {
    let of = |place: usize| &fit.parameters[places[place]];
    let n = places.len();
    let unit = |place: usize| of(place).parameter.unit.factor;
    (n > 0).then(|| Covariance {
        ids: (0..n).map(|place| of(place).parameter.id.clone()).collect(),
        matrix: DMatrix::from_fn(n, n, |row, column| {
            fit.covariance[(places[row], places[column])] / (unit(row) * unit(column))
        }),
    })
}

fn notes(certificate: &Certificate, run: usize, places: &[usize]) -> Vec<String> {
    let Certificate { fit, told, .. } = certificate;
    let note = |&place: &usize| {
        let mut note = format!(
            "{}: {}",
            told.unknowns[place].id,
            observability(told, place, Some(certificate.value(place)))
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
    let unseen = places.iter().filter(|&&place| !told.seen[place].identifiable);
    let mut notes: Vec<String> = unseen.map(note).collect();
    if places.iter().any(|&place| !told.seen[place].aliases.is_empty()) {
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
pub(super) fn model(certificate: &Certificate) -> Model {
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
