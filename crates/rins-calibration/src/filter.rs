//! The paper's filter, eqs. (10)-(21), in closed-loop form.

use nalgebra::{ComplexField, Matrix3, RowSVector, SMatrix, SVector, Vector3};
use rins_ekf::{FactorisedFilter, Factors, UpdateError};
use rins_frames::{Body, Dcm, InFrame, Increments, Nav, Site, Table};
use rins_imu::TriadError;
use rins_lanes::Vector;
use rins_motion::NavState;

use crate::kernel::{Kernel, PLAIN, Reading, Sample, WithAxis};
use crate::layout::{ATTITUDE, AXIS, POSITION, SPIN_AXIS_ERRORS, STATES, VELOCITY};
use crate::setup::Setup;

/// The number of measurements in a sample: three of velocity, three of rate or angle.
pub const MEASUREMENTS: usize = 6;

/// 1σ of the surveyed position, as a length \[m\].
///
/// No result depends on it; it only keeps the covariance positive definite.
const POSITION_SIGMA: f64 = 1e-3;

/// The table measurement at the end of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableReading {
    /// The angle read from an encoder \[rad\].
    Angle(f64),
    /// The mean commanded rate over the sample \[rad/s\].
    Rate(f64),
}

/// The form in which a filter stores its covariance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A matrix.
    Plain,
    /// Factors `U D Uᵀ`.
    Factorised,
}

/// The reference of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// The base's velocity \[m/s\]: zero on a fixed table.
    pub velocity: InFrame<Nav>,
    /// The table measurement.
    pub table: TableReading,
}

impl Reference {
    /// The reference on a table with a fixed position.
    pub const fn fixed(table: TableReading) -> Self {
        Self { velocity: InFrame::zeros(), table }
    }
}

/// The initial state of the filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The attitude of the axis frame.
    pub nav_from_table: Dcm<Nav, Table>,
    /// The covariance of its error, in n \[rad²\].
    pub axis_covariance: Matrix3<f64>,
    /// The table angle \[rad\].
    pub angle: f64,
    /// Whether that angle has the noise of a reading or is exact by definition.
    pub angle_source: AngleSource,
}

/// The source of the initial table angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleSource {
    /// An encoder, with its noise.
    Read,
    /// Definition: the rate is commanded from here on, so that the angle has no error.
    Defined,
}

/// A strapdown navigator with zero velocity and table measurements that estimates the gyro errors along the spin axis.
///
/// Every sample is compensated with the current estimate, integrated, and compared with zero velocity (Z1, eqs. (16)-(18))
/// and with the table. For a commanded rate the second measurement is Z2 of eqs. (20) and (21): the noise of the gyro is then
/// in the prediction and in the measurement, and the filter includes this correlation. For an encoder the computed attitude
/// is compared with the axis frame rotated by the measured angle; the noise of an encoder, differenced into a rate, would be
/// a hundred times that of the gyro. The corrections are applied to navigator and estimate immediately.
#[derive(Clone, Debug)]
pub struct SpinAxisFilter {
    kernel: Kernel<f64, WithAxis, STATES>,
    /// The initial factors of the covariance, until the first sample.
    beginning: Option<Box<Factors<STATES>>>,
    /// The factors of the covariance as soon as they are needed; the kernel's covariance is then a copy for readers.
    factorised: Option<Box<FactorisedFilter<STATES>>>,
    log_likelihood: f64,
}

impl SpinAxisFilter {
    /// A filter that starts with a stationary base.
    pub fn new(setup: Setup, start: &Start) -> Self {
        let Start { nav_from_table, angle, .. } = *start;
        let nav_from_body = nav_from_table * Dcm::<Table, Body>::about_z(angle);
        let p = start.covariance(&setup);
        let attitudes = [nav_from_body.matrix(), nav_from_table.matrix()];
        let kernel = Kernel::at_rest(0.0, &setup, attitudes, |row, column| p[(row, column)]);
        let beginning = start.factors(&setup).map(Box::new);
        Self { kernel, beginning, factorised: None, log_likelihood: 0.0 }
    }

