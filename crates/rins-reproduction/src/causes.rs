//! Possible causes of a disagreement, with the size that each would need.

use nalgebra::{SVector, Vector3};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G, PPM};
use rins_frames::{Dcm, EARTH_RATE, Nav, Site};
use rins_motion::{Profile, Segment, Station};

use crate::error::ReproductionError;
use crate::experiment::spin_axis_error;
use crate::pure_navigation::PureNavigation;

/// A possible error of a navigation on a table at constant rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cause {
    /// A gyro bias, present during the alignment too, in which its east component has caused an azimuth
    /// error. By axis of the body.
    GyroBias(usize),
    /// A gyro bias that appears after the alignment.
    GyroBiasChange(usize),
    /// An accelerometer bias, present during the alignment too, in which it has caused a tilt error.
    AccelBias(usize),
    /// An accelerometer bias that appears after the alignment.
    AccelBiasChange(usize),
    /// An initial attitude error, by axis of n.
    Start(usize),
    /// An initial attitude that is older than the data: rotated back about the spin axis.
    StartLag,
    /// An error of the compensation: true minus compensated, of `M_xz`, `M_yz`, `S_z`.
    Estimate(usize),
    /// The site is further north.
    Latitude,
    /// Gravity is larger, both in the data and in the navigation.
    Gravity,
    /// The duration of the navigation is longer.
    Duration,
    /// The axis has tilted at the end, by axis of n: the indicated attitude changes, without a velocity error.
    Tilt(usize),
    /// The indicated attitude is older than its reference, or the table has overshot its final angle.
    Readout,
    /// The table rotates faster than commanded, while the calibration treats the commanded rate as the
    /// true one. The estimates are those printed, so that the true errors differ.
    TableRate,
    /// The IMU's sample clock is slow relative to the table's: the effect is that of [`Cause::TableRate`].
    SampleClock,
    /// White noise of the gyros, whose effect is its 1σ.
    GyroNoise,
}

impl Cause {
    /// The possible causes of a velocity error if the initial attitude is known.
    pub(crate) const OF_VELOCITY: [Self; 16] = [
        Self::GyroBiasChange(0),
        Self::GyroBiasChange(1),
        Self::GyroBiasChange(2),
        Self::AccelBiasChange(0),
        Self::AccelBiasChange(1),
        Self::AccelBiasChange(2),
        Self::Estimate(0),
        Self::Estimate(1),
        Self::Estimate(2),
        Self::Start(0),
        Self::Start(1),
        Self::Start(2),
        Self::StartLag,
        Self::Latitude,
        Self::Gravity,
        Self::Duration,
    ];

    /// Its name, in the words of a list.
    pub(crate) fn name(self) -> String {
        let body = |axis: usize| ["x", "y", "z"][axis];
        let nav = |axis: usize| ["east", "north", "up"][axis];
        match self {
            Self::GyroBias(axis) => format!("gyro bias {}, aligned with it", body(axis)),
            Self::GyroBiasChange(axis) => format!("gyro bias {}", body(axis)),
            Self::AccelBias(axis) => format!("accelerometer bias {}, aligned with it", body(axis)),
            Self::AccelBiasChange(axis) => format!("accelerometer bias {}", body(axis)),
            Self::Start(axis) => format!("start attitude off about {}", nav(axis)),
            Self::StartLag => "start attitude older than the data".into(),
            Self::Estimate(row) => {
                format!("${}$ not compensated", ["M_{xz}", "M_{yz}", "S_z"][row])
            }
            Self::Latitude => "another latitude".into(),
            Self::Gravity => "another gravity".into(),
            Self::Duration => "a longer navigation".into(),
            Self::Tilt(axis) => format!("axis tipped about {}", nav(axis)),
            Self::Readout => "attitude older than its reference".into(),
            Self::TableRate => "table rate against its command".into(),
            Self::SampleClock => "sample clock against the table's".into(),
            Self::GyroNoise => "gyro noise, 1σ".into(),
        }
    }

    /// Its unit, and the value of the unit in SI.
    pub(crate) fn unit(self) -> (&'static str, f64) {
        match self {
            Self::GyroBias(_) | Self::GyroBiasChange(_) => ("°/h", DEG_PER_HOUR),
            Self::AccelBias(_) | Self::AccelBiasChange(_) => ("µg", MICRO_G),
            Self::Start(_) | Self::Tilt(_) | Self::Estimate(0 | 1) => ("″", ARCSEC),
            Self::Estimate(_) | Self::TableRate | Self::SampleClock => ("ppm", PPM),
            Self::GyroNoise => ("°/h/√Hz", DEG_PER_HOUR),
            Self::StartLag | Self::Readout => ("ms", 1e-3),
            Self::Latitude => ("°", DEG),
            Self::Gravity => ("m/s²", 1.0),
            Self::Duration => ("s", 1.0),
        }
    }

