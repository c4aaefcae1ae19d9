//! One sample of the filter: compensation, navigation, prediction, measurement, correction.

use rins_frames::{Dcm, Nav};
use rins_lanes::{Matrix, Real, Vector, rotation};
use rins_motion::{Figures, Mechanisation, VerticalChannel};

use crate::layout::{AXIS, PAPER_STATES, SPIN_AXIS_ERRORS, STATES};
use crate::setup::Setup;
use crate::structured::{
    Comparison, Covariance, Input, Means, States, Transition, UpdateResult, With,
};

/// The ratio of the variance of a predicted measurement, with correlations between states neglected, to its noise variance
/// from which the covariance is stored as factors: below it the plain form keeps six digits of every sigma.
pub(crate) const PLAIN: f64 = 1e7;

/// The paper's twelve states: the constants are `M_xz`, `M_yz` and `S_z`, each of which affects its gyro in proportion to the
/// spin rate.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SpinAxisErrors {}

/// The same with the attitude error of the axis frame.
#[derive(Clone, Copy, Debug)]
pub(crate) enum WithAxis {}

/// Each of the spin-axis errors affects its gyro; other constants affect no sensor.
const fn inputs<const N: usize>() -> [Input; N] {
    let mut inputs = [Input::None; N];
    let mut axis = 0;
    while axis < 3 {
        inputs[SPIN_AXIS_ERRORS.start() + axis] = Input::Gyro(axis);
        axis += 1;
    }
    inputs
}

impl States<PAPER_STATES> for SpinAxisErrors {
    const INPUTS: [Input; PAPER_STATES] = inputs();
    const AXIS: Option<usize> = None;
}

impl States<STATES> for WithAxis {
    const INPUTS: [Input; STATES] = inputs();
    const AXIS: Option<usize> = Some(AXIS.start());
}

/// One sample of one run, or of several runs with a common interval \[s\].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample<T> {
    /// \[rad\], in b.
    pub(crate) angle: Vector<T>,
    /// \[m/s\], in b.
    pub(crate) velocity: Vector<T>,
    pub(crate) interval: f64,
}

/// The table measurement at the end of the sample.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Reading<T> {
    /// The sine and cosine of the measured angle.
    Angle([T; 2]),
    /// The mean commanded rate \[rad/s\].
    Rate(T),
}

/// The filter's state: navigation, estimate, and covariance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kernel<T, M, const N: usize> {
    pub(crate) setup: Setup,
    pub(crate) mechanisation: Mechanisation<T>,
    pub(crate) nav_from_table: Matrix<T>,
    /// `M_xz`, `M_yz` \[rad\] and `S_z`.
    pub(crate) estimate: Vector<T>,
    pub(crate) covariance: Covariance<T, N>,
    constants: core::marker::PhantomData<M>,
}

/// The quantities of an interval that the measurement at its end needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Interval<T> {
    /// The compensated mean rate \[rad/s\], in b.
    pub(crate) rate: Vector<T>,
    /// The mean of `C_b^n`.
    mean: Matrix<T>,
    figures: Figures<T>,
    /// \[s\]
    length: f64,
}

impl<T: Real, M: States<N>, const N: usize> Kernel<T, M, N> {
    /// A kernel with a stationary base at the station, with this attitude of body and axis and a covariance with the lower
    /// triangle `element`.
    pub(crate) fn at_rest(
        like: T,
        setup: &Setup,
        [nav_from_body, nav_from_table]: [&nalgebra::Matrix3<f64>; 2],
        element: impl Fn(usize, usize) -> f64,
    ) -> Self {
        let site = setup.station.site;
        let mechanisation = Mechanisation::new(
            [site.latitude, site.longitude, site.height].map(|x| like.constant(x)),
            Vector::zeros(like),
            Matrix::constant(like, nav_from_body),
            &setup.station,
            VerticalChannel::Free,
        );
        Self {
            setup: *setup,
            mechanisation,
            nav_from_table: Matrix::constant(like, nav_from_table),
            estimate: Vector::zeros(like),
            covariance: Covariance::from_fn(like, |row, column| {
                like.constant(element(row, column))
            }),
            constants: core::marker::PhantomData,
        }
    }

