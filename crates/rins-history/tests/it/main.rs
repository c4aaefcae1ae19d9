//! Integration tests of histories of runs.
#![expect(clippy::unwrap_used, reason = "in a test an unwrap is an assertion")]

use nalgebra::DMatrix;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rins_history::{Conditions, History, HistoryError, Kind, Quantity, RunEstimate};
use rins_testing::assert_close;

/// The covariance of two correlated parameters with these 1σ.
fn covariance([a, b]: [f64; 2]) -> DMatrix<f64> {
    DMatrix::from_row_slice(2, 2, &[a * a, 0.7 * a * b, 0.7 * a * b, b * b])
}

/// Runs under these conditions whose estimates of two parameters scatter about these values.
fn runs(
    truth: impl Fn(&Conditions) -> [f64; 2],
    all: &[Conditions],
    sigmas: [f64; 2],
    seed: u64,
) -> Vec<RunEstimate> {
    let mut random = Pcg64::seed_from_u64(seed);
    let covariance = covariance(sigmas);
    let root = covariance.clone().cholesky().unwrap().unpack();
    let run = |conditions: &Conditions| {
        let white = nalgebra::DVector::from_fn(2, |_, _| StandardNormal.sample(&mut random));
        let noise = &root * white;
        let [a, b] = truth(conditions);
        let values = [a + noise[0], b + noise[1]];
        RunEstimate::measured(*conditions, (2, &[0, 1]), &values, &covariance).unwrap()
    };
    all.iter().map(run).collect()
}

fn quantities(units: [f64; 2]) -> Vec<Quantity> {
    let of = |(place, unit): (usize, f64)| Quantity {
        id: format!("p{place}"),
        typical: (0.1 * unit, 30.0 * unit),
    };
    units.into_iter().enumerate().map(of).collect()
}

/// Six runs on six days, each with its own power-on, at two temperatures in turns.
fn days() -> Vec<Conditions> {
    (0..6_u8)
        .map(|day| Conditions {
            power_on: day.into(),
            date: Some(f64::from(day)),
            temperature: Some(20.0 + 30.0 * f64::from(day % 3)),
            ..Conditions::default()
        })
        .collect()
}

/// If nothing differs, the p-value of a parameter is as small as it says.
#[test]
fn homogeneity_is_as_rare_as_it_says() {
    let below = (0..2000)
        .filter(|&seed| {
            let runs = runs(|_| [3.0, -40.0], &days(), [1.0, 5.0], seed);
            let history = History::new(quantities([1.0, 5.0]), runs).unwrap();
            history.homogeneity()[0].ln_p < 0.1_f64.ln()
        })
        .count();
    // Binomial, four sigmas.
    assert!((146..254).contains(&below), "{below} of 2000 below 0.1");
}

/// Where one of two correlated parameters differs, the other does not beside it.
#[test]
fn correlated_parameter_does_not_differ_beside_the_one_that_does() {
    let truth = |one: &Conditions| [20.0 * one.date.unwrap(), 5.0];
    let runs = runs(truth, &days(), [1.0, 5.0], 3);
    let tests = History::new(quantities([1.0, 5.0]), runs).unwrap().homogeneity();
    assert!(tests[1].ln_p < f64::ln(1e-9), "{}", tests[1].ln_p);
    assert!(tests[0].ln_p_beside < f64::ln(1e-9), "{}", tests[0].ln_p_beside);
    assert!(tests[1].ln_p_beside > f64::ln(1e-3), "{}", tests[1].ln_p_beside);
}