    /// The change of velocity \[m/s\] and attitude \[deg\] per unit of the cause, in the order of
    /// [`Outcome::figures`](crate::pure_navigation::Outcome::figures), about `base`.
    ///
    /// # Errors
    /// [`ReproductionError`] if the navigation fails.
    pub(crate) fn effect(
        self,
        base: &PureNavigation,
    ) -> Result<SVector<f64, 5>, ReproductionError> {
        if self == Self::GyroNoise {
            return Ok(noise_effect(base, self.unit().1));
        }
        // The step, if one unit is too small for the numerical precision or too large for linearity.
        let units = match self {
            Self::Gravity => 1e-3,
            Self::Duration => 0.2,
            Self::AccelBias(_) | Self::AccelBiasChange(_) => 10.0,
            Self::GyroBias(_) | Self::GyroBiasChange(_) => 0.01,
            _ => 1.0,
        };
        let step = units * self.unit().1;
        let either = [self.applied(base, step)?, self.applied(base, -step)?];
        Ok((either[0] - either[1]) / (2.0 * units))
    }

    /// The result of a navigation with this size of the cause, in SI units.
    fn applied(
        self,
        base: &PureNavigation,
        size: f64,
    ) -> Result<SVector<f64, 5>, ReproductionError> {
        let mut changed = base.clone();
        let scenario = &mut changed.scenario;
        let station = scenario.station;
        let c_nb = *scenario.nav_from_table.matrix();
        match self {
            Self::GyroBias(axis) => {
                scenario.imu_error.gyro.bias[axis] += size;
                changed.start_error += azimuth_error(&station, c_nb[(0, axis)] * size);
            }
            Self::GyroBiasChange(axis) => scenario.imu_error.gyro.bias[axis] += size,
            Self::AccelBias(axis) => {
                scenario.imu_error.accel.bias[axis] += size;
                changed.start_error += tilt_error(&station, &(c_nb.column(axis) * size));
            }
            Self::AccelBiasChange(axis) => scenario.imu_error.accel.bias[axis] += size,
            Self::Start(axis) => changed.start_error[axis] += size,
            Self::StartLag => {
                // Rotated back by ω times the lag: φ is minus that rotation.
                let back = scenario.profile.rate(scenario.profile.duration()) * size;
                changed.start_error += c_nb.column(2) * back;
            }
            Self::Estimate(row) => {
                let mut off = Vector3::zeros();
                off[row] = size;
                scenario.imu_error.gyro.matrix += spin_axis_error(&off).matrix;
            }
            Self::Latitude => {
                let site = Site { latitude: station.site.latitude + size, ..station.site };
                scenario.station = Station::with_normal_gravity(site);
            }
            Self::Gravity => scenario.station.gravity += size,
            Self::Duration => {
                let (rate, duration) = (scenario.profile.rate(0.0), scenario.profile.duration());
                let longer = Segment { rate, duration: duration + size };
                scenario.profile = Profile::new(&[longer], None)?;
            }
            Self::Tilt(axis) => return Ok(tipped(base, axis, size)),
            Self::TableRate | Self::SampleClock => {
                // The output of the gyros is unchanged, and so are the estimates: (1 + e) ω is the
                // true rate and ω the commanded one, (z + m) ω is measured.
                let (rate, duration) = (scenario.profile.rate(0.0), scenario.profile.duration());
                let segment = Segment { rate: rate * (1.0 + size), duration };
                scenario.profile = Profile::new(&[segment], None)?;
                let matrix = &mut scenario.imu_error.gyro.matrix;
                let measured = matrix.column(2) + Vector3::z();
                matrix.set_column(2, &(measured / (1.0 + size) - Vector3::z()));
            }
            // Its effect is random, and computed without a navigation.
            Self::GyroNoise => {}
            Self::Readout => {
                let reference = scenario.nav_from_table.euler_angles();
                let rate = scenario.profile.rate(scenario.profile.duration());
                return Ok(changed.outcome()?.read_out_late(&reference, rate, size).vector());
            }
        }
        Ok(changed.outcome()?.vector())
    }
}

/// The 1σ due to white gyro noise of `density` \[rad/s/√Hz\]: an angle random walk about each axis,
/// and its integral times gravity in the velocity.
fn noise_effect(base: &PureNavigation, density: f64) -> SVector<f64, 5> {
    let scenario = &base.scenario;
    let time = scenario.profile.duration();
    let angle = density * time.sqrt();
    let velocity = scenario.station.gravity * density * (time.powi(3) / 3.0).sqrt();
    SVector::from([velocity, velocity, angle / DEG, angle / DEG, angle / DEG])
}

