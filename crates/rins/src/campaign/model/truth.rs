//! The true values of a run: drawn from the priors of the model, or those of the scenario.

use nalgebra::Vector3;
use rins_frames::{Dcm, Nav, Table};
use rins_imu::{Seed, Sensor};
use rins_simulation::Scenario;
use rins_terms::{FreeParameter, Model, TermInstance, catalogue};

/// What distinguishes the seed of the true values from that of the noise: the digits of √2, so that no stream is shared.
const OF_TRUTH: u64 = 0x6a09_e667_f3bc_c908;

/// The scenario of a campaign of a model, as a list of terms with their true values.
#[derive(Clone, Debug)]
pub(super) struct TrueModel {
    scenario: Scenario,
    /// The errors of the sensors and the effects of the scenario, and the other terms of the model.
    terms: Model,
    /// For each free parameter of the model, its place in `terms`.
    places: Vec<(usize, usize)>,
}

impl TrueModel {
    /// The scenario, whose axis has the attitude `assumed` in the rig file.
    ///
    /// An attitude that differs from the assumed one becomes a true value of `axis.attitude`, if the model has this term.
    pub(super) fn new(
        scenario: &Scenario,
        assumed: &Dcm<Nav, Table>,
        model: &Model,
        free: &[FreeParameter],
    ) -> Self {
        let mut scenario = scenario.clone();
        let mut terms = Model::from(&scenario.imu_error);
        terms.terms.extend(scenario.effects.terms.iter().cloned());
        if model.terms.iter().any(|chosen| chosen.term.is(&catalogue::AXIS_ATTITUDE)) {
            let tilt = total(&terms, &TermInstance::new(&catalogue::AXIS_ATTITUDE));
            let tilt =
                Dcm::<Table, Table>::from_rotation_vector(&Vector3::from_column_slice(&tilt));
            let off = (assumed.inverse() * scenario.nav_from_table * tilt).rotation_vector();
            scenario.nav_from_table = *assumed;
            terms.terms.retain(|own| !own.term.is(&catalogue::AXIS_ATTITUDE));
            let attitude = TermInstance::new(&catalogue::AXIS_ATTITUDE);
            terms.terms.push(attitude.with_values(off.as_slice()));
        }
        let places = free.iter().map(|parameter| {
            let chosen = &model.terms[parameter.term];
            let place = terms.terms.iter().position(|own| is_same(own, chosen));
            let place = place.unwrap_or_else(|| {
                let none = vec![0.0; chosen.values.len()];
                terms.terms.push(chosen.clone().with_values(&none));
                terms.terms.len() - 1
            });
            (place, parameter.parameter)
        });
        let places = places.collect();
        Self { scenario, terms, places }
    }

    /// The true values of the free parameters in the scenario \[SI\].
    pub(super) fn stated(&self) -> Vec<f64> {
        let of = |&(term, parameter): &(usize, usize)| {
            total(&self.terms, &self.terms.terms[term])[parameter]
        };
        self.places.iter().map(of).collect()
    }

    /// The run with these true values of the free parameters \[SI\] and this seed; its other errors are those of the scenario.
    pub(super) fn with(&self, truth: &[f64], seed: Seed) -> Scenario {
        let mut terms = self.terms.clone();
        for (&(term, parameter), value) in self.places.iter().zip(truth) {
            let chosen = terms.terms[term].clone();
            for own in terms.terms.iter_mut().filter(|own| is_same(own, &chosen)) {
                own.values[parameter] = 0.0;
            }
            terms.terms[term].values[parameter] = *value;
        }
        let (imu_error, effects) = terms.split();
        Scenario { imu_error, effects, seed, ..self.scenario.clone() }
    }
}

/// Whether both are the same effect: the same term with the same settings.
fn is_same(a: &TermInstance, b: &TermInstance) -> bool {
    a.term.is(b.term) && a.settings == b.settings
}

/// The sum of the values of an effect over all its instances \[SI\].
fn total(terms: &Model, effect: &TermInstance) -> Vec<f64> {
    let mut sum = vec![0.0; effect.values.len()];
    for own in terms.terms.iter().filter(|own| is_same(own, effect)) {
        for (sum, value) in sum.iter_mut().zip(&own.values) {
            *sum += value;
        }
    }
    sum
}

/// The true values of the free parameters of `model`, drawn from their normal priors \[SI\].
///
/// They depend on the seed, the run and the place of the parameter only.
pub(super) fn drawn(model: &Model, free: &[FreeParameter], seed: Seed) -> Vec<f64> {
    let mut stream = Seed { seed: seed.seed ^ OF_TRUTH, ..seed }.stream(Sensor::Encoder);
    let draw = |parameter: &FreeParameter| {
        let mean = model.terms[parameter.term].values[parameter.parameter];
        mean + parameter.sigma * stream.sample()
    };
    free.iter().map(draw).collect()
}