    /// The current estimate of `M_xz`, `M_yz` \[rad\] and `S_z`.
    pub fn estimate(&self) -> Vector3<f64> {
        self.kernel.estimate.into()
    }

    /// The estimate as a sensor error, for the compensation.
    pub fn gyro_error(&self) -> TriadError {
        gyro_error(&self.estimate())
    }

    /// The covariance of all states, in the order of [`crate::layout`].
    pub fn covariance(&self) -> SMatrix<f64, STATES, STATES> {
        SMatrix::from_fn(|row, column| self.kernel.covariance.get(row, column))
    }

    /// The current estimate of the attitude of the axis frame.
    pub fn nav_from_table(&self) -> Dcm<Nav, Table> {
        Dcm::from_kernel(self.kernel.nav_from_table.lane(0))
    }

    #[cfg(test)]
    pub(crate) const fn kernel(&self) -> &Kernel<f64, WithAxis, STATES> {
        &self.kernel
    }

    /// The variance of a linear combination of states, in the order of [`crate::layout`].
    ///
    /// It is more precise than from the covariance for a combination whose variance is much smaller than those of its states.
    pub fn variance_of(&self, combination: &RowSVector<f64, STATES>) -> f64 {
        self.factorised.as_ref().map_or_else(
            || (combination * self.covariance() * combination.transpose())[0],
            |filter| filter.factors().variance_of(combination),
        )
    }

    /// The current form of the covariance.
    pub const fn form(&self) -> Form {
        if self.factorised.is_some() { Form::Factorised } else { Form::Plain }
    }

    /// The log-likelihood of all measurements so far under this setup.
    pub const fn log_likelihood(&self) -> f64 {
        self.log_likelihood
    }

    /// Position, velocity and attitude with all corrections so far.
    pub fn state(&self) -> NavState {
        let navigated = &self.kernel.mechanisation;
        let [latitude, longitude, height] = navigated.place;
        NavState {
            position: Site { latitude, longitude, height },
            velocity: InFrame::from_components(navigated.velocity.into()),
            nav_from_body: Dcm::from_kernel(navigated.nav_from_body.lane(0)),
        }
    }

    /// Processes one sample and its reference; returns the whitened innovations.
    ///
    /// **Form of the covariance.** It is plain up to the first sample in which a measurement is more than 3,000 times as
    /// precise as its prediction, with correlations between states neglected (a ratio of variances of 1e7). From there on it
    /// is stored as factors `U D Uᵀ`, which lose no digits. The plain form is about ten times as fast.
    ///
    /// # Errors
    /// [`UpdateError`] if a value is not finite, the innovation covariance is not positive definite, or the precision of the
    /// factors is insufficient for the reference.
    pub fn step(
        &mut self,
        sample: &Increments,
        reference: &Reference,
    ) -> Result<SVector<f64, MEASUREMENTS>, UpdateError> {
        let sample = Sample {
            angle: Vector::from(*sample.angle.components()),
            velocity: Vector::from(*sample.velocity.components()),
            interval: sample.interval,
        };
        let reading = match reference.table {
            TableReading::Angle(angle) => Reading::Angle({
                let (sin, cos) = ComplexField::sin_cos(angle);
                [sin, cos]
            }),
            TableReading::Rate(rate) => Reading::Rate(rate),
        };
        let kernel = &mut self.kernel;
        let (interval, means) = kernel.navigate(&sample);
        let comparison = kernel.compare(&interval, &reading);
        let off = kernel.mechanisation.velocity - Vector::from(*reference.velocity.components());
        let noise = kernel.setup.velocity_noise;
        if self.factorised.is_none() {
            let before = kernel.covariance;
            kernel.carry(&interval, &means);
            let ratios = kernel.covariance.ratios::<WithAxis>(&comparison, noise);
            let beginning = self.beginning.take();
            if ratios.iter().any(|&ratio| ratio >= PLAIN) {
                kernel.covariance = before;
                let factors = match beginning {
                    Some(factors) => *factors,
                    None => kernel.factors()?,
                };
                let filter = FactorisedFilter::from_factors(SVector::zeros(), factors);
                self.factorised = Some(Box::new(filter));
            }
        }
        if let Some(filter) = &mut self.factorised {
            kernel.carry_factors(filter, &interval, &means);
        }
        let (found, log_likelihood) = if let Some(filter) = &mut self.factorised {
            kernel.update_factors(filter, &comparison, &off)?
        } else {
            let found = kernel.covariance.update::<WithAxis>(&comparison, &off, noise);
            // False for NaN, too.
            let finite = found.whitened.iter().copied().all(f64::is_finite);
            if !(finite && (0..STATES).all(|i| kernel.covariance.get(i, i) >= 0.0)) {
                return Err(kernel.refusal(&comparison, &off));
            }
            (found, found.log_likelihood())
        };
        kernel.correct(&found.state, &interval);
        self.log_likelihood += log_likelihood;
        Ok(SVector::from(found.whitened))
    }
}

