//! The measurement of a sample in the form of the generic filter, and the reason for its refusal.

use nalgebra::{SMatrix, SVector};
use rins_ekf::{Filter, Measurement, UpdateError};
use rins_lanes::Vector;

use crate::filter::MEASUREMENTS;
use crate::kernel::{Kernel, WithAxis};
use crate::layout::{ATTITUDE, AXIS, POSITION, SPIN_AXIS_ERRORS, STATES, VELOCITY};
use crate::structured::{Comparison, UpdateResult, With};

impl Comparison<f64, STATES> {
    /// The measurements of zero velocity, with the error `velocity` of the computed velocity, and of the three rows, as one
    /// measurement of all states.
    pub(crate) fn measurement(
        &self,
        velocity: &Vector<f64>,
        velocity_noise: f64,
    ) -> Measurement<MEASUREMENTS, STATES> {
        let by = self.by_attitude.lane(0);
        let z = SVector::from_fn(
            |row, _| {
                if row < 3 { velocity[row] } else { self.difference[row - 3] }
            },
        );
        let mut h = SMatrix::<f64, MEASUREMENTS, STATES>::zeros();
        h.fixed_view_mut::<3, 3>(0, VELOCITY.start()).fill_with_identity();
        h.fixed_view_mut::<3, 3>(3, ATTITUDE.start()).copy_from(&by);
        h.fixed_view_mut::<3, 2>(3, POSITION.start()).copy_from(&by.fixed_columns::<2>(0));
        match self.with {
            With::Rates(amounts) => h
                .fixed_view_mut::<3, 3>(3, SPIN_AXIS_ERRORS.start())
                .fill_diagonal(amounts[SPIN_AXIS_ERRORS.start()]),
            With::Axis => h.fixed_view_mut::<3, 3>(3, AXIS.start()).copy_from(&-by),
        }
        let r = SVector::<f64, MEASUREMENTS>::from_fn(|row, _| {
            if row < 3 { velocity_noise * velocity_noise } else { self.noise[row - 3] }
        });
        let measurement = Measurement::new(z, h, SMatrix::from_diagonal(&r));
        match &self.cross {
            None => measurement,
            Some(with_attitude) => {
                let mut cross = SMatrix::<f64, STATES, MEASUREMENTS>::zeros();
                cross.fixed_view_mut::<3, 3>(ATTITUDE.start(), 3).copy_from(&with_attitude.lane(0));
                measurement.correlated_with_state_error(cross)
            }
        }
    }
}

impl UpdateResult<f64, STATES> {
    /// The log-density of the six innovations.
    pub(crate) fn log_likelihood(&self) -> f64 {
        let dof = MEASUREMENTS as f64;
        let nis: f64 = self.whitened.iter().map(|nu| nu * nu).sum();
        let density: f64 = self.inverse_scales.iter().product();
        libm::log(density) - 0.5 * (nis + dof * libm::log(core::f64::consts::TAU))
    }
}

impl Kernel<f64, WithAxis, STATES> {
    /// The reason why a measurement cannot be used.
    pub(crate) fn refusal(
        &self,
        comparison: &Comparison<f64, STATES>,
        velocity: &Vector<f64>,
    ) -> UpdateError {
        // The covariance after the failed update leads to the same error.
        let measurement = comparison.measurement(velocity, self.setup.velocity_noise);
        self.dense().update(&measurement).err().unwrap_or(UpdateError::Overflow)
    }

    /// State and covariance in the form of the generic filter.
    pub(crate) fn dense(&self) -> Filter<STATES> {
        let p = &self.covariance;
        Filter {
            state: SVector::zeros(),
            covariance: SMatrix::from_fn(|row, column| p.get(row, column)),
        }
    }
}