    /// Processes one sample by the plain update, on a stationary table; returns whether the plain form is precise enough for
    /// all measurements.
    #[inline(always)]
    pub(crate) fn step(
        &mut self,
        sample: &Sample<T>,
        reading: &Reading<T>,
    ) -> (UpdateResult<T, N>, bool) {
        let interval = self.predict(sample);
        let comparison = self.compare(&interval, reading);
        let (off, noise) = (self.mechanisation.velocity, self.setup.velocity_noise);
        let [a, b, c, d, e, f] = self.covariance.ratios::<M>(&comparison, noise);
        // All are positive, so that none exceeds their sum.
        let plain = (a + b + c + d + e + f).all_below(PLAIN);
        let found = self.covariance.update::<M>(&comparison, &off, noise);
        self.correct(&found.state, &interval);
        (found, plain)
    }

    /// Integrates one compensated sample, and predicts the covariance.
    #[inline(always)]
    pub(crate) fn predict(&mut self, sample: &Sample<T>) -> Interval<T> {
        let (interval, means) = self.navigate(sample);
        self.carry(&interval, &means);
        interval
    }

    /// Integrates one compensated sample; returns the means on which the error dynamics depend.
    #[inline(always)]
    pub(crate) fn navigate(&mut self, sample: &Sample<T>) -> (Interval<T>, Means<T>) {
        let interval = sample.interval;
        let angle = self.compensate(&sample.angle);
        let before = (self.mechanisation.nav_from_body, self.mechanisation.velocity);
        let figures = self.mechanisation.step(&angle, &sample.velocity, interval);
        let mean = (before.0 + self.mechanisation.nav_from_body).scaled(0.5);
        let means = Means {
            interval,
            curvatures: [figures.meridian_curvature, figures.transverse_curvature],
            latitude: figures.latitude,
            velocity: before.1,
            gravity: self.setup.station.gravity,
            specific_force: self.mechanisation.force_gain.scaled(1.0 / interval),
            nav_from_body: mean,
        };
        (Interval { rate: angle.scaled(1.0 / interval), mean, figures, length: interval }, means)
    }

    /// The effect of a unit of each constant on its gyro.
    #[inline(always)]
    fn regressors(spin_rate: T) -> [T; N] {
        let mut regressors = [spin_rate.constant(0.0); N];
        regressors[SPIN_AXIS_ERRORS.start()..SPIN_AXIS_ERRORS.end()].fill(spin_rate);
        regressors
    }

    /// The transition of the errors over an interval.
    #[inline(always)]
    pub(crate) fn transition(
        &self,
        interval: &Interval<T>,
        means: &Means<T>,
    ) -> Transition<T, M, N> {
        let regressors = Self::regressors(interval.rate[2]);
        let imu = &self.setup.imu;
        Transition::new(means, regressors, [imu.accel.noise_density, imu.gyro.noise_density])
    }

    /// Propagates the covariance over an interval.
    #[inline(always)]
    pub(crate) fn carry(&mut self, interval: &Interval<T>, means: &Means<T>) {
        self.transition(interval, means).carry(&mut self.covariance);
    }

    /// Eq. (1) inverted with the current estimate: exact, since only the third column is not zero.
    #[inline(always)]
    fn compensate(&self, measured: &Vector<T>) -> Vector<T> {
        let z = measured[2] / (self.estimate[2] + 1.0);
        Vector([measured[0] - self.estimate[0] * z, measured[1] - self.estimate[1] * z, z])
    }

    /// The three rows of the table measurement.
    #[inline(always)]
    pub(crate) fn compare(&self, interval: &Interval<T>, reading: &Reading<T>) -> Comparison<T, N> {
        match reading {
            Reading::Angle(sine_and_cosine) => self.compare_angle(sine_and_cosine),
            Reading::Rate(rate) => self.compare_rate(interval, *rate),
        }
    }

