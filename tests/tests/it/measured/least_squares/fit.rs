//! Gauss-Newton fits of the errors of accelerometers and gyros.

use std::ops::Range;

use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, SMatrix, SVector, Vector3};

use super::samples::Samples;

const STANDARD_GRAVITY: f64 = 9.80665;

/// The number of Gauss-Newton steps: far more than necessary.
const STEPS: usize = 40;

/// The data sheet of the accelerometers, and gravity at the site \[m/s²\].
pub(super) struct Priors {
    /// \[g\]
    pub(super) bias: f64,
    pub(super) scale: f64,
    /// Of each of the two misalignments in a sum \[rad\].
    pub(super) misalignment: f64,
    pub(super) gravity: f64,
}

type Nine = SVector<f64, 9>;

/// Three biases, three scale errors and the sums of the misalignments xy, xz and yz, in SI units.
pub(super) struct Accelerometers {
    pub(super) values: Nine,
    pub(super) sigmas: Nine,
}

/// Measured per true specific force, with symmetric misalignments.
fn shape(values: &Nine) -> Matrix3<f64> {
    let half = |place: usize| 0.5 * values[place];
    let (x, y, z) = (1.0 + values[3], 1.0 + values[4], 1.0 + values[5]);
    Matrix3::new(x, half(6), half(7), half(6), y, half(8), half(7), half(8), z)
}

fn force(values: &Nine, reading: &Vector3<f64>) -> Vector3<f64> {
    let bias = Vector3::new(values[0], values[1], values[2]);
    shape(values).try_inverse().expect("errors are small") * (reading - bias)
}

impl Accelerometers {
    /// The fit to the mean readings over static intervals; the noise of a mean is the scatter of the residuals.
    pub(super) fn fit(means: &[Vector3<f64>], priors: &Priors) -> Self {
        let residuals = |values: &Nine| -> DVector<f64> {
            let one = |mean: &Vector3<f64>| force(values, mean).norm() - priors.gravity;
            DVector::from_iterator(means.len(), means.iter().map(one))
        };
        let sum = priors.misalignment * std::f64::consts::SQRT_2;
        let bias = priors.bias * STANDARD_GRAVITY;
        let scale = priors.scale;
        let sigmas = Nine::from([bias, bias, bias, scale, scale, scale, sum, sum, sum]);
        let weight = SMatrix::<f64, 9, 9>::from_diagonal(&sigmas.map(|sigma| sigma.powi(-2)));
        let mut values = Nine::zeros();
        let mut covariance = SMatrix::<f64, 9, 9>::zeros();
        let mut noise = 0.01;
        for _ in 0..STEPS {
            let residual = residuals(&values);
            let mut derivative = DMatrix::zeros(means.len(), 9);
            for place in 0..9 {
                let mut away = Nine::zeros();
                away[place] = 1e-6;
                let slope = (residuals(&(values + away)) - residuals(&(values - away))) / 2e-6;
                derivative.set_column(place, &slope);
            }
            let transposed = derivative.transpose() / f64::powi(noise, 2);
            let information = (&transposed * &derivative).fixed_view::<9, 9>(0, 0).into_owned();
            covariance = (information + weight).try_inverse().expect("the priors bound it");
            let gradient = (&transposed * &residual).fixed_rows::<9>(0).into_owned();
            values -= covariance * (gradient + weight * values);
            let used = (covariance * information).trace();
            noise = (residual.norm_squared() / (means.len() as f64 - used)).sqrt();
        }
        Self { values, sigmas: covariance.diagonal().map(f64::sqrt) }
    }

    /// The specific force of a reading.
    pub(super) fn force(&self, reading: &Vector3<f64>) -> Vector3<f64> {
        force(&self.values, reading)
    }
}

/// Scale errors on the diagonal and misalignments off the diagonal of the gyros, with their sigmas.
pub(super) struct Gyros {
    pub(super) errors: Matrix3<f64>,
    pub(super) sigmas: Matrix3<f64>,
}

impl Gyros {
    /// The fit of the direction of gravity after each turn, from that before it and the integral of the gyros; the method of
    /// IMU-TK.
    pub(super) fn fit(
        samples: &Samples,
        intervals: &[Range<usize>],
        biases: &[Vector3<f64>],
        up: &[Vector3<f64>],
    ) -> Self {
        let turns = intervals.len() - 1;
        let residuals = |errors: &Matrix3<f64>| -> DVector<f64> {
            let inverse = (Matrix3::identity() + errors).try_inverse().expect("errors are small");
            let mut residuals = DVector::zeros(3 * turns);
            for turn in 0..turns {
                let bias = 0.5 * (biases[turn] + biases[turn + 1]);
                let mut direction = up[turn];
                for reading in &samples.gyro[intervals[turn].end..intervals[turn + 1].start] {
                    let rate = inverse * (reading - bias);
                    direction = Rotation3::new(-rate * samples.interval) * direction;
                }
                residuals.fixed_rows_mut::<3>(3 * turn).copy_from(&(direction - up[turn + 1]));
            }
            residuals
        };
        let mut errors = Matrix3::zeros();
        let mut sigmas = Matrix3::zeros();
        for _ in 0..6 {
            let residual = residuals(&errors);
            let mut derivative = DMatrix::zeros(3 * turns, 9);
            for place in 0..9 {
                let mut away = errors;
                away[place] += 1e-5;
                derivative.set_column(place, &((residuals(&away) - &residual) / 1e-5));
            }
            let transposed = derivative.transpose();
            let inverse = (&transposed * &derivative).try_inverse().expect("turns about all axes");
            let step = &inverse * (&transposed * &residual);
            errors -= Matrix3::from_column_slice(step.as_slice());
            // A direction has two components.
            let noise = residual.norm_squared() / (2.0 * turns as f64 - 9.0);
            let variances = inverse.diagonal() * noise;
            sigmas = Matrix3::from_column_slice(variances.as_slice()).map(f64::sqrt);
        }
        Self { errors, sigmas }
    }
}