/// What runs say of a parameter is what a least squares line through them says.
#[test]
fn drift_is_the_line_of_least_squares() {
    let runs = runs(|one| [7.0 * one.date.unwrap(), 0.0], &days(), [0.01, 1.0], 4);
    let alone: Vec<RunEstimate> = runs
        .iter()
        .map(|run| {
            let (value, sigma) = run.value(0).unwrap();
            let variance = DMatrix::from_element(1, 1, sigma * sigma);
            RunEstimate::measured(run.conditions, (1, &[0]), &[value], &variance).unwrap()
        })
        .collect();
    let (mut xy, mut xx) = (0.0, 0.0);
    for run in &alone {
        let x = run.conditions.date.unwrap() - 2.5;
        xy += x * run.value(0).unwrap().0;
        xx += x * x;
    }
    let quantity = Quantity { id: "p".into(), typical: (0.01, 100.0) };
    let explanation = History::new(vec![quantity], alone).unwrap().explain();
    let cause = &explanation.causes()[0];
    assert_eq!(cause.variation.kind(), Kind::Drift);
    // The amplitude is the change over five days.
    assert_close!(cause.amplitudes[0].0, 5.0 * xy / xx, 1e-3);
    assert_close!(cause.amplitudes[0].1, 5.0 * 0.01 / f64::sqrt(xx), 1e-4);
}

#[test]
fn forecast_says_which_condition_it_needs() {
    let truth = |one: &Conditions| [one.temperature.unwrap(), 0.0];
    let history = History::new(quantities([1.0, 1.0]), runs(truth, &days(), [0.1, 1.0], 5));
    let explanation = history.unwrap().explain();
    let unknown = Conditions { power_on: 9, date: Some(9.0), ..Conditions::default() };
    let error = explanation.forecast(0, unknown).unwrap_err();
    assert_eq!(error, HistoryError::Condition { id: "p0".into(), condition: "temperature" });
    let known = Conditions { temperature: Some(35.0), ..unknown };
    let forecast = explanation.forecast(0, known).unwrap().unwrap();
    assert_close!(forecast.mean(), 35.0, 5.0 * forecast.sigma());
    assert!(forecast.sigma() < 1.0, "{}", forecast.sigma());
}

#[test]
fn runs_that_cannot_be_compared_are_refused() {
    let runs = runs(|_| [0.0, 0.0], &days(), [1.0, 1.0], 6);
    let one = History::new(quantities([1.0, 1.0]), runs[..1].to_vec());
    assert_eq!(one.unwrap_err(), HistoryError::FewRuns { runs: 1 });
    let fewer = History::new(quantities([1.0, 1.0])[..1].to_vec(), runs.clone());
    assert_eq!(fewer.unwrap_err(), HistoryError::Shape);
    let wrong = History::new(quantities([1.0, f64::NAN]), runs);
    assert!(matches!(wrong.unwrap_err(), HistoryError::Typical { .. }));
    let measured = |places: &[usize], values: &[f64], covariance: &DMatrix<f64>| {
        RunEstimate::measured(Conditions::default(), (2, places), values, covariance).unwrap_err()
    };
    let identity = DMatrix::identity(2, 2);
    assert_eq!(measured(&[0, 0], &[1.0, 2.0], &identity), HistoryError::Shape);
    assert_eq!(measured(&[0, 2], &[1.0, 2.0], &identity), HistoryError::Shape);
    assert_eq!(measured(&[0, 1], &[1.0, f64::NAN], &identity), HistoryError::NotFinite);
    let singular = DMatrix::from_element(2, 2, 1.0);
    assert_eq!(measured(&[0, 1], &[1.0, 2.0], &singular), HistoryError::Covariance);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]

    /// Units are a matter of taste: causes and their probabilities do not depend on them.
    #[test]
    fn causes_do_not_depend_on_units(seed in 0_u64..1000, ln_unit in -20.0..20.0_f64, slope in 0.0..10.0_f64) {
        let unit = ln_unit.exp();
        let explain = |unit: f64| {
            let truth = |one: &Conditions| [unit * slope * one.date.unwrap(), 5.0];
            let runs = runs(truth, &days(), [unit, 2.0], seed);
            History::new(quantities([unit, 2.0]), runs).unwrap().explain()
        };
        let (one, other) = (explain(1.0), explain(unit));
        prop_assert_eq!(one.causes().len(), other.causes().len());
        for (a, b) in one.causes().iter().zip(other.causes()) {
            prop_assert_eq!(&a.id, &b.id);
            prop_assert_eq!(a.variation, b.variation);
            prop_assert!((a.ln_p - b.ln_p).abs() < 1e-6 * a.ln_p.abs().max(1.0), "{} {}", a.ln_p, b.ln_p);
        }
    }
}