    /// The attitude relative to the axis frame rotated by the measured angle: `φ - α` plus the encoder's error about the spin
    /// axis, resolved in s.
    #[inline(always)]
    fn compare_angle(&self, [sin, cos]: &[T; 2]) -> Comparison<T, N> {
        let (zero, one) = (sin.constant(0.0), sin.constant(1.0));
        let turn = Matrix([[*cos, -*sin, zero], [*sin, *cos, zero], [zero, zero, one]]);
        let read = self.nav_from_table * turn;
        let computed_from_read = self.mechanisation.nav_from_body * read.transpose();
        let c_sn = self.nav_from_table.transpose();
        let vector = rotation::small_rotation_vector(&computed_from_read)
            .unwrap_or_else(|| rotation_vector(&computed_from_read));
        let table = &self.setup.table;
        let noise = [table.wobble, table.wobble, table.angle_noise].map(|sigma| sigma * sigma);
        let difference = -(c_sn * vector);
        Comparison { difference, by_attitude: c_sn, with: With::Axis, noise, cross: None }
    }

    /// Z2: the gyro's rate minus those of the Earth and of the table, eqs. (20) and (21).
    ///
    /// Eq. (19) must read `C~_n^b = C_n^b (I + φ×)` for the signs of (21) to hold.
    #[inline(always)]
    fn compare_rate(&self, interval: &Interval<T>, table: T) -> Comparison<T, N> {
        let earth_rate = interval.figures.earth_rate();
        let c_bn = interval.mean.transpose();
        let mut difference = interval.rate - c_bn * earth_rate;
        difference[2] = difference[2] - table;

        let density = self.setup.imu.gyro.noise_density;
        let gyro = density * density / interval.length;
        let rate_noise = self.setup.table.rate_noise;
        Comparison {
            difference,
            by_attitude: c_bn * Matrix::cross(&earth_rate),
            with: With::Rates(Self::regressors(interval.rate[2])),
            noise: [gyro, gyro, rate_noise * rate_noise + gyro],
            cross: Some(interval.mean.scaled(-(density * density))),
        }
    }

    /// Applies the estimated errors to navigator, axis and estimate.
    #[inline(always)]
    pub(crate) fn correct(&mut self, x: &[T; N], interval: &Interval<T>) {
        let cos = interval.figures.latitude[1];
        let mechanisation = &mut self.mechanisation;
        let [latitude, longitude, height] = mechanisation.place;
        mechanisation.place = [latitude + x[0], longitude - x[1] / cos, height - x[2]];
        mechanisation.velocity = mechanisation.velocity - Vector([x[3], x[4], x[5]]);
        let phi = Vector([x[6] + x[0], x[7] + x[1], x[8]]);
        mechanisation.nav_from_body = rotation::exp(&phi) * mechanisation.nav_from_body;
        self.estimate = self.estimate + Vector([x[9], x[10], x[11]]);
        if let Some(first) = M::AXIS {
            let alpha = Vector([x[first], x[first + 1], x[first + 2]]);
            let turned = rotation::exp(&alpha) * self.nav_from_table;
            self.nav_from_table = rotation::orthonormalised(&turned);
        }
    }
}

