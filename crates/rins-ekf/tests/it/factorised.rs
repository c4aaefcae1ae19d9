//! The factorized filter compared with the plain one, and its refusals.

use nalgebra::{Cholesky, Matrix1, Matrix2, RowVector2, SMatrix, SVector, Vector1, Vector2};
use proptest::prelude::*;
use rins_ekf::{
    CovarianceError, FactorisedFilter, Factors, Filter, Measurement, Quantity, UpdateError,
};
use rins_testing::assert_close;

use crate::random::{N, Random, Run, Shared, Step, run};

/// The rounding error of both forms in some steps of well-conditioned systems.
const ROUNDING: f64 = 1e-12;

fn predict(filter: &mut FactorisedFilter<N>, step: &Step) {
    let root = Cholesky::new(step.total_process()).unwrap().l();
    filter.predict(&step.transition, &root, &SVector::<f64, N>::repeat(1.0));
}

/// The largest difference of the two forms at the end of a run, and in all innovations.
fn difference(run: &Run) -> f64 {
    let mut plain = run.start.clone();
    let mut factorised = FactorisedFilter::new(plain.state, &plain.covariance).unwrap();
    let mut worst = 0.0_f64;
    for step in &run.steps {
        plain.predict(&step.transition, &step.total_process());
        predict(&mut factorised, step);
        let measurement = step.measurement();
        let want = plain.update(&measurement).unwrap();
        let got = factorised.update(&measurement).unwrap();
        worst = worst
            .max((got.value - want.value).amax())
            .max((got.whitened - want.whitened).amax())
            .max((got.covariance - want.covariance).amax())
            .max((got.log_likelihood() - want.log_likelihood()).abs())
            .max((factorised.state - plain.state).amax())
            .max((factorised.factors().covariance() - plain.covariance).amax());
    }
    worst
}

proptest! {
    #[test]
    fn both_forms_find_the_same(seed: u64, n_steps in 1..20_usize) {
        for shared in [Shared::No, Shared::Yes] {
            let off = difference(&run(seed, n_steps, shared));
            prop_assert!(off < ROUNDING * 100.0, "off by {off:e}");
        }
    }

    #[test]
    fn factors_multiply_out_to_what_they_are_of(seed: u64) {
        let mut random = Random::seeded(seed);
        let covariance = random.covariance::<N>();
        let off = Factors::of(&covariance).unwrap().covariance() - covariance;
        prop_assert!(off.amax() < ROUNDING * covariance.amax());
        // More sources than states, and fewer.
        let (many, few) = (random.matrix::<N, 7>(), random.matrix::<N, 2>());
        let by_many = Factors::of_sources(&many, &SVector::repeat(2.0)).covariance();
        prop_assert!((by_many - many * many.transpose() * 2.0).amax() < ROUNDING * by_many.amax());
        let by_few = Factors::of_sources(&few, &SVector::repeat(2.0)).covariance();
        prop_assert!((by_few - few * few.transpose() * 2.0).amax() < ROUNDING * by_few.amax());
    }
}

#[test]
fn both_forms_find_the_same_over_18000_steps() {
    let off = difference(&run(5, 18_000, Shared::Yes));
    assert!(off < 1e-11, "off by {off:e}");
}

#[test]
fn what_noise_the_error_explains_alone_is_known_exactly() {
    // One noise of variance 4 drove the state and is the only quantity that is measured.
    let mut filter = FactorisedFilter::new(Vector1::new(0.0), &Matrix1::new(4.0)).unwrap();
    let difference = Measurement::new(Vector1::new(3.0), Matrix1::new(0.0), Matrix1::new(4.0))
        .correlated_with_state_error(Matrix1::new(-4.0));
    let innovation = filter.update(&difference).unwrap();
    assert_eq!(filter.state, Vector1::new(-3.0));
    assert_eq!(filter.factors().covariance(), Matrix1::new(0.0));
    assert_close!(innovation.nis(), 2.25, 1e-15);
}

#[test]
fn a_state_that_is_known_stays_known() {
    let prior = Matrix2::new(4.0, 0.0, 0.0, 0.0);
    let mut filter = FactorisedFilter::new(Vector2::new(1.0, 2.0), &prior).unwrap();
    let sum = Measurement::new(Vector1::new(5.0), RowVector2::new(1.0, 1.0), Matrix1::new(4.0));
    filter.update(&sum).unwrap();
    assert_eq!(filter.state, Vector2::new(2.0, 2.0));
    assert_eq!(filter.factors().covariance(), Matrix2::new(2.0, 0.0, 0.0, 0.0));
}

