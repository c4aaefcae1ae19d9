//! The paper's filter with the gyro biases as additional states.

use nalgebra::{Matrix2x3, Matrix3, SMatrix, SVector, Vector3};
use rins_calibration::Setup;
use rins_ekf::{Block, Filter, Measurement, UpdateError};
use rins_frames::{Dcm, InFrame, Increments, Nav, Table, cross_matrix};
use rins_motion::{Navigator, VerticalChannel};

/// `φ` of `C~ = (I - φ×) C`, in n \[rad\].
const ATTITUDE: Block<3> = Block::first();
/// The velocity error, east and north \[m/s\].
const VELOCITY: Block<2> = ATTITUDE.then();
/// `M_xz`, `M_yz` \[rad\] and `S_z`, true minus compensated.
const SPIN_AXIS: Block<3> = VELOCITY.then();
/// The gyro biases, true minus compensated \[rad/s\].
const BIAS: Block<3> = SPIN_AXIS.then();
const STATES: usize = BIAS.end();

/// The measurements: velocity east and north, and the gyros' rates.
const OF_VELOCITY: Block<2> = Block::first();
const OF_RATE: Block<3> = OF_VELOCITY.then();
const MEASUREMENTS: usize = OF_RATE.end();

/// A calibration filter for a fixed position: attitude, velocity, the three spin-axis errors, three gyro biases.
///
/// It starts from a known attitude and compares the gyros with the commanded rate, like the paper's filter.
/// Unlike that, it is formulated in `φ` instead of `ψ`, and treats the position as known, so that
/// the two have only the physics in common; with biases known to be zero they must agree.
#[derive(Clone, Debug)]
pub(crate) struct BiasFilter {
    setup: Setup,
    navigator: Navigator,
    spin_axis: Vector3<f64>,
    bias: Vector3<f64>,
    filter: Filter<STATES>,
}

impl BiasFilter {
    /// A filter that starts at rest at table angle zero, with an exactly known attitude.
    ///
    /// The priors are those of the data sheet in `setup`.
    pub(crate) fn new(setup: &Setup, nav_from_table: Dcm<Nav, Table>) -> Self {
        let start = nav_from_table * Dcm::about_z(0.0);
        let spec = setup.imu.gyro;
        let square = |sigmas: Vector3<f64>| sigmas.component_mul(&sigmas);
        let [misalignment, scale] = [spec.misalignment_sigma, spec.scale_sigma];
        let mut p = SMatrix::zeros();
        VELOCITY.set_diagonal(&mut p, &SVector::repeat(setup.velocity_noise.powi(2)));
        SPIN_AXIS.set_diagonal(&mut p, &square(Vector3::new(misalignment, misalignment, scale)));
        BIAS.set_diagonal(&mut p, &square(Vector3::repeat(spec.bias_sigma)));
        Self {
            setup: *setup,
            navigator: Navigator::at_rest(&setup.station, start, VerticalChannel::Held),
            spin_axis: Vector3::zeros(),
            bias: Vector3::zeros(),
            filter: Filter { state: SVector::zeros(), covariance: p },
        }
    }

    /// `M_xz`, `M_yz` \[rad\], `S_z`, then the biases of the gyros x, y and z \[rad/s\].
    pub(crate) fn estimate(&self) -> SVector<f64, 6> {
        SVector::from_fn(|row, _| if row < 3 { self.spin_axis[row] } else { self.bias[row - 3] })
    }

    /// The covariance of [`Self::estimate`].
    pub(crate) fn covariance(&self) -> SMatrix<f64, 6, 6> {
        let start = SPIN_AXIS.start();
        self.filter.covariance.fixed_view::<6, 6>(start, start).into_owned()
    }

    /// Processes one sample with the commanded mean rate of the table over it \[rad/s\].
    ///
    /// # Errors
    /// [`UpdateError`] if a number is not finite or the innovation covariance is not positive definite.
    pub(crate) fn step(&mut self, sample: &Increments, table_rate: f64) -> Result<(), UpdateError> {
        let truer = self.compensate(sample);
        let before = *self.navigator.state().nav_from_body.matrix();
        self.navigator.step(&truer);
        let mean = (before + self.navigator.state().nav_from_body.matrix()) * 0.5;
        self.predict(&mean, &truer);
        self.filter.update(&self.measurement(&mean, &truer, table_rate))?;
        self.correct();
        Ok(())
    }

    /// Compensates eq. (1) with the present estimates.
    fn compensate(&self, sample: &Increments) -> Increments {
        let unbiased = sample.angle.components() - self.bias * sample.interval;
        let z = unbiased.z / (1.0 + self.spin_axis.z);
        let [m_xz, m_yz] = [self.spin_axis.x, self.spin_axis.y];
        let angle = InFrame::new(unbiased.x - m_xz * z, unbiased.y - m_yz * z, z);
        Increments { angle, ..*sample }
    }

