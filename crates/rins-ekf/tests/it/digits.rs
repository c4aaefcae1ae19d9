//! The precision of the sigmas in long runs from wide priors, compared with arithmetic of 200 bits.

use nalgebra::{RowSVector, SMatrix, SVector};
use rins_ekf::{FactorisedFilter, Factors, Filter, Measurement, UpdateError, congruence};
use rins_testing::LongCovariance;

/// The tolerance of a sigma.
const SIX_DIGITS: f64 = 1e-6;

const INTERVAL: f64 = 0.1;

/// Rows: three of velocity, three of rate. Sources: three of each.
const ROWS: usize = 6;

/// A vehicle's position and velocity, and constants that drive it in proportion to a rotating signal; two of the constants
/// always act together, so that no measurement distinguishes them.
struct Step<const N: usize> {
    transition: SMatrix<f64, N, N>,
    by: SMatrix<f64, N, ROWS>,
    variances: SVector<f64, ROWS>,
    measurement: Measurement<ROWS, N>,
}

impl<const N: usize> Step<N> {
    fn at(index: usize) -> Self {
        let time = INTERVAL * index as f64;
        let mut transition = SMatrix::<f64, N, N>::identity();
        let mut matrix = SMatrix::<f64, ROWS, N>::zeros();
        for axis in 0..3 {
            transition[(axis, 3 + axis)] = INTERVAL;
            matrix[(axis, 3 + axis)] = 1.0;
        }
        for constant in 6..N {
            // The last one is a copy of the third one before it, which drives the same axis.
            let kind = if constant == N - 1 { constant - 3 } else { constant };
            let drive = (0.3 * kind as f64 * time + kind as f64).cos();
            transition[(3 + constant % 3, constant)] = INTERVAL * drive;
            matrix[(3 + constant % 3, constant)] = drive;
        }
        // The rates' noise drives the velocity, too.
        let mut by = SMatrix::<f64, N, ROWS>::zeros();
        let mut cross = SMatrix::<f64, N, ROWS>::zeros();
        for axis in 0..3 {
            by[(3 + axis, axis)] = 1.0;
            by[(3 + axis, 3 + axis)] = -INTERVAL;
            cross[(3 + axis, 3 + axis)] = -INTERVAL;
        }
        let variances = SVector::from([0.01, 0.01, 0.01, 1.0, 1.0, 1.0]);
        let noise = SMatrix::from_diagonal(&SVector::from([0.25, 0.25, 0.25, 1.0, 1.0, 2.0]));
        let measurement =
            Measurement::new(SVector::zeros(), matrix, noise).correlated_with_state_error(cross);
        Self { transition, by, variances, measurement }
    }

    fn noise(&self) -> SMatrix<f64, N, N> {
        congruence(&self.by, &SMatrix::from_diagonal(&self.variances))
    }
}

/// The initial variances: position and velocity equal to the measurement noise, constants `ratio` times that.
fn prior<const N: usize>(ratio: f64) -> SVector<f64, N> {
    SVector::from_fn(|index, _| if index < 6 { 1.0 } else { ratio })
}

/// The combinations whose sigmas are compared: each state, each measured row, and the sum and difference of the equal
/// constants.
fn combinations<const N: usize>(step: &Step<N>) -> Vec<RowSVector<f64, N>> {
    let state = |index| RowSVector::from_fn(|_, j| if j == index { 1.0 } else { 0.0 });
    let mut all: Vec<_> = (0..N).map(state).collect();
    all.extend((0..ROWS).map(|row| step.measurement.matrix.row(row).into_owned()));
    all.push(state(N - 4) + state(N - 1));
    all.push(state(N - 4) - state(N - 1));
    all
}