impl Start {
    /// The initial covariance of all states.
    pub(crate) fn covariance(&self, setup: &Setup) -> SMatrix<f64, STATES, STATES> {
        let Self { nav_from_table, ref axis_covariance, angle_source, .. } = *self;
        let StartSigmas { position, velocity, reading, sensor } = StartSigmas::of(setup);
        let square = |vector: Vector3<f64>| Matrix3::from_diagonal(&vector.component_mul(&vector));
        let first_reading = match angle_source {
            AngleSource::Read => {
                let c = nav_from_table.matrix();
                c * square(reading) * c.transpose()
            }
            AngleSource::Defined => Matrix3::zeros(),
        };
        let mut p = SMatrix::zeros();
        POSITION.set(POSITION, &mut p, &square(position));
        VELOCITY.set(VELOCITY, &mut p, &square(velocity));
        ATTITUDE.set(ATTITUDE, &mut p, &(axis_covariance + first_reading));
        ATTITUDE.set(AXIS, &mut p, axis_covariance);
        AXIS.set(ATTITUDE, &mut p, axis_covariance);
        AXIS.set(AXIS, &mut p, axis_covariance);
        SPIN_AXIS_ERRORS.set(SPIN_AXIS_ERRORS, &mut p, &square(sensor));
        p
    }
}

/// The sigmas of the independent initial errors, except for those of the axis.
pub(crate) struct StartSigmas {
    /// `δθ_x`, `δθ_y` \[rad\] and `δh` \[m\].
    pub(crate) position: Vector3<f64>,
    /// \[m/s\]
    pub(crate) velocity: Vector3<f64>,
    /// The reading of the table's attitude, in s \[rad\].
    pub(crate) reading: Vector3<f64>,
    /// `M_xz`, `M_yz` \[rad\] and `S_z`.
    pub(crate) sensor: Vector3<f64>,
}

impl StartSigmas {
    pub(crate) fn of(setup: &Setup) -> Self {
        let radius = setup.station.site.meridian_radius();
        let spec = setup.imu.gyro;
        Self {
            position: Vector3::new(1.0 / radius, 1.0 / radius, 1.0) * POSITION_SIGMA,
            velocity: Vector3::repeat(setup.velocity_noise),
            reading: Vector3::new(setup.table.wobble, setup.table.wobble, setup.table.angle_noise),
            sensor: Vector3::new(
                spec.misalignment_sigma,
                spec.misalignment_sigma,
                spec.scale_sigma,
            ),
        }
    }
}

/// The triad error with these `M_xz`, `M_yz` and `S_z`; all other errors are zero.
pub(crate) fn gyro_error(estimate: &Vector3<f64>) -> TriadError {
    let mut matrix = Matrix3::zeros();
    matrix.set_column(2, estimate);
    TriadError { bias: Vector3::zeros(), matrix }
}
