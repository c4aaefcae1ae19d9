//! The precision of the sigmas, compared with the same update in exact rational numbers.

use nalgebra::{SMatrix, SVector};
use num_rational::BigRational;
use num_traits::ToPrimitive;
use rins_ekf::{Filter, Measurement, UpdateError};

const N: usize = 4;

fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).unwrap()
}

fn float(x: &BigRational) -> f64 {
    x.to_f64().unwrap()
}

/// The covariance after one scalar measurement `row` with variance 1: `P − P hᵀ h P / (h P hᵀ + 1)`.
fn updated(p: &[Vec<BigRational>], row: &[f64; N]) -> Vec<Vec<BigRational>> {
    let with: Vec<BigRational> =
        (0..N).map(|i| (0..N).map(|k| &p[i][k] * exact(row[k])).sum()).collect();
    let s: BigRational = (0..N).map(|k| exact(row[k]) * &with[k]).sum::<BigRational>() + exact(1.0);
    (0..N).map(|i| (0..N).map(|j| &p[i][j] - &with[i] * &with[j] / &s).collect()).collect()
}

/// Four rows that measure combinations of all four states.
const ROWS: [[f64; N]; 4] = [
    [1.0, 0.5, 0.25, -0.75],
    [0.5, -1.0, 1.5, 0.25],
    [-0.25, 0.75, 1.0, 1.25],
    [1.5, 0.25, -0.5, 1.0],
];

/// The number of rows in an update.
#[derive(Clone, Copy, Debug)]
enum Rows {
    One,
    All,
}

/// The largest relative error of a sigma after all rows, from a prior variance of `ratio` times that of the measurements.
fn sigma_error(ratio: f64, rows: Rows) -> Result<f64, UpdateError> {
    let mut p: Vec<Vec<BigRational>> =
        (0..N).map(|i| (0..N).map(|j| exact(if i == j { ratio } else { 0.0 })).collect()).collect();
    for row in &ROWS {
        p = updated(&p, row);
    }
    let mut filter =
        Filter::<N> { state: SVector::zeros(), covariance: SMatrix::identity() * ratio };
    match rows {
        Rows::One => {
            for row in &ROWS {
                let matrix = SMatrix::<f64, 1, N>::from_row_slice(row);
                let noise = SMatrix::identity();
                filter.update(&Measurement::new(SVector::<f64, 1>::zeros(), matrix, noise))?;
            }
        }
        Rows::All => {
            let matrix = SMatrix::<f64, 4, N>::from_fn(|i, j| ROWS[i][j]);
            let noise = SMatrix::identity();
            filter.update(&Measurement::new(SVector::<f64, 4>::zeros(), matrix, noise))?;
        }
    }
    let errors = (0..N).map(|i| (filter.covariance[(i, i)] / float(&p[i][i])).sqrt() - 1.0);
    Ok(errors.fold(0.0, |worst: f64, x| worst.max(x.abs())))
}

#[test]
fn rows_taken_at_once_keep_all_digits_over_sixteen_decades() {
    for decades in 0..=16 {
        let error = sigma_error(10_f64.powi(decades), Rows::All).unwrap();
        assert!(error < 1e-14, "{error:e} at {decades} decades");
    }
}

#[test]
fn rows_taken_in_turn_keep_six_digits_over_nine_decades() {
    for decades in 0..=9 {
        let error = sigma_error(10_f64.powi(decades), Rows::One).unwrap();
        assert!(error < 1e-6, "{error:e} at {decades} decades");
    }
}

#[test]
fn what_the_covariance_cannot_hold_is_refused() {
    for decades in 10..=30 {
        match sigma_error(10_f64.powi(decades), Rows::One) {
            Ok(error) => assert!(error < 1e-3, "{error:e} at {decades} decades"),
            Err(error) => {
                assert!(matches!(error, UpdateError::Unresolved { .. }), "{error}");
                assert!(decades > 9, "refused at {decades} decades");
            }
        }
    }
}
