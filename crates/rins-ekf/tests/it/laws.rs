//! Laws that hold for any system and any data.

use nalgebra::{SMatrix, SVector};
use proptest::prelude::*;
use rins_ekf::{Filter, Measurement, congruence};

use crate::random::{M, N, Random, Run, Shared, run};

/// A dozen sums of products of matrices with condition numbers of up to some thousands.
const ROUNDING: f64 = 1e-11;

fn distance<const K: usize>(a: &Filter<K>, b: &Filter<K>) -> f64 {
    (a.state - b.state).amax().max((a.covariance - b.covariance).amax())
}

/// The filter before the first update of a run, and the measurement for it.
fn predicted(run: &Run) -> (Filter<N>, Measurement<M, N>) {
    let mut filter = run.start.clone();
    filter.predict(&run.steps[0].transition, &run.steps[0].total_process());
    (filter, run.steps[0].measurement())
}

proptest! {
    #[test]
    fn covariance_stays_exactly_symmetric_and_positive_definite(
        seed: u64,
        decades in -6.0..6.0_f64,
        shared in prop_oneof![Just(Shared::Yes), Just(Shared::No)],
    ) {
        let run = run(seed, 30, shared);
        let scale = 10_f64.powf(decades);
        let mut filter = run.start.clone();
        filter.covariance *= scale;
        for step in &run.steps {
            filter.predict(&step.transition, &step.total_process());
            prop_assert_eq!(filter.check(), Ok(()));
            filter.update(&step.measurement()).unwrap();
            prop_assert_eq!(filter.check(), Ok(()));
            prop_assert!(filter.covariance.cholesky().is_some());
        }
    }

    #[test]
    fn a_measurement_never_adds_uncertainty(seed: u64) {
        let run = run(seed, 10, Shared::No);
        let mut filter = run.start.clone();
        for step in &run.steps {
            filter.predict(&step.transition, &step.total_process());
            let before = filter.covariance;
            filter.update(&step.measurement()).unwrap();
            let least = (before - filter.covariance).symmetric_eigenvalues().min();
            prop_assert!(least > -ROUNDING, "an eigenvalue of {least:e}");
        }
    }

    #[test]
    fn one_block_is_its_rows_in_turn_and_in_any_order(seed: u64) {
        let mut random = Random::seeded(seed);
        let start = Filter::new(random.matrix::<N, 1>(), random.covariance()).unwrap();
        let sigmas: SVector<f64, 3> = random.matrix();
        let noise = SMatrix::from_diagonal(&sigmas.map(|x| x * x + 0.1));
        let (value, matrix) = (random.matrix::<3, 1>(), random.matrix::<3, N>());

        let mut block = start.clone();
        let innovation = block.update(&Measurement::new(value, matrix, noise)).unwrap();
        for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
            let mut in_turn = start.clone();
            let mut log_likelihood = 0.0;
            for row in order {
                let one = Measurement::new(
                    SVector::from([value[row]]),
                    matrix.row(row).into_owned(),
                    SMatrix::from([[noise[(row, row)]]]),
                );
                log_likelihood += in_turn.update(&one).unwrap().log_likelihood();
            }
            prop_assert!(distance(&in_turn, &block) < ROUNDING);
            prop_assert!((log_likelihood - innovation.log_likelihood()).abs() < ROUNDING);
        }
    }

    #[test]
    fn units_of_states_and_measurements_do_not_matter(
        seed: u64,
        decades in prop::array::uniform4(-8.0..8.0_f64),
    ) {
        let (predicted, measurement) = predicted(&run(seed, 1, Shared::Yes));
        let mut filter = predicted.clone();
        let innovation = filter.update(&measurement).unwrap();

        let unit = SMatrix::from_diagonal(&SVector::from(decades.map(|d| 10_f64.powf(d))));
        let inverse = unit.map_diagonal(|x| 1.0 / x);
        let inverse = SMatrix::from_diagonal(&inverse);
        let meter = SMatrix::<f64, M, M>::from_diagonal(&SVector::from([1e5, 1e-3]));
        let mut scaled = Filter {
            state: unit * predicted.state,
            covariance: congruence(&unit, &predicted.covariance),
        };
        let scaled_measurement = Measurement::new(
            meter * measurement.value,
            meter * measurement.matrix * inverse,
            congruence(&meter, &measurement.noise),
        )
        .correlated_with_state_error(unit * measurement.cross.unwrap() * meter);
        let scaled_innovation = scaled.update(&scaled_measurement).unwrap();

        let back = Filter {
            state: inverse * scaled.state,
            covariance: congruence(&inverse, &scaled.covariance),
        };
        prop_assert!(distance(&back, &filter) < ROUNDING);
        prop_assert!((scaled_innovation.whitened - innovation.whitened).amax() < ROUNDING);
    }

    #[test]
    fn no_cross_covariance_and_one_of_zero_are_the_same(seed: u64) {
        let run = run(seed, 1, Shared::No);
        let measurement = run.steps[0].measurement();
        let (mut plain, mut zero) = (run.start.clone(), run.start.clone());
        let innovation = plain.update(&measurement).unwrap();
        let measurement = measurement.correlated_with_state_error(SMatrix::zeros());
        prop_assert_eq!(zero.update(&measurement).unwrap(), innovation);
        prop_assert_eq!(zero, plain);
    }

    #[test]
    fn innovation_is_what_it_says(seed: u64) {
        let (mut filter, measurement) = predicted(&run(seed, 1, Shared::Yes));
        let expected = measurement.value - measurement.matrix * filter.state;
        let innovation = filter.update(&measurement).unwrap();
        prop_assert!((innovation.value - expected).amax() < ROUNDING);
        let inverse = innovation.covariance.try_inverse().unwrap();
        let nis = (expected.transpose() * inverse * expected)[0];
        prop_assert!((innovation.nis() - nis).abs() < ROUNDING * (1.0 + nis));
        let density = (std::f64::consts::TAU.powi(2) * innovation.covariance.determinant()).sqrt();
        let log_likelihood = -nis / 2.0 - density.ln();
        prop_assert!((innovation.log_likelihood() - log_likelihood).abs() < ROUNDING * (1.0 + nis));
    }

    #[test]
    fn nonlinear_measurement_is_used_about_the_state(seed: u64) {
        let run = run(seed, 1, Shared::No);
        let measurement = run.steps[0].measurement();
        let (mut direct, mut about) = (run.start.clone(), run.start.clone());
        direct.update(&measurement).unwrap();
        let residual = measurement.value - measurement.matrix * run.start.state;
        let linearised = Measurement::linearised(
            &residual,
            &run.start.state,
            measurement.matrix,
            measurement.noise,
        );
        about.update(&linearised).unwrap();
        prop_assert!(distance(&direct, &about) < ROUNDING);
    }

    #[test]
    fn linear_prediction_is_the_nonlinear_one_of_a_linear_function(seed: u64) {
        let run = run(seed, 1, Shared::No);
        let step = &run.steps[0];
        let (mut linear, mut nonlinear) = (run.start.clone(), run.start.clone());
        linear.predict(&step.transition, &step.process);
        nonlinear.predict_to(step.transition * run.start.state, &step.transition, &step.process);
        prop_assert_eq!(linear, nonlinear);
    }
}