/// The rotation vectors of matrices with large angles, run by run.
#[cold]
fn rotation_vector<T: Real>(c: &Matrix<T>) -> Vector<T> {
    let all: Vec<_> = (0..c[0][0].lanes())
        .map(|run| Dcm::<Nav, Nav>::from_kernel(c.lane(run)).rotation_vector())
        .collect();
    Vector([0, 1, 2].map(|axis| c[0][0].each(|run| all[run][axis])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};
    use rins_frames::units::DEG;
    use rins_frames::{EulerAngles, Site};
    use rins_imu::{ImuSpec, TriadSpec};
    use rins_motion::Station;

    use crate::setup::TableSpec;

    /// A correction of 6 m; its second-order effect is its square.
    const CORRECTION: f64 = 1e-6;
    const SECOND_ORDER: f64 = 10.0 * CORRECTION * CORRECTION;

    fn setup(latitude: f64) -> Setup {
        let spec = TriadSpec::white(1e-7, 0.0, 1e-4, 1e-4);
        let site = Site { latitude, longitude: 1.9, height: 400.0 };
        Setup {
            station: Station::with_normal_gravity(site),
            axis: None,
            table: TableSpec { angle_noise: 1e-6, wobble: 0.0, rate_noise: 0.0, latency: 0.0 },
            imu: ImuSpec { gyro: spec, accel: spec },
            velocity_noise: Setup::FIXED_TABLE_VELOCITY_NOISE,
        }
    }

    /// The matrix from the axes east, north and up at a latitude and a longitude to axes of the Earth.
    fn earth_from_nav(latitude: f64, longitude: f64) -> Matrix3<f64> {
        let (sin, cos) = latitude.sin_cos();
        let (y, x) = longitude.sin_cos();
        Matrix3::new(-y, -sin * x, cos * x, x, -sin * y, cos * y, 0.0, cos, sin)
    }

    /// The rotations of the level and of the body relative to the Earth by a position correction `x` alone.
    fn corrected(latitude: f64, x: [f64; 2]) -> (Vector3<f64>, Vector3<f64>) {
        let body = *EulerAngles { roll: 0.4, pitch: -0.3, yaw: 2.0 }
            .dcm::<Nav, rins_frames::Body>()
            .matrix();
        let setup = setup(latitude);
        let mut kernel = Kernel::<f64, SpinAxisErrors, PAPER_STATES>::at_rest(
            0.0,
            &setup,
            [&body, &Matrix3::identity()],
            |row, column| f64::from(u8::from(row == column)),
        );
        let sample = Sample {
            angle: Vector([0.0; 3]),
            velocity: Vector([0.0, 0.0, setup.station.gravity * 1e-3]),
            interval: 1e-3,
        };
        let interval = kernel.predict(&sample);
        let attitude = |kernel: &Kernel<f64, SpinAxisErrors, PAPER_STATES>| {
            let [latitude, longitude, _] = kernel.mechanisation.place;
            let matrix = kernel.mechanisation.nav_from_body;
            let nav_from_body = Matrix3::from_fn(|row, column| matrix[row][column]);
            (earth_from_nav(latitude, longitude), nav_from_body)
        };
        let (level, before) = attitude(&kernel);
        let mut state = [0.0; PAPER_STATES];
        state[..2].copy_from_slice(&x);
        kernel.correct(&state, &interval);
        let (moved, after) = attitude(&kernel);
        let vector = |turn: Matrix3<f64>| {
            let skew = 0.5 * (turn - turn.transpose());
            Vector3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)])
        };
        let of_level = vector(level.transpose() * moved);
        let of_body =
            vector(level.transpose() * moved * after * (level * before).transpose() * level);
        (of_level, of_body)
    }

    /// A position correction is the same distance on the ground at any latitude: a displacement north by the first angle
    /// rotates the level negatively about east, a displacement west by the second rotates it negatively about north.
    #[test]
    fn a_place_is_corrected_by_angles_at_the_center_of_the_earth() {
        for latitude in [-70.0, -20.0, 0.0, 50.0].map(|latitude| latitude * DEG) {
            let (north, _) = corrected(latitude, [CORRECTION, 0.0]);
            assert!((north - Vector3::x() * -CORRECTION).norm() < SECOND_ORDER, "{north}");
            let (east, _) = corrected(latitude, [0.0, CORRECTION]);
            assert!((east.xy() - Vector3::y().xy() * -CORRECTION).norm() < SECOND_ORDER, "{east}");
        }
    }

    /// The attitude error is that of the body relative to the computed level. If only the position was wrong, the body keeps
    /// its attitude relative to the Earth, except for the rotation of north about up, which the azimuth error includes.
    #[test]
    fn a_place_that_is_corrected_leaves_the_body_in_the_earth() {
        for latitude in [-70.0, -20.0, 0.0, 50.0].map(|latitude| latitude * DEG) {
            for x in [[CORRECTION, 0.0], [0.0, CORRECTION]] {
                let (level, body) = corrected(latitude, x);
                assert!(body.xy().norm() < SECOND_ORDER, "{body}");
                assert!((body.z - level.z).abs() < SECOND_ORDER, "{body} {level}");
                assert!(level.norm() > 0.9 * CORRECTION, "the level has moved: {level}");
            }
        }
    }
}
