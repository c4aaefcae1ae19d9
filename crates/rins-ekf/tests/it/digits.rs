//! How many digits of the sigmas survive long runs from wide priors, against 200 bits.
#![expect(clippy::needless_range_loop, reason = "indices count through rows of several matrices")]

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use nalgebra::{RowSVector, SMatrix, SVector};
use rins_ekf::{FactorisedFilter, Factors, Filter, Measurement, UpdateError, congruence};

type Number = FBig<HalfEven>;

/// Of the reference's numbers: those of an `f64` thrice over, and some.
const BITS: usize = 200;

/// How far a sigma may be off.
const SIX_DIGITS: f64 = 1e-6;

const INTERVAL: f64 = 0.1;

/// Rows: three of velocity, three of rate. Sources: three of each.
const ROWS: usize = 6;

fn number(x: f64) -> Number {
    Number::try_from(x).unwrap().with_precision(BITS).value()
}

/// A vehicle's position and velocity, and constants that drive it in proportion to what turns; two of the
/// constants always enter together, so that no measurement ever tells them apart.
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
            // The last one is a twin of that three before it, which drives the same axis.
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
}

/// The variances at the start: position and velocity as they are measured, constants `ratio` times so.
fn prior<const N: usize>(ratio: f64) -> SVector<f64, N> {
    SVector::from_fn(|index, _| if index < 6 { 1.0 } else { ratio })
}

/// The textbook's covariance with long numbers.
struct Reference<const N: usize>(Vec<Vec<Number>>);

/// `A Bᵀ`, passing over the zeros of `B`.
fn product<const K: usize, const M: usize>(
    a: &[Vec<Number>],
    b: &SMatrix<f64, M, K>,
) -> Vec<Vec<Number>> {
    let element = |row: &Vec<Number>, column: usize| {
        let mut sum = number(0.0);
        for (k, x) in row.iter().enumerate() {
            if b[(column, k)] != 0.0 {
                sum += x * number(b[(column, k)]);
            }
        }
        sum
    };
    a.iter().map(|row| (0..M).map(|column| element(row, column)).collect()).collect()
}

fn transposed(a: &[Vec<Number>]) -> Vec<Vec<Number>> {
    (0..a[0].len()).map(|j| a.iter().map(|row| row[j].clone()).collect()).collect()
}

impl<const N: usize> Reference<N> {
    fn new(prior: &SVector<f64, N>) -> Self {
        let element = |i, j| number(if i == j { prior[i] } else { 0.0 });
        Self((0..N).map(|i| (0..N).map(|j| element(i, j)).collect()).collect())
    }

    fn step(&mut self, step: &Step<N>) {
        let Step { transition, by, variances, measurement } = step;
        let mut p = product(&transposed(&product(&self.0, transition)), transition);
        let noise = congruence(by, &SMatrix::from_diagonal(variances));
        for i in 0..N {
            for j in 0..N {
                p[i][j] += number(noise[(i, j)]);
            }
        }
        let h = &measurement.matrix;
        let cross = measurement.cross.unwrap();
        // (P Hᵀ + C), a row for each state, and S.
        let mut with = product(&p, h);
        let mut s = product(&transposed(&with), h);
        for i in 0..ROWS {
            for j in 0..ROWS {
                // H C is exact: a row of H has no two elements where a column of C has one.
                let hc = (h * cross)[(i, j)] + (h * cross)[(j, i)];
                s[i][j] += number(measurement.noise[(i, j)]) + number(hc);
            }
        }
        for i in 0..N {
            for j in 0..ROWS {
                with[i][j] += number(cross[(i, j)]);
            }
        }
        // Row by row of S, what it explains of everything is taken away.
        for row in 0..ROWS {
            for i in row + 1..ROWS {
                let share = &s[i][row] / &s[row][row];
                for j in row..ROWS {
                    let less = &share * &s[row][j];
                    s[i][j] -= less;
                }
                for state in &mut with {
                    let less = &share * &state[row];
                    state[i] -= less;
                }
            }
            for i in 0..N {
                let share = &with[i][row] / &s[row][row];
                for j in 0..N {
                    p[i][j] -= &share * &with[j][row];
                }
            }
        }
        self.0 = p;
    }

    fn variance_of(&self, combination: &RowSVector<f64, N>) -> f64 {
        let half = product(&self.0, combination);
        product(&transposed(&half), combination)[0][0].to_f64().value()
    }
}

/// What sigmas are told of: each state, each row that is measured, and the twins' sum and difference.
fn combinations<const N: usize>(step: &Step<N>) -> Vec<RowSVector<f64, N>> {
    let state = |index| RowSVector::from_fn(|_, j| if j == index { 1.0 } else { 0.0 });
    let mut all: Vec<_> = (0..N).map(state).collect();
    all.extend((0..ROWS).map(|row| step.measurement.matrix.row(row).into_owned()));
    all.push(state(N - 4) + state(N - 1));
    all.push(state(N - 4) - state(N - 1));
    all
}

/// The largest relative error of a sigma anywhere in a run from a prior variance of `ratio` times
/// the noise's.
fn worst<const N: usize, Form>(
    (start, ratio): (Form, f64),
    mut advance: impl FnMut(&mut Form, &Step<N>) -> Result<(), UpdateError>,
    variance: impl Fn(&Form, &RowSVector<f64, N>) -> f64,
) -> Result<f64, UpdateError> {
    let mut reference = Reference::new(&prior::<N>(ratio));
    let mut form = start;
    let mut worst = 0.0_f64;
    for index in 0..60 {
        let step = Step::at(index);
        reference.step(&step);
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
        let noise = congruence(&step.by, &SMatrix::from_diagonal(&step.variances));
        filter.predict(&step.transition, &noise);
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
