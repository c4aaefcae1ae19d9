//! Refusals, which change nothing.

use nalgebra::{Matrix1, Matrix2, RowVector2, Vector1, Vector2};
use proptest::prelude::*;
use rins_ekf::{
    CovarianceError, FactorisedFilter, Filter, Measurement, Quantity, Smoother, SmootherError,
    Step, UpdateError,
};

fn filter() -> Filter<2> {
    Filter { state: Vector2::new(1.0, -1.0), covariance: Matrix2::new(4.0, 1.0, 1.0, 2.0) }
}

fn measurement() -> Measurement<1, 2> {
    Measurement::new(Vector1::new(3.0), RowVector2::new(1.0, 0.5), Matrix1::new(0.25))
}

#[track_caller]
fn assert_refused(mut filter: Filter<2>, measurement: &Measurement<1, 2>, why: UpdateError) {
    let before = format!("{filter:?}");
    assert_eq!(filter.update(measurement), Err(why));
    assert_eq!(format!("{filter:?}"), before, "the refusal changed the filter");
}

#[test]
fn refused_measurement_leaves_the_filter_alone() {
    let mut negative = measurement();
    negative.matrix = RowVector2::zeros();
    negative.noise = Matrix1::new(-1.0);
    let why = UpdateError::InnovationNotPositiveDefinite { smallest: -1.0 };
    assert_refused(filter(), &negative, why);
}

#[test]
fn whatever_is_not_finite_is_named() {
    for broken in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let refused = |filter: Filter<2>, measurement: Measurement<1, 2>, quantity| {
            assert_refused(filter, &measurement, UpdateError::NotFinite { quantity });
        };
        let mut bad = filter();
        bad.state[1] = broken;
        refused(bad, measurement(), Quantity::State);
        for index in 0..4 {
            let mut bad = filter();
            bad.covariance[index] = broken;
            refused(bad, measurement(), Quantity::Covariance);
        }
        let mut bad = measurement();
        bad.value[0] = broken;
        refused(filter(), bad, Quantity::Value);
        let mut bad = measurement();
        bad.matrix[1] = broken;
        refused(filter(), bad, Quantity::Matrix);
        let mut bad = measurement();
        bad.noise[0] = broken;
        refused(filter(), bad, Quantity::Noise);
        let cross = Vector2::new(0.0, broken);
        refused(filter(), measurement().correlated_with_state_error(cross), Quantity::Cross);
    }
}

#[test]
fn overflow_is_refused() {
    let mut large = filter();
    large.covariance *= 1e300;
    let mut steep = measurement();
    steep.matrix *= 1e10;
    assert_refused(large, &steep, UpdateError::Overflow);
    let mut far = measurement();
    far.value[0] = f64::MAX;
    let mut other = filter();
    other.state = Vector2::new(-f64::MAX, 0.0);
    assert_refused(other, &far, UpdateError::Overflow);
    // The state does not affect it, and its distance in sigmas overflows.
    let mut sharp = measurement();
    sharp.matrix = RowVector2::zeros();
    sharp.noise[0] = f64::MIN_POSITIVE;
    sharp.value[0] = f64::MAX;
    assert_refused(filter(), &sharp, UpdateError::Overflow);
}

#[test]
fn a_cross_covariance_that_cannot_be_is_refused() {
    // With a correlation with the noise beyond 1, the variance of the first state would be negative.
    let measurement = Measurement::new(Vector1::new(0.0), RowVector2::zeros(), Matrix1::new(1.0))
        .correlated_with_state_error(Vector2::new(3.0, 0.0));
    let why = UpdateError::NegativeVariance { index: 0, variance: -5.0 };
    assert_refused(filter(), &measurement, why);
}

#[test]
fn a_measurement_finer_than_the_covariance_is_refused() {
    let mut wide = filter();
    wide.covariance *= 1e16;
    let before = wide.clone();
    let err = wide.update(&measurement()).unwrap_err();
    assert!(matches!(err, UpdateError::Unresolved { row: 0, ratio } if ratio > 1e14), "{err}");
    assert_eq!(wide, before);
    // A measurement of a single state is resolved, however large its variance was.
    let mut direct = measurement();
    direct.matrix = RowVector2::new(1.0, 0.0);
    wide.update(&direct).unwrap();
    rins_testing::assert_close!(wide.covariance[(0, 0)], 0.25, 1e-12);
}