    fn predict(&mut self, c_nb: &Matrix3<f64>, sample: &Increments) {
        let interval = sample.interval;
        let site = self.setup.station.site;
        let velocity = self.navigator.state().velocity;
        let earth_rate = site.earth_rate();
        let nav_rate = earth_rate + site.transport_rate(&velocity);
        let f_n = self.navigator.force_gain().components() / interval;
        let spin = sample.angle.components().z / interval;
        let by_north = 1.0 / (site.meridian_radius() + site.height);
        let by_east = 1.0 / (site.transverse_radius() + site.height);

        let mut f = SMatrix::<f64, STATES, STATES>::zeros();
        let mut transport = SMatrix::<f64, 3, 2>::zeros();
        transport[(0, 1)] = -by_north;
        transport[(1, 0)] = by_east;
        transport[(2, 0)] = by_east * site.latitude.tan();
        ATTITUDE.set(ATTITUDE, &mut f, &-nav_rate.cross_matrix());
        ATTITUDE.set(VELOCITY, &mut f, &transport);
        ATTITUDE.set(SPIN_AXIS, &mut f, &(c_nb * -spin));
        ATTITUDE.set(BIAS, &mut f, &-c_nb);
        let level: Matrix2x3<f64> = cross_matrix(&f_n).fixed_rows::<2>(0).into_owned();
        VELOCITY.set(ATTITUDE, &mut f, &level);
        let coriolis = -(earth_rate + nav_rate).cross_matrix();
        VELOCITY.set(VELOCITY, &mut f, &coriolis.fixed_view::<2, 2>(0, 0).into_owned());
        let step = f * interval;
        let transition = SMatrix::identity() + step + step * step * 0.5;

        let mut q = SMatrix::zeros();
        let [gyro, accel] = [self.setup.imu.gyro.noise_density, self.setup.imu.accel.noise_density];
        ATTITUDE.set_diagonal(&mut q, &SVector::repeat(gyro * gyro * interval));
        VELOCITY.set_diagonal(&mut q, &SVector::repeat(accel * accel * interval));
        self.filter.predict(&transition, &q);
    }

    /// Zero velocity, and eq. (20); the gyro noise is common to it and the prediction.
    fn measurement(
        &self,
        c_nb: &Matrix3<f64>,
        sample: &Increments,
        table_rate: f64,
    ) -> Measurement<MEASUREMENTS, STATES> {
        let c_bn = c_nb.transpose();
        let earth_rate = self.setup.station.site.earth_rate();
        let rate = sample.angle.components() / sample.interval;
        let difference = rate - c_bn * earth_rate.components() - Vector3::z() * table_rate;
        let velocity = self.navigator.state().velocity.components().xy();
        let mut z = SVector::zeros();
        OF_VELOCITY.set_in(&mut z, &velocity);
        OF_RATE.set_in(&mut z, &difference);

        let mut h = SMatrix::<f64, MEASUREMENTS, STATES>::zeros();
        OF_VELOCITY.set(VELOCITY, &mut h, &SMatrix::identity());
        OF_RATE.set(ATTITUDE, &mut h, &(c_bn * earth_rate.cross_matrix()));
        OF_RATE.set(SPIN_AXIS, &mut h, &(Matrix3::identity() * rate.z));
        OF_RATE.set(BIAS, &mut h, &Matrix3::identity());

        let density = self.setup.imu.gyro.noise_density;
        let mut r = SMatrix::zeros();
        OF_VELOCITY.set_diagonal(&mut r, &SVector::repeat(self.setup.velocity_noise.powi(2)));
        OF_RATE.set_diagonal(&mut r, &SVector::repeat(density * density / sample.interval));
        let mut cross = SMatrix::zeros();
        ATTITUDE.set(OF_RATE, &mut cross, &(c_nb * -(density * density)));
        Measurement::new(z, h, r).correlated_with_state_error(cross)
    }

    /// Transfers the state to the navigator and the estimates; the position is known.
    fn correct(&mut self) {
        let x = self.filter.state;
        let velocity = VELOCITY.of(&x);
        let site = self.setup.station.site;
        let state = self.navigator.state_mut();
        state.position = site;
        state.velocity -= InFrame::new(velocity.x, velocity.y, 0.0);
        state.nav_from_body = Dcm::from_rotation_vector(&ATTITUDE.of(&x)) * state.nav_from_body;
        self.spin_axis += SPIN_AXIS.of(&x);
        self.bias += BIAS.of(&x);
        self.filter.state = SVector::zeros();
    }
}
