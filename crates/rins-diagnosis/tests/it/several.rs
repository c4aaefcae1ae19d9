//! Several runs of one unit, each of which knows its own part only.

use rins_diagnosis::{Structure, suppose};
use rins_estimation::{NoiseKnowledge, NoiseParameters};
use rins_frames::units::{DEG_PER_HOUR, STANDARD_GRAVITY};
use rins_terms::{Model, TermInstance, catalogue};

use crate::hidden::RATES;
use crate::support::{SEED, fibre, run};

/// What one run leaves open another one tells: that is no change from one part of a run to the next.
#[test]
fn what_is_the_same_in_all_runs_is_constant_in_each() {
    let per_g = DEG_PER_HOUR / STANDARD_GRAVITY;
    let values = [0.0, 0.3, 0.0, 0.2, 0.0, 0.0, -0.3, 0.0, 0.0].map(|value| value * per_g);
    let supposed = TermInstance::new(&catalogue::GYRO_G_SENSITIVITY).estimated();
    let hidden = Model { terms: vec![supposed.clone().with_values(&values)] };
    let runs = [run(&RATES, hidden.clone(), 0.0, SEED), run(&[15.0, -30.0], hidden, 0.0, SEED + 1)];
    let imu = fibre();
    let knowledge = NoiseKnowledge::Given(NoiseParameters::of(&imu));
    let diagnosis = suppose(&runs, &Model::full(), &[supposed], &imu, knowledge).unwrap();
    let changes = diagnosis.unexplained.iter();
    let changes = changes.filter(|one| matches!(one.structure, Structure::Inconstant(_)));
    assert_eq!(changes.count(), 0, "{:?}", diagnosis.unexplained);
    let of_cause = &diagnosis.causes[0].parameters;
    for (estimate, truth) in of_cause.iter().zip(values) {
        let off = (estimate.value - truth) / estimate.sigma;
        assert!(off.abs() < 4.0, "{}: {off} sigma off", estimate.parameter.id);
    }
}