/// Noise that is correlated with the error of one state, beside another state that is known exactly: the result is that of
/// the plain form.
#[test]
fn noise_that_goes_with_one_error_leaves_a_known_state_known() {
    let prior = Matrix2::new(4.0, 0.0, 0.0, 0.0);
    let sum = Measurement::new(Vector1::new(5.0), RowVector2::new(1.0, 1.0), Matrix1::new(4.0))
        .correlated_with_state_error(Vector2::new(1.0, 0.0));
    let mut plain = Filter { state: Vector2::new(1.0, 2.0), covariance: prior };
    let want = plain.update(&sum).unwrap();
    let mut filter = FactorisedFilter::new(Vector2::new(1.0, 2.0), &prior).unwrap();
    let got = filter.update(&sum).unwrap();
    assert!((filter.state - plain.state).amax() < ROUNDING, "{}", filter.state);
    assert!((filter.factors().covariance() - plain.covariance).amax() < ROUNDING);
    assert_eq!(filter.state[1].to_bits(), 2.0_f64.to_bits());
    assert_close!(got.nis(), want.nis(), ROUNDING);
}

fn assert_refused<const M: usize>(
    mut filter: FactorisedFilter<2>,
    measurement: &Measurement<M, 2>,
    why: impl Fn(&UpdateError) -> bool,
) {
    let before = filter.factors().covariance();
    let error = filter.update(measurement).unwrap_err();
    assert!(why(&error), "{error:?}");
    let same = |a: f64, b: f64| a.to_bits() == b.to_bits();
    assert!(filter.factors().covariance().iter().zip(&before).all(|(&a, &b)| same(a, b)));
}

#[test]
fn what_cannot_be_is_refused_and_leaves_the_filter_alone() {
    let filter = FactorisedFilter::new(Vector2::zeros(), &Matrix2::identity()).unwrap();
    let row = |noise: f64| {
        Measurement::new(Vector1::new(1.0), RowVector2::new(1.0, 1.0), Matrix1::new(noise))
    };
    assert_refused(filter, &row(f64::NAN), |error| {
        *error == UpdateError::NotFinite { quantity: Quantity::Noise }
    });
    assert_refused(filter, &row(-3.0), |error| {
        matches!(error, UpdateError::NoiseOverexplained { row: 0, .. })
    });
    let cross = row(1.0).correlated_with_state_error(Vector2::new(3.0, 0.0));
    assert_refused(filter, &cross, |error| {
        *error == UpdateError::NoiseOverexplained { row: 0, variance: -8.0 }
    });
    let mut nothing = row(0.0);
    nothing.matrix.fill(0.0);
    assert_refused(filter, &nothing, |error| {
        *error == UpdateError::InnovationNotPositiveDefinite { smallest: 0.0 }
    });
    let mut steep = row(1.0);
    steep.matrix *= 1e200;
    assert_refused(filter, &steep, |error| *error == UpdateError::Overflow);
    let mut far = filter;
    far.state[0] = f64::INFINITY;
    assert_refused(far, &row(1.0), |error| {
        *error == UpdateError::NotFinite { quantity: Quantity::State }
    });
    let mut lost = filter;
    lost.predict(
        &Matrix2::from_element(f64::NAN),
        &SMatrix::<f64, 2, 1>::zeros(),
        &Vector1::new(0.0),
    );
    lost.state = Vector2::zeros();
    assert_refused(lost, &row(1.0), |error| {
        *error == UpdateError::NotFinite { quantity: Quantity::Covariance }
    });
}

#[test]
fn a_matrix_that_has_lost_its_digits_has_no_factors() {
    let of = |a, b, c| Factors::of(&Matrix2::new(a, b, b, c)).map(|_| ());
    assert_eq!(of(1.0, 0.5, 1.0), Ok(()));
    assert_eq!(of(0.0, 0.0, 1.0), Ok(()), "a state may be known");
    assert_eq!(
        of(1.0, 2.0, 1.0),
        Err(CovarianceError::NotPositiveDefinite { index: 0, variance: -3.0 })
    );
    let error = of(1.0 + 1e-12, 1.0, 1.0).unwrap_err();
    assert!(
        matches!(error, CovarianceError::Unresolved { index: 0, part } if part < 2e-12),
        "{error}"
    );
    assert_eq!(
        of(f64::NAN, 0.0, 1.0),
        Err(CovarianceError::NotFinite { quantity: Quantity::Covariance })
    );
    // With rounding allowed for, one state determines the other.
    let known = Factors::of_rounded(&Matrix2::new(1.0 + 1e-15, 1.0, 1.0, 1.0), 1e-13).unwrap();
    assert_eq!(known.covariance(), Matrix2::from_element(1.0));
    assert!(FactorisedFilter::new(Vector2::new(f64::NAN, 0.0), &Matrix2::identity()).is_err());
    assert!(Filter::new(Vector2::zeros(), Matrix2::identity()).is_ok());
}
