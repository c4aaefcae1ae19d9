//! The paper's filter, eqs. (10)-(21), closed loop.

use nalgebra::{ComplexField, Matrix3, SMatrix, SVector, Vector3};
use rins_ekf::UpdateError;
use rins_frames::{Body, Dcm, InFrame, Increments, Nav, Site, Table};
use rins_imu::TriadError;
use rins_lanes::Vector;
use rins_motion::NavState;

use crate::kernel::{Kernel, Reading, Sample, WithAxis};
use crate::layout::{ATTITUDE, AXIS, POSITION, SPIN_AXIS_ERRORS, STATES, VELOCITY};
use crate::setup::Setup;

/// How many figures a sample is measured by: three of velocity, three of rate or angle.
pub const MEASUREMENTS: usize = 6;

/// How far the surveyed position may be off at the start, as a length \[m\].
///
/// Nothing here depends on it; it only keeps the covariance positive definite.
const POSITION_SIGMA: f64 = 1e-3;

/// The largest ratio of a measured combination's variance, its states taken apart, to its noise for
/// which the plain update keeps enough digits: what is left has some 1e8 × 1e-16 of rounding in it.
pub(crate) const PLAIN: f64 = 1e8;

/// What the table said at the end of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableReading {
    /// The angle read from an encoder \[rad\].
    Angle(f64),
    /// The mean commanded rate over the sample \[rad/s\].
    Rate(f64),
}

/// What a sample is compared with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// The base's velocity \[m/s\]: zero on a fixed table.
    pub velocity: InFrame<Nav>,
    /// What the table said.
    pub table: TableReading,
}

impl Reference {
    /// The reference on a table that does not move from its place.
    pub const fn fixed(table: TableReading) -> Self {
        Self { velocity: InFrame::zeros(), table }
    }
}

/// How the filter starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The axis frame's attitude.
    pub nav_from_table: Dcm<Nav, Table>,
    /// The covariance of its error, in n \[rad²\].
    pub axis_covariance: Matrix3<f64>,
    /// The table angle \[rad\].
    pub angle: f64,
    /// Whether that angle was read, with the reading's noise, or is so by definition.
    pub angle_source: AngleSource,
}

/// Where the table angle at the start came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AngleSource {
    /// From an encoder, with its noise.
    Read,
    /// The rate is commanded from here on, so that the angle has no error of its own.
    Defined,
}

/// A strapdown navigator that is held to zero velocity and to the table, and learns the gyro
/// errors along the spin axis meanwhile.
///
/// Every sample is compensated with the present estimate, navigated, and compared with zero
/// velocity (Z1, eqs. (16)-(18)) and with the table. Against a commanded rate this is Z2 of eqs. (20)
/// and (21): the gyro's noise then sits in the prediction and in the measurement alike, and their
/// correlation is taken along. Against an encoder the computed attitude is compared with the
/// axis frame turned by the angle read; an encoder's noise, differenced into a rate, would be a
/// hundred times the gyro's. The corrections go back into navigator and estimate at once.
#[derive(Clone, Debug)]
pub struct SpinAxisFilter {
    kernel: Kernel<f64, WithAxis, STATES>,
    log_likelihood: f64,
}

impl SpinAxisFilter {
    /// A filter that starts with the base at rest.
    pub fn new(setup: Setup, start: &Start) -> Self {
        let Start { nav_from_table, angle, .. } = *start;
        let nav_from_body = nav_from_table * Dcm::<Table, Body>::about_z(angle);
        let p = start.covariance(&setup);
        let attitudes = [nav_from_body.matrix(), nav_from_table.matrix()];
        let kernel = Kernel::at_rest(0.0, &setup, attitudes, |row, column| p[(row, column)]);
        Self { kernel, log_likelihood: 0.0 }
    }

    /// `M_xz`, `M_yz` \[rad\] and `S_z` as estimated so far.
    pub fn estimate(&self) -> Vector3<f64> {
        self.kernel.estimate.into()
    }

    /// The estimate as a sensor error that can be compensated.
    pub fn gyro_error(&self) -> TriadError {
        gyro_error(&self.estimate())
    }

    /// The covariance of all states, in the order of [`crate::layout`].
    pub fn covariance(&self) -> SMatrix<f64, STATES, STATES> {
        SMatrix::from_fn(|row, column| self.kernel.covariance.get(row, column))
    }

    /// The attitude of the axis frame as estimated so far.
    pub fn nav_from_table(&self) -> Dcm<Nav, Table> {
        Dcm::from_kernel(self.kernel.nav_from_table.lane(0))
    }

