//! The filter step on the factors of the covariance, for cases in which the plain form loses precision.

use nalgebra::{SMatrix, SVector, Vector3};
use rins_ekf::{CovarianceError, FactorisedFilter, Factors, Quantity, UpdateError};
use rins_lanes::Vector;

use crate::filter::{AngleSource, MEASUREMENTS, Start, StartSigmas};
use crate::kernel::{Interval, Kernel, WithAxis};
use crate::layout::{ATTITUDE, AXIS, POSITION, SPIN_AXIS_ERRORS, STATES, VELOCITY};
use crate::setup::Setup;
use crate::structured::{Comparison, Covariance, Means, UpdateResult};

/// The relative rounding error of a variance after thousands of plain steps. Relative to the noise of a measurement it is
/// less than 1e-6, since no measurement was more than 1e7 times as precise (ratio of variances).
const OF_PLAIN: f64 = 1e-13;

/// The number of noise inputs: three velocities and three attitudes.
const SOURCES: usize = 6;

/// The dependence of the states on independent sources, and the variances of the sources.
type Sources = (SMatrix<f64, STATES, STATES>, SVector<f64, STATES>);

/// `Φ`, the input matrix of the noise sources, and their variances.
type DenseTransition =
    (SMatrix<f64, STATES, STATES>, SMatrix<f64, STATES, SOURCES>, SVector<f64, SOURCES>);

impl Start {
    /// The factors of the covariance, which retain what the covariance loses by rounding: the attitudes of body and axis
    /// differ only by the error of a reading. `None` if the axis' covariance is invalid.
    pub(crate) fn factors(&self, setup: &Setup) -> Option<Factors<STATES>> {
        let (by, variances) = self.sources(setup).ok()?;
        Some(Factors::of_sources(&by, &variances))
    }

    /// The dependence of the initial states on independent sources, and their variances: the error of the axis is common to
    /// axis and body, and the error of the reading is that of the body alone.
    fn sources(&self, setup: &Setup) -> Result<Sources, CovarianceError> {
        let StartSigmas { position, velocity, reading, sensor } = StartSigmas::of(setup);
        let axis = Factors::<3>::of(&self.axis_covariance)?;
        let mut by = SMatrix::identity();
        ATTITUDE.set(ATTITUDE, &mut by, self.nav_from_table.matrix());
        ATTITUDE.set(AXIS, &mut by, axis.upper());
        AXIS.set(AXIS, &mut by, axis.upper());
        let mut variances = SVector::zeros();
        let square = |sigmas: Vector3<f64>| sigmas.component_mul(&sigmas);
        POSITION.set_in(&mut variances, &square(position));
        VELOCITY.set_in(&mut variances, &square(velocity));
        if self.angle_source == AngleSource::Read {
            ATTITUDE.set_in(&mut variances, &square(reading));
        }
        SPIN_AXIS_ERRORS.set_in(&mut variances, &square(sensor));
        AXIS.set_in(&mut variances, axis.variances());
        Ok((by, variances))
    }
}

impl Kernel<f64, WithAxis, STATES> {
    /// Propagates the factors over an interval.
    pub(crate) fn carry_factors(
        &self,
        filter: &mut FactorisedFilter<STATES>,
        interval: &Interval<f64>,
        means: &Means<f64>,
    ) {
        let (phi, by, variances) = self.dense_transition(interval, means);
        filter.predict(&phi, &by, &variances);
    }

    /// `Φ`, and the noise sources: their input matrix and their variances.
    fn dense_transition(&self, interval: &Interval<f64>, means: &Means<f64>) -> DenseTransition {
        let transition = self.transition(interval, means);
        let mut phi = SMatrix::<f64, STATES, STATES>::identity();
        for column in &mut phi.data.0 {
            *column = transition.times(*column);
        }
        let mut by = SMatrix::<f64, STATES, SOURCES>::zeros();
        by.fixed_view_mut::<3, 3>(VELOCITY.start(), 0).fill_with_identity();
        by.fixed_view_mut::<3, 3>(ATTITUDE.start(), 3).fill_with_identity();
        let [of_velocity, of_attitude] = transition.noise();
        let variances = SVector::from_fn(|k, _| if k < 3 { of_velocity } else { of_attitude });
        (phi, by, variances)
    }

    /// The factors of a covariance that was in plain form until now.
    pub(crate) fn factors(&self) -> Result<Factors<STATES>, UpdateError> {
        Factors::of_rounded(&self.dense().covariance, OF_PLAIN).map_err(|error| match error {
            CovarianceError::NotPositiveDefinite { index, variance } => {
                UpdateError::NegativeVariance { index, variance }
            }
            _ => UpdateError::NotFinite { quantity: Quantity::Covariance },
        })
    }

    /// The update of the factors: its result and log-likelihood.
    pub(crate) fn update_factors(
        &mut self,
        filter: &mut FactorisedFilter<STATES>,
        comparison: &Comparison<f64, STATES>,
        velocity: &Vector<f64>,
    ) -> Result<(UpdateResult<f64, STATES>, f64), UpdateError> {
        let measurement = comparison.measurement(velocity, self.setup.velocity_noise);
        let innovation = filter.update(&measurement)?;
        let p = filter.factors().covariance();
        self.covariance = Covariance::from_fn(0.0, |row, column| p[(row, column)]);
        let found = UpdateResult {
            whitened: innovation.whitened.into(),
            inverse_scales: [f64::NAN; MEASUREMENTS],
            state: filter.state.into(),
        };
        // The state is transferred to the navigator.
        filter.state.fill(0.0);
        Ok((found, innovation.log_likelihood()))
    }
}

#[cfg(test)]
mod tests;
