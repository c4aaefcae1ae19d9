//! Consistency of the covariance, and whiteness of the whitened innovations.

use nalgebra::SMatrix;
use rins_ekf::{Smoother, Step};
use rins_testing::{
    assert_chi_squared, assert_standard_normal, is_chi_squared, standard_normal_defect,
};

use crate::random::{M, N, Shared, run};

const RUNS: u64 = 400;
const STEPS: usize = 20;

/// The results of a filter over many runs, with its measurement noise scaled.
struct Findings {
    /// The normalized estimation error squared at the end of each run.
    nees: Vec<f64>,
    /// The normalized innovation squared of every step.
    nis: Vec<f64>,
    /// Every element of every whitened innovation.
    whitened: Vec<f64>,
    /// Products of elements one step apart.
    lagged: Vec<f64>,
}

fn findings(shared: Shared, noise_factor: f64) -> Findings {
    let (mut nees, mut nis) = (Vec::new(), Vec::new());
    let (mut whitened, mut lagged) = (Vec::new(), Vec::new());
    for seed in 0..RUNS {
        let run = run(seed, STEPS, shared);
        let mut filter = run.start.clone();
        let mut last = None;
        for step in &run.steps {
            filter.predict(&step.transition, &step.total_process());
            let mut measurement = step.measurement();
            measurement.noise *= noise_factor;
            let innovation = filter.update(&measurement).unwrap();
            nis.push(innovation.nis());
            whitened.extend(innovation.whitened.iter());
            if let Some(last) = last.replace(innovation.whitened) {
                lagged.push(last.dot(&innovation.whitened));
            }
        }
        let error = run.truth[STEPS - 1] - filter.state;
        let factor = filter.covariance.cholesky().unwrap();
        nees.push(error.dot(&factor.solve(&error)));
    }
    Findings { nees, nis, whitened, lagged }
}

#[test]
fn an_honest_filter_passes_and_one_that_doubles_its_noise_fails() {
    for shared in [Shared::No, Shared::Yes] {
        let honest = findings(shared, 1.0);
        assert_chi_squared(&honest.nees, N as f64);
        assert_chi_squared(&honest.nis, M as f64);
        assert_standard_normal(&honest.whitened);

        for factor in [2.0, 0.5] {
            // Half of a correlated noise would be less than its part in common with the state.
            if shared == Shared::Yes && factor < 1.0 {
                continue;
            }
            let wrong = findings(shared, factor);
            assert!(!is_chi_squared(&wrong.nees, N as f64), "{shared:?} {factor}");
            assert!(!is_chi_squared(&wrong.nis, M as f64), "{shared:?} {factor}");
            assert!(standard_normal_defect(&wrong.whitened) > 1.0, "{shared:?} {factor}");
        }
    }
}

#[test]
fn whitened_innovations_are_white() {
    for shared in [Shared::No, Shared::Yes] {
        let lagged = findings(shared, 1.0).lagged;
        // A product of M independent pairs has variance M; 3.3σ is one case in a thousand.
        let mean = lagged.iter().sum::<f64>() / lagged.len() as f64;
        let bound = 3.3 * (M as f64 / lagged.len() as f64).sqrt();
        assert!(mean.abs() < bound, "mean product {mean}, not within ±{bound}");
    }
}

#[test]
fn smoothed_errors_have_the_covariance_they_claim() {
    let mut nees = Vec::new();
    for seed in 0..RUNS {
        let run = run(seed, STEPS, Shared::No);
        let mut filter = run.start.clone();
        let mut smoother = Smoother::new(filter.clone());
        for step in &run.steps {
            let noise: SMatrix<f64, N, N> = step.total_process();
            filter.predict(&step.transition, &noise);
            let predicted = filter.clone();
            filter.update(&step.measurement()).unwrap();
            let filtered = filter.clone();
            smoother.push(Step { transition: step.transition, noise, predicted, filtered });
        }
        let middle = &smoother.smoothed().unwrap()[STEPS / 2];
        let error = run.truth[STEPS / 2 - 1] - middle.state;
        nees.push(error.dot(&middle.covariance.cholesky().unwrap().solve(&error)));
    }
    assert_chi_squared(&nees, N as f64);
}
