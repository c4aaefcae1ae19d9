//! The inputs and outputs of the error mechanism: sensor errors, navigation errors.

use std::ops::{Add, Mul, Sub};

use nalgebra::{Matrix3, Vector3};
use rins_frames::{Body, Dcm, EulerAngles, InFrame, Increments, Nav, Rates, Table};

use crate::station::Station;
use crate::strapdown::NavState;

/// A table with a constant rate, from table angle zero.
///
/// For a rotation that starts at another angle `ζ`, the axis frame is that of the start:
/// `nav_from_table * Dcm::<Table, Table>::about_z(ζ)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantTurn {
    /// The site of the table.
    pub station: Station,
    /// The attitude of the axis frame, `C_s^n`.
    pub nav_from_table: Dcm<Nav, Table>,
    /// The rate `ω` about the spin axis \[rad/s\].
    pub rate: f64,
}

impl ConstantTurn {
    /// The true attitude after `time` \[s\], `C_b^n = C_s^n Rz(ω t)` (eq. (4)).
    pub fn nav_from_body(&self, time: f64) -> Dcm<Nav, Body> {
        self.nav_from_table * Dcm::<Table, Body>::about_z(self.rate * time)
    }
}

/// The gyro errors that the table rate amplifies: the last column of the matrix in eq. (1).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpinAxisErrors {
    /// `M_xz`: the fraction of the spin rate that the x gyro measures \[rad\].
    pub misalignment_xz: f64,
    /// `M_yz`: the fraction of the spin rate that the y gyro measures \[rad\].
    pub misalignment_yz: f64,
    /// `S_z`: the scale error of the z gyro.
    pub scale_z: f64,
}

impl SpinAxisErrors {
    /// The three as the vector that is multiplied by the rate in eq. (3).
    pub(super) fn vector(&self) -> Vector3<f64> {
        Vector3::new(self.misalignment_xz, self.misalignment_yz, self.scale_z)
    }
}

/// Constant errors of both triads: measured = true + bias + matrix · true (eq. (1)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorErrors {
    /// The gyros' biases \[rad/s\].
    pub gyro_bias: InFrame<Body>,
    /// The gyros' scale errors and misalignments, `(S + M)`.
    pub gyro_matrix: Matrix3<f64>,
    /// The accelerometers' biases \[m/s²\].
    pub accel_bias: InFrame<Body>,
    /// The accelerometers' scale errors and misalignments.
    pub accel_matrix: Matrix3<f64>,
}

impl SensorErrors {
    /// Sensors without errors.
    pub fn none() -> Self {
        Self {
            gyro_bias: InFrame::zeros(),
            gyro_matrix: Matrix3::zeros(),
            accel_bias: InFrame::zeros(),
            accel_matrix: Matrix3::zeros(),
        }
    }

    /// The errors of these sensors at the true rates.
    pub fn of(&self, truth: &Rates) -> Rates {
        let by = |matrix: &Matrix3<f64>, rate: &InFrame<Body>| {
            InFrame::from_components(matrix * rate.components())
        };
        Rates {
            angular_rate: self.gyro_bias + by(&self.gyro_matrix, &truth.angular_rate),
            specific_force: self.accel_bias + by(&self.accel_matrix, &truth.specific_force),
        }
    }

    /// The output of these sensors over an interval.
    pub fn measured(&self, truth: &Increments) -> Increments {
        let error = self.of(&truth.rates()).over(truth.interval);
        Increments {
            angle: truth.angle + error.angle,
            velocity: truth.velocity + error.velocity,
            interval: truth.interval,
        }
    }
}

impl From<SpinAxisErrors> for SensorErrors {
    fn from(errors: SpinAxisErrors) -> Self {
        let mut gyro_matrix = Matrix3::zeros();
        gyro_matrix.set_column(2, &errors.vector());
        Self { gyro_matrix, ..Self::none() }
    }
}

/// The errors of a navigator's state, computed minus true.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NavErrors {
    /// `φ^n` of `C~ = (I - φ×) C` \[rad\].
    pub attitude: InFrame<Nav>,
    /// `δv^n` \[m/s\].
    pub velocity: InFrame<Nav>,
    /// The error of latitude \[rad\].
    pub latitude: f64,
    /// The error of longitude \[rad\].
    pub longitude: f64,
    /// The error of height \[m\].
    pub height: f64,
}

impl NavErrors {
    /// No error.
    pub fn none() -> Self {
        Self {
            attitude: InFrame::zeros(),
            velocity: InFrame::zeros(),
            latitude: 0.0,
            longitude: 0.0,
            height: 0.0,
        }
    }

    /// The errors of a computed state.
    ///
    /// The attitude error is the full rotation vector, whose first-order term is `φ`.
    pub fn between(computed: &NavState, truth: &NavState) -> Self {
        Self {
            attitude: attitude_error(computed.nav_from_body, truth.nav_from_body),
            velocity: computed.velocity - truth.velocity,
            latitude: computed.position.latitude - truth.position.latitude,
            longitude: computed.position.longitude - truth.position.longitude,
            height: computed.position.height - truth.position.height,
        }
    }

    /// The errors of roll, pitch and yaw due to the attitude error: computed minus true \[rad\].
    pub fn of_euler_angles(&self, nav_from_body: Dcm<Nav, Body>) -> EulerAngles {
        let error = -*self.attitude.components();
        let computed =
            (Dcm::<Nav, Nav>::from_rotation_vector(&error) * nav_from_body).euler_angles();
        let truth = nav_from_body.euler_angles();
        let apart = |computed: f64, truth: f64| {
            let turn = computed - truth;
            turn.sin().atan2(turn.cos())
        };
        EulerAngles {
            roll: apart(computed.roll, truth.roll),
            pitch: computed.pitch - truth.pitch,
            yaw: apart(computed.yaw, truth.yaw),
        }
    }
}

/// The rotation vector `φ` of `C~ = exp(-φ×) C`, resolved in n.
pub(super) fn attitude_error(computed: Dcm<Nav, Body>, truth: Dcm<Nav, Body>) -> InFrame<Nav> {
    let apart: Dcm<Nav, Nav> = computed * truth.inverse();
    InFrame::from_components(-apart.rotation_vector())
}

impl Add for NavErrors {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            attitude: self.attitude + other.attitude,
            velocity: self.velocity + other.velocity,
            latitude: self.latitude + other.latitude,
            longitude: self.longitude + other.longitude,
            height: self.height + other.height,
        }
    }
}

impl Mul<f64> for NavErrors {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self {
            attitude: self.attitude * factor,
            velocity: self.velocity * factor,
            latitude: self.latitude * factor,
            longitude: self.longitude * factor,
            height: self.height * factor,
        }
    }
}

impl Sub for NavErrors {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}
