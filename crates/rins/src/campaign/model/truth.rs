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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use rins_io::{Rig, ScenarioFile};
    use rins_simulation::simulate;

    use super::*;

    /// The demo: errors of all sensors, an attitude that differs from the stated one, and an effect.
    fn demo() -> (Scenario, Rig) {
        let file = ScenarioFile::parse(crate::demo::SCENARIO, Path::new("scenario.toml")).unwrap();
        let scenario = Scenario { noise: None, ..file.scenario.clone() };
        let recording = simulate(&scenario).unwrap().recording;
        let rig = Rig::parse(&file.rig_toml(&recording), Path::new("rig.toml")).unwrap();
        (scenario, rig)
    }

    #[test]
    fn the_stated_values_simulate_the_scenario() {
        let (scenario, rig) = demo();
        let mut model = Model::full();
        let latency = scenario.effects.terms[0].clone();
        model.terms.push(latency.clone().estimated());
        let free = model.free(rig.require_imu().unwrap());
        let assumed = rig.attitude.unwrap().angles.dcm();
        let truth = TrueModel::new(&scenario, &assumed, &model, &free);
        let stated = truth.stated();
        let of = |id: &str| stated[free.iter().position(|one| one.id == id).unwrap()];
        assert_eq!(of("gyro.scale.z").to_bits(), 300e-6_f64.to_bits());
        assert_eq!(of("encoder_latency.delay").to_bits(), latency.values[0].to_bits());
        assert!(of("axis.attitude.x").abs() > 1e-5, "the attitudes differ");
        let made = simulate(&truth.with(&stated, scenario.seed)).unwrap().recording;
        let expected = simulate(&scenario).unwrap().recording;
        for (one, other) in made.increments.iter().zip(&expected.increments) {
            // The attitude is now a tilt of the table, whose effect (up to 3e-4 m/s, 2e-9 rad) is taken half-way over each sample, in
            // which the table turns by 0.8 deg: to 1e-5 of itself.
            let angle = (one.angle.components() - other.angle.components()).norm();
            let velocity = (one.velocity.components() - other.velocity.components()).norm();
            assert!(angle < 2e-14 && velocity < 3e-9, "{angle} rad, {velocity} m/s");
        }
        assert_eq!(made.table_angle, expected.table_angle);
    }

    #[test]
    fn draws_have_the_moments_of_the_prior() {
        let (scenario, rig) = demo();
        let model = Model::full().with_value("gyro.bias.x", 1e-6);
        let free = model.free(rig.require_imu().unwrap());
        let runs = 400;
        let draws: Vec<Vec<f64>> =
            (0..runs).map(|run| drawn(&model, &free, Seed { run, ..scenario.seed })).collect();
        for (place, parameter) in free.iter().enumerate() {
            let mean = if parameter.id == "gyro.bias.x" { 1e-6 } else { 0.0 };
            let normalized = draws.iter().map(|draw| (draw[place] - mean) / parameter.sigma);
            let (sum, squares) =
                normalized.fold((0.0, 0.0), |(sum, squares), x| (sum + x, squares + x * x));
            // Five sigma of the mean and of the mean square.
            assert!((sum / runs as f64).abs() < 5.0 / (runs as f64).sqrt(), "{}", parameter.id);
            let excess = squares / runs as f64 - 1.0;
            assert!(excess.abs() < 5.0 * (2.0 / runs as f64).sqrt(), "{}", parameter.id);
        }
        assert_eq!(draws[3], drawn(&model, &free, Seed { run: 3, ..scenario.seed }));
    }

    /// What the model does not estimate stays as in the scenario.
    #[test]
    fn other_errors_stay() {
        let (scenario, rig) = demo();
        let model = Model::paper12();
        let free = model.free(rig.require_imu().unwrap());
        let assumed = rig.attitude.unwrap().angles.dcm();
        let truth = TrueModel::new(&scenario, &assumed, &model, &free);
        let run = truth.with(&[1e-3, 2e-3, 3e-3], scenario.seed);
        assert_eq!(run.nav_from_table, scenario.nav_from_table);
        assert_eq!(
            (&run.effects, run.imu_error.accel),
            (&scenario.effects, scenario.imu_error.accel)
        );
        let mut matrix = scenario.imu_error.gyro.matrix;
        (matrix[(2, 2)], matrix[(0, 2)], matrix[(1, 2)]) = (1e-3, 2e-3, 3e-3);
        assert_eq!(run.imu_error.gyro.matrix, matrix);
    }
}