/// The sum of two states of this variance each, measured with unit noise: half of each variance remains, so that the variance
/// of the sum with correlations neglected is still `variance` times the noise.
fn sum_of_wide_states(variance: f64) -> (Filter<2>, Measurement<1, 2>) {
    let filter =
        Filter { state: Vector2::zeros(), covariance: Matrix2::from_diagonal_element(variance) };
    (filter, Measurement::new(Vector1::new(1.0), RowVector2::new(1.0, 1.0), Matrix1::new(1.0)))
}

/// A matrix may lose ten digits of sixteen, factors eighteen; beyond that a measurement is refused, with the ratio.
#[test]
fn a_measurement_is_resolved_as_far_as_its_form_reaches() {
    type Update = fn(f64) -> Result<(), UpdateError>;
    let plain: Update = |variance| {
        let (mut filter, sum) = sum_of_wide_states(variance);
        filter.update(&sum).map(|_| ())
    };
    let factorised: Update = |variance| {
        let (filter, sum) = sum_of_wide_states(variance);
        let mut filter = FactorisedFilter::new(filter.state, &filter.covariance).unwrap();
        filter.update(&sum).map(|_| ())
    };
    for (form, reach) in [(plain, 1e10), (factorised, 1e18)] {
        assert_eq!(form(0.9 * reach), Ok(()));
        let refused = form(1.1 * reach);
        let Err(UpdateError::Unresolved { row: 0, ratio }) = refused else {
            panic!("{refused:?} beyond {reach:e}")
        };
        rins_testing::assert_close!(ratio / reach, 1.1, 1e-6);
    }
}

/// A measurement without noise: the measured state is known exactly from then on, in both forms.
#[test]
fn a_perfect_reading_makes_its_state_known() {
    let prior = Matrix2::new(4.0, 0.0, 0.0, 2.0);
    let reading = Measurement::new(Vector1::new(3.0), RowVector2::new(1.0, 0.0), Matrix1::new(0.0));
    let known = (Vector2::new(3.0, 0.0), Matrix2::new(0.0, 0.0, 0.0, 2.0));
    let mut plain = Filter { state: Vector2::zeros(), covariance: prior };
    plain.update(&reading).unwrap();
    assert_eq!((plain.state, plain.covariance), known);
    let mut factorised = FactorisedFilter::new(Vector2::zeros(), &prior).unwrap();
    factorised.update(&reading).unwrap();
    assert_eq!((factorised.state, factorised.factors().covariance()), known);
}

/// Only the lower triangle of the noise is used, so that a caller may leave the other unset.
#[test]
fn noise_is_read_from_its_lower_triangle() {
    let whole = Matrix2::new(2.0, 0.5, 0.5, 1.0);
    let mut half = whole;
    half[(0, 1)] = 1e3;
    let update = |noise| {
        let mut filter = filter();
        let both = Measurement::new(Vector2::new(1.0, 2.0), Matrix2::identity(), noise);
        let innovation = filter.update(&both).unwrap();
        (filter, innovation.whitened)
    };
    assert_eq!(update(half), update(whole));
    // A different element below the diagonal would be detected.
    assert_ne!(update(Matrix2::new(2.0, 0.0, 0.0, 1.0)), update(whole));
}

/// A covariance is symmetric to the last bit or invalid: a difference of one bit is due to a wrong step.
#[test]
fn a_covariance_is_symmetric_to_the_last_bit() {
    let off = 1.0_f64.next_up() - 1.0;
    let covariance = Matrix2::new(4.0, 1.0, 1.0 + off, 2.0);
    let found = Filter::new(Vector2::zeros(), covariance).map(|_| ());
    assert_eq!(found, Err(CovarianceError::NotSymmetric { row: 1, column: 0, difference: off }));
}

