//! Posteriors over many runs of a linear problem whose posterior is exact: calibrated ones pass, wrong ones are detected.

use nalgebra::{DMatrix, DVector};
use rins_campaign::{Nees, PosteriorRun, PosteriorStatistics, PosteriorTally};
use rins_imu::{NormalStream, Seed, Sensor};

/// The prior sigmas of four parameters in different units.
const PRIORS: [f64; 4] = [1.0, 1e-3, 50.0, 2.0];

/// What is measured, in units of the priors: the first parameter well, the sum of the second and third, and of the fourth nothing.
fn measured() -> DMatrix<f64> {
    DMatrix::from_row_slice(2, 4, &[30.0, 0.0, 0.0, 0.0, 0.0, 20.0, 20.0, 0.0])
}

/// A run with true values from the prior; the sigmas of its posterior are multiplied by `factor`, and its estimates shifted by `shift` of
/// them.
fn run(stream: &mut NormalStream, factor: f64, shift: f64) -> PosteriorRun {
    let design = measured();
    let truth = DVector::from_fn(4, |_, _| stream.sample());
    let noise = DVector::from_fn(2, |_, _| stream.sample());
    let information = DMatrix::identity(4, 4) + design.tr_mul(&design);
    let covariance = information.try_inverse().expect("it is positive definite");
    let mut estimate = &covariance * design.tr_mul(&(&design * &truth + noise));
    for (place, value) in estimate.iter_mut().enumerate() {
        *value += shift * covariance[(place, place)].sqrt();
    }
    let in_units = |values: &DVector<f64>| values.iter().zip(PRIORS).map(|(x, s)| x * s).collect();
    PosteriorRun {
        truth: in_units(&truth),
        estimate: in_units(&estimate),
        prior_sigmas: PRIORS.into(),
        covariance: DMatrix::from_fn(4, 4, |row, column| {
            factor * factor * covariance[(row, column)] * PRIORS[row] * PRIORS[column]
        }),
    }
}

fn statistics(seed: u64, runs: u64, factor: f64, shift: f64) -> PosteriorStatistics {
    let mut stream = Seed::new(seed).stream(Sensor::Encoder);
    let mut tally = PosteriorTally::default();
    for _ in 0..runs {
        let run = run(&mut stream, factor, shift);
        tally.add(&run, Nees::of(&run), 1.0);
    }
    tally.statistics().expect("there are runs")
}

fn least_p_value(statistics: &PosteriorStatistics) -> f64 {
    let all = statistics.parameters.iter().chain(&statistics.of_combinations);
    all.map(|quantity| quantity.p_value).fold(1.0, f64::min)
}

#[test]
fn calibrated_posteriors_pass() {
    const SEEDS: u64 = 40;
    let mut p_values = Vec::new();
    for seed in 0..SEEDS {
        let statistics = statistics(seed, 300, 1.0, 0.0);
        assert_eq!(statistics.of_combinations.len(), 2);
        assert!((statistics.nees_dof - 2.0).abs() < 1e-12, "{}", statistics.nees_dof);
        p_values.push(least_p_value(&statistics));
        for quantity in &statistics.parameters {
            // Five sigma of the mean.
            assert!(quantity.mean_error.abs() < 5.0 * quantity.mean_error_sigma);
            for coverage in &quantity.coverage {
                let sigma = (coverage.nominal * (1.0 - coverage.nominal) / 300.0).sqrt();
                assert!((coverage.fraction - coverage.nominal).abs() < 5.0 * sigma, "{coverage:?}");
            }
        }
    }
    // Of 40 data sets with six tests each, a family-wise false alarm of 1 % is expected in 0.4.
    let alarms = p_values.iter().filter(|p| 6.0 * **p < 0.01).count();
    assert!(alarms <= 3, "{alarms} false alarms: {p_values:?}");
}

#[test]
fn the_mean_nees_leaves_its_bounds_as_often_as_they_say() {
    let outside =
        (100..300).filter(|&seed| !statistics(seed, 50, 1.0, 0.0).is_consistent()).count();
    // Of 200, two are expected; nine or more have a probability of 2e-4.
    assert!(outside < 9, "{outside} of 200");
}

#[test]
fn sigmas_that_are_a_fifth_too_small_are_detected() {
    for seed in 0..10 {
        let statistics = statistics(seed, 500, 0.8, 0.0);
        assert!(6.0 * least_p_value(&statistics) < 0.01, "{seed}: not detected by the ranks");
        assert!(statistics.nees > statistics.nees_bounds[1], "{seed}: not detected by the NEES");
        for quantity in &statistics.parameters {
            let [low, high] = quantity.rms_ratio_interval_95;
            assert!(low > 1.0, "{seed}: [{low}, {high}]");
            // Five sigma of a root mean square of 500 errors.
            assert!((quantity.rms_ratio / 1.25 - 1.0).abs() < 5.0 / 1000.0_f64.sqrt());
        }
    }
}

#[test]
fn sigmas_that_are_too_large_and_biases_are_detected() {
    for seed in 0..10 {
        let large = statistics(seed, 500, 1.25, 0.0);
        assert!(6.0 * least_p_value(&large) < 0.01 && large.nees < large.nees_bounds[0], "{seed}");
        let biased = statistics(seed, 500, 1.0, 0.3);
        assert!(6.0 * least_p_value(&biased) < 0.01, "{seed}");
        let all = biased.parameters.iter();
        assert!(all.clone().any(|one| one.mean_error > 4.0 * one.mean_error_sigma), "{seed}");
    }
}

#[test]
fn an_unmeasured_parameter_has_no_part_in_the_combinations() {
    let statistics = statistics(1, 10, 1.0, 0.0);
    let shares = statistics.combinations.shares();
    for (share, expected) in shares.iter().zip([1.0, 0.5, 0.5, 0.0]) {
        // Rounding of an eigenvector.
        assert!((share - expected).abs() < 1e-9, "{shares:?}");
    }
    let [prior, posterior] = [3, 0].map(|place| {
        let one = &statistics.parameters[place];
        one.sigma_rms / one.prior_sigma_rms
    });
    assert!((prior - 1.0).abs() < 1e-9 && posterior < 0.04);
}
