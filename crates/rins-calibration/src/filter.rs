//! The paper's filter, eqs. (10)-(21), closed loop.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use rins_ekf::{Filter, Measurement, UpdateError};
use rins_frames::{Body, Dcm, InFrame, Increments, Nav, Table};
use rins_imu::TriadError;
use rins_motion::{NavState, Navigator, VerticalChannel};

use crate::dynamics::{Regime, StateMatrix, dynamics, transition};
use crate::layout::{ATTITUDE, AXIS, POSITION, SPIN_AXIS_ERRORS, STATES, VELOCITY};
use crate::setup::Setup;

/// How many figures a sample is measured by: three of velocity, three of rate or angle.
pub const MEASUREMENTS: usize = 6;

/// How far the surveyed position may be off at the start, as a length \[m\].
///
/// Nothing here depends on it; it only keeps the covariance positive definite.
const POSITION_SIGMA: f64 = 1e-3;

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
    setup: Setup,
    navigator: Navigator,
    nav_from_table: Dcm<Nav, Table>,
    estimate: Vector3<f64>,
    filter: Filter<STATES>,
    log_likelihood: f64,
}

impl SpinAxisFilter {
    /// A filter that starts with the base at rest.
    pub fn new(setup: Setup, start: &Start) -> Self {
        let Start { nav_from_table, ref axis_covariance, angle, angle_source } = *start;
        let nav_from_body = nav_from_table * Dcm::<Table, Body>::about_z(angle);
        let navigator = Navigator::at_rest(&setup.station, nav_from_body, VerticalChannel::Free);
        let radius = setup.station.site.meridian_radius();
        let square = |vector: Vector3<f64>| Matrix3::from_diagonal(&vector.component_mul(&vector));

        let position = Vector3::new(1.0 / radius, 1.0 / radius, 1.0) * POSITION_SIGMA;
        let spec = setup.imu.gyro;
        let sensor =
            Vector3::new(spec.misalignment_sigma, spec.misalignment_sigma, spec.scale_sigma);
        let first_reading = match angle_source {
            AngleSource::Read => angle_noise(&setup, &nav_from_table),
            AngleSource::Defined => Matrix3::zeros(),
        };
        let mut p = StateMatrix::zeros();
        POSITION.set(POSITION, &mut p, &square(position));
        VELOCITY.set(VELOCITY, &mut p, &square(Vector3::repeat(setup.velocity_noise)));
        ATTITUDE.set(ATTITUDE, &mut p, &(axis_covariance + first_reading));
        ATTITUDE.set(AXIS, &mut p, axis_covariance);
        AXIS.set(ATTITUDE, &mut p, axis_covariance);
        AXIS.set(AXIS, &mut p, axis_covariance);
        SPIN_AXIS_ERRORS.set(SPIN_AXIS_ERRORS, &mut p, &square(sensor));
        let filter = Filter { state: SVector::zeros(), covariance: p };
        Self {
            setup,
            navigator,
            nav_from_table,
            estimate: Vector3::zeros(),
            filter,
            log_likelihood: 0.0,
        }
    }

    /// `M_xz`, `M_yz` \[rad\] and `S_z` as estimated so far.
    pub const fn estimate(&self) -> &Vector3<f64> {
        &self.estimate
    }

    /// The estimate as a sensor error that can be compensated.
    pub fn gyro_error(&self) -> TriadError {
        gyro_error(&self.estimate)
    }

    /// The covariance of all states, in the order of [`crate::layout`].
    pub const fn covariance(&self) -> &SMatrix<f64, STATES, STATES> {
        &self.filter.covariance
    }

    /// The attitude of the axis frame as estimated so far.
    pub const fn nav_from_table(&self) -> Dcm<Nav, Table> {
        self.nav_from_table
    }

    /// The logarithm of the probability density of all references so far, under this setup.
    pub const fn log_likelihood(&self) -> f64 {
        self.log_likelihood
    }

    /// The navigator, as corrected so far.
    pub const fn state(&self) -> &NavState {
        self.navigator.state()
    }

    /// Takes in one sample and its reference; returns the whitened innovations.
    ///
    /// # Errors
    /// [`UpdateError`] if a figure is not finite or the innovation covariance not positive definite.
    pub fn step(
        &mut self,
        sample: &Increments,
        reference: &Reference,
    ) -> Result<SVector<f64, MEASUREMENTS>, UpdateError> {
        let compensated = self.compensate(sample);
        let before = *self.navigator.state();
        self.navigator.step(&compensated);
        let after = self.navigator.state();
        let mean = (before.nav_from_body.matrix() + after.nav_from_body.matrix()) * 0.5;
        self.predict(&before, &mean, &compensated);

        let mut measurement = match reference.table {
            TableReading::Angle(angle) => self.angle_measurement(angle),
            TableReading::Rate(rate) => self.rate_measurement(rate, &mean, &compensated),
        };
        let velocity = self.navigator.state().velocity - reference.velocity;
        measurement.value.fixed_rows_mut::<3>(0).copy_from(velocity.components());
        let innovation = self.filter.update(&measurement)?;
        self.log_likelihood += innovation.log_likelihood();
        self.correct();
        Ok(innovation.whitened)
    }

    /// Eq. (1) undone with the present estimate: exact, since only the third column is not zero.
    fn compensate(&self, sample: &Increments) -> Increments {
        let measured = sample.angle.components();
        let [m_xz, m_yz, s_z] = [self.estimate.x, self.estimate.y, self.estimate.z];
        let z = measured.z / (1.0 + s_z);
        let angle = InFrame::new(measured.x - m_xz * z, measured.y - m_yz * z, z);
        Increments { angle, ..*sample }
    }