    /// The logarithm of the probability density of all references so far, under this setup.
    pub const fn log_likelihood(&self) -> f64 {
        self.log_likelihood
    }

    /// Position, velocity and attitude, as corrected so far.
    pub fn state(&self) -> NavState {
        let navigated = &self.kernel.mechanisation;
        let [latitude, longitude, height] = navigated.place;
        NavState {
            position: Site { latitude, longitude, height },
            velocity: InFrame::from_components(navigated.velocity.into()),
            nav_from_body: Dcm::from_kernel(navigated.nav_from_body.lane(0)),
        }
    }

    /// Takes in one sample and its reference; returns the whitened innovations.
    ///
    /// Where a reference is so precise, beside what is not known yet, that the plain form of the
    /// update would lose digits of the covariance, the update is Joseph's with dense matrices.
    ///
    /// # Errors
    /// [`UpdateError`] if a figure is not finite, the innovation covariance is not positive definite,
    /// or the covariance could not resolve the reference in Joseph's form either.
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
        let interval = kernel.predict(&sample);
        let comparison = kernel.compare(&interval, &reading);
        let off = kernel.mechanisation.velocity - Vector::from(*reference.velocity.components());
        let noise = kernel.setup.velocity_noise;
        let ratios = kernel.covariance.ratios::<WithAxis>(&comparison, noise);
        let (found, log_likelihood) = if ratios.iter().all(|&ratio| ratio < PLAIN) {
            let found = kernel.covariance.update::<WithAxis>(&comparison, &off, noise);
            // False for what is not a number, too.
            let finite = found.whitened.iter().copied().all(f64::is_finite);
            if !(finite && (0..STATES).all(|i| kernel.covariance.get(i, i) >= 0.0)) {
                return Err(kernel.refusal(&comparison, &off));
            }
            (found, found.log_likelihood())
        } else {
            kernel.update_densely(&comparison, &off)?
        };
        kernel.correct(&found.state, &interval);
        self.log_likelihood += log_likelihood;
        Ok(SVector::from(found.whitened))
    }
}

impl Start {
    /// The covariance of all states that a filter starts with.
    pub(crate) fn covariance(&self, setup: &Setup) -> SMatrix<f64, STATES, STATES> {
        let Self { nav_from_table, ref axis_covariance, angle_source, .. } = *self;
        let radius = setup.station.site.meridian_radius();
        let square = |vector: Vector3<f64>| Matrix3::from_diagonal(&vector.component_mul(&vector));

        let position = Vector3::new(1.0 / radius, 1.0 / radius, 1.0) * POSITION_SIGMA;
        let spec = setup.imu.gyro;
        let sensor =
            Vector3::new(spec.misalignment_sigma, spec.misalignment_sigma, spec.scale_sigma);
        let first_reading = match angle_source {
            AngleSource::Read => angle_noise(setup, &nav_from_table),
            AngleSource::Defined => Matrix3::zeros(),
        };
        let mut p = SMatrix::zeros();
        POSITION.set(POSITION, &mut p, &square(position));
        VELOCITY.set(VELOCITY, &mut p, &square(Vector3::repeat(setup.velocity_noise)));
        ATTITUDE.set(ATTITUDE, &mut p, &(axis_covariance + first_reading));
        ATTITUDE.set(AXIS, &mut p, axis_covariance);
        AXIS.set(ATTITUDE, &mut p, axis_covariance);
        AXIS.set(AXIS, &mut p, axis_covariance);
        SPIN_AXIS_ERRORS.set(SPIN_AXIS_ERRORS, &mut p, &square(sensor));
        p
    }
}

/// The triad error with these `M_xz`, `M_yz` and `S_z`, and no other.
pub(crate) fn gyro_error(estimate: &Vector3<f64>) -> TriadError {
    let mut matrix = Matrix3::zeros();
    matrix.set_column(2, estimate);
    TriadError { bias: Vector3::zeros(), matrix }
}

/// The covariance of the attitude that one reading of the table gives, resolved in n.
fn angle_noise(setup: &Setup, nav_from_table: &Dcm<Nav, Table>) -> Matrix3<f64> {
    let c = nav_from_table.matrix();
    let sigma = Vector3::new(setup.table.wobble, setup.table.wobble, setup.table.angle_noise);
    c * Matrix3::from_diagonal(&sigma.component_mul(&sigma)) * c.transpose()
}