/// The change of the indicated attitude if the axis is tilted about an axis of n \[rad\], with all else unchanged.
fn tipped(base: &PureNavigation, axis: usize, size: f64) -> SVector<f64, 5> {
    let mut turn = Vector3::zeros();
    turn[axis] = size;
    let upright = base.scenario.nav_from_table;
    let tipped = (Dcm::<Nav, Nav>::from_rotation_vector(&turn) * upright).euler_angles();
    let reference = upright.euler_angles();
    SVector::from([
        0.0,
        0.0,
        (tipped.roll - reference.roll) / DEG,
        (tipped.pitch - reference.pitch) / DEG,
        (tipped.yaw - reference.yaw) / DEG,
    ])
}

/// The attitude error due to an east gyro error \[rad/s\] during a static alignment: `φ_U = -δω_E / (Ω cos L)`.
fn azimuth_error(station: &Station, east: f64) -> Vector3<f64> {
    Vector3::new(0.0, 0.0, -east / (EARTH_RATE * station.site.latitude.cos()))
}

/// The attitude error due to an accelerometer error in n \[m/s²\] during a static alignment:
/// `φ_E = -δf_N / g`, `φ_N = δf_E / g`, `φ_U = φ_N tan L`.
fn tilt_error(station: &Station, force: &Vector3<f64>) -> Vector3<f64> {
    let north = force.x / station.gravity;
    Vector3::new(-force.y / station.gravity, north, north * station.site.latitude.tan())
}

/// A cause at its best-fitting size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Explanation {
    /// The cause.
    pub(crate) cause: Cause,
    /// Its size, in its unit.
    pub(crate) size: f64,
    /// The ratio of the root mean squares after and before the explanation: 0 is a full explanation, 1 none.
    pub(crate) left: f64,
}

/// The causes, each alone at its best-fitting size for the velocities of `misfit` (printed minus
/// model \[m/s\]), best first.
///
/// # Errors
/// [`ReproductionError`] if a navigation fails.
pub(crate) fn velocity_explanations(
    causes: &[Cause],
    base: &PureNavigation,
    misfit: [f64; 2],
) -> Result<Vec<Explanation>, ReproductionError> {
    let misfit = SVector::from(misfit);
    let mut explanations = Vec::with_capacity(causes.len());
    for &cause in causes {
        let effect = cause.effect(base)?.fixed_rows::<2>(0).into_owned();
        let size = effect.dot(&misfit) / effect.norm_squared();
        let left = (misfit - effect * size).norm() / misfit.norm();
        explanations.push(Explanation { cause, size, left });
    }
    explanations.sort_by(|one, other| one.left.total_cmp(&other.left));
    Ok(explanations)
}

/// The origin of the permitted size of a cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Basis {
    /// The paper states it for its instruments, or it follows from its statements.
    Stated,
    /// The paper does not state it: a typical size for such instruments.
    Plausible,
}

/// A cause with its permitted size, in its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Graded {
    /// The cause.
    pub(crate) cause: Cause,
    /// The permitted size, in its unit.
    pub(crate) grade: f64,
    /// The origin of that size.
    pub(crate) basis: Basis,
    /// The effect per unit: m/s and degrees.
    pub(crate) effect: SVector<f64, 5>,
}

impl Graded {
    /// The size, in its unit, that causes the error `wanted` in one figure.
    pub(crate) fn needed(&self, figure: usize, wanted: f64) -> f64 {
        wanted / self.effect[figure]
    }

    /// The fraction of the error `wanted` in one figure that the permitted size causes: 1 is the full error.
    pub(crate) fn share(&self, figure: usize, wanted: f64) -> f64 {
        (self.effect[figure] * self.grade / wanted).abs()
    }

    /// The size that causes the error `wanted`, divided by the permitted size.
    pub(crate) fn multiple(&self, figure: usize, wanted: f64) -> f64 {
        (self.needed(figure, wanted) / self.grade).abs()
    }
}

/// The causes of one figure's error `wanted`, in decreasing order of their fractions, each with its fraction.
pub(crate) fn ranked(causes: &[Graded], figure: usize, wanted: f64) -> Vec<(&Graded, f64)> {
    let mut ranked: Vec<(&Graded, f64)> =
        causes.iter().map(|graded| (graded, graded.share(figure, wanted))).collect();
    ranked.sort_by(|one, other| other.1.total_cmp(&one.1));
    ranked
}

/// The fraction of an error that all causes together explain at their permitted sizes: the root sum of squares of
/// their fractions, for independent causes.
pub(crate) fn share_of_all(causes: &[Graded], figure: usize, wanted: f64) -> f64 {
    causes.iter().map(|graded| graded.share(figure, wanted).powi(2)).sum::<f64>().sqrt()
}