    fn predict(&mut self, before: &NavState, mean: &Matrix3<f64>, sample: &Increments) {
        let interval = sample.interval;
        let regime = Regime {
            position: before.position,
            velocity: before.velocity,
            gravity: self.setup.station.gravity,
            specific_force: self.navigator.force_gain().components() / interval,
            nav_from_body: *mean,
            spin_rate: sample.angle.components().z / interval,
        };
        let imu = &self.setup.imu;
        let density = |density: f64| Matrix3::identity() * (density * density * interval);
        let mut noise = StateMatrix::zeros();
        ATTITUDE.set(ATTITUDE, &mut noise, &density(imu.gyro.noise_density));
        VELOCITY.set(VELOCITY, &mut noise, &density(imu.accel.noise_density));
        self.filter.predict(&transition(&dynamics(&regime), interval), &noise);
    }

    /// Z1 and the attitude against the axis frame turned by the angle read:
    /// `φ - α` plus the encoder's error about the spin axis, resolved in s.
    fn angle_measurement(&self, angle: f64) -> Measurement<MEASUREMENTS, STATES> {
        let read: Dcm<Nav, Body> = self.nav_from_table * Dcm::<Table, Body>::about_z(angle);
        let computed_from_read: Dcm<Nav, Nav> =
            self.navigator.state().nav_from_body * read.inverse();
        let table_from_nav = self.nav_from_table.inverse();
        let difference = table_from_nav.matrix() * -computed_from_read.rotation_vector();

        let c_sn = table_from_nav.matrix();
        let mut h = SMatrix::<f64, 3, STATES>::zeros();
        h.fixed_view_mut::<3, 3>(0, ATTITUDE.start()).copy_from(c_sn);
        h.fixed_view_mut::<3, 2>(0, POSITION.start()).copy_from(&c_sn.fixed_columns::<2>(0));
        h.fixed_view_mut::<3, 3>(0, AXIS.start()).copy_from(&-c_sn);
        let table = &self.setup.table;
        let sigma = Vector3::new(table.wobble, table.wobble, table.angle_noise);
        self.with_zero_velocity(&difference, &h, &sigma)
    }

    /// Z1 and Z2: the gyro's rate less the Earth's and the table's, eqs. (20) and (21).
    ///
    /// Eq. (19) must read `C~_n^b = C_n^b (I + φ×)` for the signs of (21) to hold.
    fn rate_measurement(
        &self,
        rate: f64,
        mean: &Matrix3<f64>,
        sample: &Increments,
    ) -> Measurement<MEASUREMENTS, STATES> {
        let earth_rate = self.navigator.state().position.earth_rate();
        let c_bn = mean.transpose();
        let measured = sample.angle.components() / sample.interval;
        let difference = measured - c_bn * earth_rate.components() - Vector3::z() * rate;

        let by_attitude = c_bn * earth_rate.cross_matrix();
        let mut h = SMatrix::<f64, 3, STATES>::zeros();
        h.fixed_view_mut::<3, 3>(0, ATTITUDE.start()).copy_from(&by_attitude);
        h.fixed_view_mut::<3, 2>(0, POSITION.start()).copy_from(&by_attitude.fixed_columns::<2>(0));
        let spin = Matrix3::identity() * measured.z;
        h.fixed_view_mut::<3, 3>(0, SPIN_AXIS_ERRORS.start()).copy_from(&spin);

        let density = self.setup.imu.gyro.noise_density;
        let gyro = density * density / sample.interval;
        let sigma = Vector3::new(0.0, 0.0, self.setup.table.rate_noise)
            .map(|table: f64| table.mul_add(table, gyro).sqrt());
        let mut cross = SMatrix::<f64, STATES, MEASUREMENTS>::zeros();
        cross.fixed_view_mut::<3, 3>(ATTITUDE.start(), 3).copy_from(&(mean * -(density * density)));
        self.with_zero_velocity(&difference, &h, &sigma).correlated_with_state_error(cross)
    }

    /// Z1, its value still open, above three further rows.
    fn with_zero_velocity(
        &self,
        difference: &Vector3<f64>,
        rows: &SMatrix<f64, 3, STATES>,
        sigma: &Vector3<f64>,
    ) -> Measurement<MEASUREMENTS, STATES> {
        let mut z = SVector::<f64, MEASUREMENTS>::zeros();
        z.fixed_rows_mut::<3>(3).copy_from(difference);
        let mut h = SMatrix::<f64, MEASUREMENTS, STATES>::zeros();
        h.fixed_view_mut::<3, 3>(0, VELOCITY.start()).copy_from(&Matrix3::identity());
        h.fixed_view_mut::<3, STATES>(3, 0).copy_from(rows);
        let zero_velocity = self.setup.velocity_noise;
        let r = SVector::<f64, MEASUREMENTS>::from_fn(|row, _| {
            let sigma = if row < 3 { zero_velocity } else { sigma[row - 3] };
            sigma * sigma
        });
        Measurement::new(z, h, SMatrix::from_diagonal(&r))
    }

    /// Feeds the state back into navigator, axis and estimate, and leaves it at zero.
    fn correct(&mut self) {
        let x = &self.filter.state;
        let position = POSITION.of(x);
        let phi = ATTITUDE.of(x) + Vector3::new(position.x, position.y, 0.0);
        let state = self.navigator.state_mut();
        state.position.latitude += position.x;
        state.position.longitude -= position.y / state.position.latitude.cos();
        state.position.height -= position.z;
        state.velocity -= InFrame::from_components(VELOCITY.of(x));
        state.nav_from_body = Dcm::from_rotation_vector(&phi) * state.nav_from_body;
        self.nav_from_table = Dcm::from_rotation_vector(&AXIS.of(x)) * self.nav_from_table;
        self.estimate += SPIN_AXIS_ERRORS.of(x);
        self.filter.state = SVector::zeros();
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