/// The largest relative error of a sigma anywhere in a run from a prior variance of `ratio` times that of the noise.
fn worst<const N: usize, Form>(
    (start, ratio): (Form, f64),
    mut advance: impl FnMut(&mut Form, &Step<N>) -> Result<(), UpdateError>,
    variance: impl Fn(&Form, &RowSVector<f64, N>) -> f64,
) -> Result<f64, UpdateError> {
    let prior = prior::<N>(ratio);
    let mut reference = LongCovariance::new(|i, j| if i == j { prior[i] } else { 0.0 });
    let mut form = start;
    let mut worst = 0.0_f64;
    for index in 0..60 {
        let step = Step::at(index);
        reference.predict(&step.transition, &step.noise());
        let Measurement { matrix, noise, cross, .. } = &step.measurement;
        reference.update(matrix, noise, &cross.unwrap());
        advance(&mut form, &step)?;
        if index % 10 == 9 {
            for combination in combinations(&step) {
                let want = reference.variance_of(&combination);
                let error = (variance(&form, &combination) / want).sqrt() - 1.0;
                worst = worst.max(if error.is_nan() { f64::INFINITY } else { error.abs() });
            }
        }
    }
    Ok(worst)
}

fn worst_of_factors<const N: usize>(ratio: f64) -> Result<f64, UpdateError> {
    let factors = Factors::of_sources(&SMatrix::identity(), &prior::<N>(ratio));
    let filter = FactorisedFilter::from_factors(SVector::zeros(), factors);
    let advance = |filter: &mut FactorisedFilter<N>, step: &Step<N>| {
        filter.predict(&step.transition, &step.by, &step.variances);
        filter.update(&step.measurement).map(|_| ())
    };
    worst((filter, ratio), advance, |filter, by| filter.factors().variance_of(by))
}

fn worst_of_plain<const N: usize>(ratio: f64) -> Result<f64, UpdateError> {
    let covariance = SMatrix::from_diagonal(&prior::<N>(ratio));
    let filter = Filter { state: SVector::zeros(), covariance };
    let advance = |filter: &mut Filter<N>, step: &Step<N>| {
        filter.predict(&step.transition, &step.noise());
        filter.update(&step.measurement).map(|_| ())
    };
    worst((filter, ratio), advance, |filter, by| (by * filter.covariance * by.transpose())[0])
}

#[test]
fn factors_keep_six_digits_over_sixteen_decades() {
    for decades in [0, 4, 8, 12, 14, 16] {
        let ratio = 10_f64.powi(decades);
        for error in [worst_of_factors::<12>(ratio), worst_of_factors::<24>(ratio)] {
            let error = error.unwrap();
            assert!(error < SIX_DIGITS, "{error:e} at {decades} decades");
        }
    }
}

#[test]
fn factors_refuse_what_they_cannot_hold() {
    for decades in [17, 18, 20, 24, 30] {
        match worst_of_factors::<12>(10_f64.powi(decades)) {
            Ok(error) => assert!(error < SIX_DIGITS, "{error:e} at {decades} decades"),
            Err(error) => assert!(matches!(error, UpdateError::Unresolved { .. }), "{error}"),
        }
    }
}

#[test]
fn a_matrix_keeps_six_digits_then_three_and_then_refuses() {
    let mut lost = 0.0_f64;
    for decades in [0, 2, 4, 6, 8, 9, 10, 11, 12, 14, 16] {
        let within = if decades <= 6 { SIX_DIGITS } else { 1e-3 };
        let ratio = 10_f64.powi(decades);
        for error in [worst_of_plain::<12>(ratio), worst_of_plain::<24>(ratio)] {
            match error {
                Ok(error) => {
                    assert!(error < within, "{error:e} at {decades} decades");
                    lost = lost.max(error);
                }
                Err(error) => {
                    assert!(matches!(error, UpdateError::Unresolved { .. }), "{error}");
                    assert!(decades > 9, "refused at {decades} decades");
                }
            }
        }
    }
    assert!(lost > SIX_DIGITS, "the run is one that takes digits: {lost:e}");
}