#[test]
fn a_start_must_have_a_covariance() {
    let start = |covariance| Filter::new(Vector2::zeros(), covariance).map(|_| ());
    assert_eq!(start(Matrix2::new(4.0, 1.0, 1.0, 2.0)), Ok(()));
    assert_eq!(start(Matrix2::new(0.0, 0.0, 0.0, 2.0)), Ok(()), "a state may be known");
    assert_eq!(
        start(Matrix2::new(4.0, 1.0, 1.5, 2.0)),
        Err(CovarianceError::NotSymmetric { row: 1, column: 0, difference: 0.5 })
    );
    assert_eq!(
        start(Matrix2::new(-4.0, 0.0, 0.0, 2.0)),
        Err(CovarianceError::NotPositiveDefinite { index: 0, variance: -4.0 })
    );
    assert_eq!(
        start(Matrix2::new(4.0, 4.0, 4.0, 2.0)),
        Err(CovarianceError::NotPositiveDefinite { index: 1, variance: -2.0 })
    );
    assert_eq!(
        start(Matrix2::new(0.0, 1.0, 1.0, 2.0)),
        Err(CovarianceError::NotPositiveDefinite { index: 0, variance: 0.0 })
    );
    assert_eq!(
        start(Matrix2::new(f64::NAN, 1.0, 1.0, 2.0)),
        Err(CovarianceError::NotFinite { quantity: Quantity::Covariance })
    );
    let err = Filter::new(Vector2::new(0.0, f64::NAN), Matrix2::identity()).unwrap_err();
    assert_eq!(err, CovarianceError::NotFinite { quantity: Quantity::State });
}

#[test]
fn a_record_that_cannot_be_smoothed_says_which_step() {
    let step = |filter: Filter<2>| Step {
        transition: Matrix2::identity(),
        noise: Matrix2::zeros(),
        predicted: filter.clone(),
        filtered: filter,
    };
    let mut smoother = Smoother::new(filter());
    smoother.push(step(filter()));
    let mut known = filter();
    known.covariance = Matrix2::zeros();
    smoother.push(step(known));
    assert_eq!(smoother.smoothed(), Err(SmootherError::PredictedNotPositiveDefinite { step: 1 }));

    let mut smoother = Smoother::new(filter());
    let mut broken = filter();
    broken.state.x = f64::INFINITY;
    smoother.push(step(broken));
    smoother.push(step(filter()));
    assert_eq!(smoother.smoothed(), Err(SmootherError::NotFinite { step: 1 }));
}

#[test]
fn an_empty_record_gives_back_the_start() {
    let smoothed = Smoother::new(filter()).smoothed().unwrap();
    assert_eq!(smoothed.len(), 1);
    assert_eq!((smoothed[0].state, smoothed[0].covariance), (filter().state, filter().covariance));
}

#[test]
fn messages_carry_the_numbers() {
    let cases: [(UpdateError, &str); 5] = [
        (
            UpdateError::NotFinite { quantity: Quantity::Noise },
            "the measurement noise holds a number that is not finite",
        ),
        (UpdateError::InnovationNotPositiveDefinite { smallest: -1.0 }, "-1e0"),
        (UpdateError::NegativeVariance { index: 7, variance: -0.5 }, "state 7"),
        (UpdateError::Unresolved { row: 3, ratio: 1e14 }, "row 3"),
        (UpdateError::Overflow, "scale"),
    ];
    for (error, part) in cases {
        assert!(error.to_string().contains(part), "{error}");
    }
}

proptest! {
    #[test]
    fn no_input_makes_a_state_that_is_not_finite(
        state in prop::array::uniform2(any::<f64>()),
        covariance in prop::array::uniform2(prop::array::uniform2(any::<f64>())),
        value: f64,
        matrix in prop::array::uniform2(any::<f64>()),
        noise: f64,
        cross in prop::option::of(prop::array::uniform2(any::<f64>())),
    ) {
        let mut filter =
            Filter { state: Vector2::from(state), covariance: Matrix2::from(covariance) };
        let before = filter.clone();
        let measurement = Measurement {
            value: Vector1::new(value),
            matrix: RowVector2::from([[matrix[0]], [matrix[1]]]),
            noise: Matrix1::new(noise),
            cross: cross.map(Vector2::from),
        };
        match filter.update(&measurement) {
            Ok(innovation) => {
                let numbers = filter.state.iter().chain(&filter.covariance);
                prop_assert!(numbers.chain(&innovation.value).all(|x| x.is_finite()));
            }
            Err(_) => prop_assert_eq!(format!("{filter:?}"), format!("{before:?}")),
        }
    }
}
