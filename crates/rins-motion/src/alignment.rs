//! Static alignment: level from gravity, north from the Earth's rotation.

use nalgebra::{Matrix3, Vector3};
use rins_frames::{Body, Dcm, InFrame, Nav, Rates};

use crate::station::Station;

/// The specific force \[m/s²\] below which leveling is impossible.
const LEAST_GRAVITY: f64 = 1.0;

/// The azimuth sigma \[rad\] above which north is undetermined.
const LARGEST_AZIMUTH_SIGMA: f64 = 0.5;

/// The uncertainty of the mean rates of a stationary IMU: 1σ of each axis, noise and sensor errors together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanUncertainty {
    /// 1σ of each gyro's mean \[rad/s\].
    pub angular_rate: f64,
    /// 1σ of each accelerometer's mean \[m/s²\].
    pub specific_force: f64,
}

/// The attitude of a stationary IMU, and its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alignment {
    /// The attitude, `C_b^n`.
    pub nav_from_body: Dcm<Nav, Body>,
    /// The covariance of its error `φ`, resolved in n \[rad²\].
    pub covariance: Matrix3<f64>,
}

/// The properties of the site according to a stationary IMU, without prior knowledge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaceSeen {
    /// The magnitude of the mean specific force \[m/s²\].
    pub gravity: f64,
    /// The magnitude of the mean angular rate \[rad/s\].
    pub earth_rate: f64,
    /// The latitude from the angle between the two \[rad\].
    pub latitude: f64,
    /// Its 1σ \[rad\].
    pub latitude_sigma: f64,
}

/// The reason why the attitude cannot be determined.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AlignmentError {
    /// There is no specific force for leveling.
    #[error("the mean specific force is {specific_force} m/s², too small for leveling")]
    NoGravity {
        /// Its magnitude \[m/s²\].
        specific_force: f64,
    },
    /// The errors of the gyros exceed the Earth's rate.
    #[error(
        "the gyros cannot determine north: the azimuth would have a sigma of {azimuth_sigma:.2} rad; \
         state the attitude, or use better gyros"
    )]
    NorthNotFound {
        /// The 1σ that the azimuth would have \[rad\].
        azimuth_sigma: f64,
    },
}

/// The properties of the site according to the mean rates of a stationary IMU.
pub fn place_seen(mean: &Rates, sigma: &MeanUncertainty) -> PlaceSeen {
    let (f, w) = (mean.specific_force, mean.angular_rate);
    let (gravity, earth_rate) = (f.norm(), w.norm());
    let horizontal = f.cross(&w).norm() / gravity;
    PlaceSeen {
        gravity,
        earth_rate,
        latitude: (f.dot(&w) / gravity).atan2(horizontal),
        latitude_sigma: (sigma.angular_rate / earth_rate).hypot(sigma.specific_force / gravity),
    }
}

/// The attitude of a stationary IMU: up is opposite to gravity, and the Earth's rate has no east component.
///
/// The covariance follows from `C~ f~ ∥ up` and `(C~ ω~)_E = 0`: with the error `φ` of `C~ = (I - φ×) C`, `φ_E = -δf_N/g`,
/// `φ_N = δf_E/g` and `φ_U = (φ_N Ω sin L - δω_E) / (Ω cos L)`. A mean rate error along east is indistinguishable from an
/// azimuth error.
///
/// # Errors
/// [`AlignmentError`] if there is no gravity, or if the azimuth sigma exceeds half a radian.
pub fn align(
    mean: &Rates,
    sigma: &MeanUncertainty,
    station: &Station,
) -> Result<Alignment, AlignmentError> {
    let f = mean.specific_force.components();
    let specific_force = f.norm();
    if specific_force.is_nan() || specific_force < LEAST_GRAVITY {
        return Err(AlignmentError::NoGravity { specific_force });
    }
    let covariance = covariance(sigma, station);
    let azimuth_sigma = covariance[(2, 2)].sqrt();
    let up = f / specific_force;
    let east = mean.angular_rate.components().cross(&up);
    let horizontal = east.norm();
    if azimuth_sigma.is_nan() || azimuth_sigma > LARGEST_AZIMUTH_SIGMA || horizontal <= 0.0 {
        return Err(AlignmentError::NorthNotFound { azimuth_sigma });
    }
    let east = east / horizontal;
    Ok(Alignment { nav_from_body: from_axes(&east, &up), covariance })
}

/// The attitude of a stationary IMU with a known yaw.
///
/// # Errors
/// [`AlignmentError::NoGravity`] if there is none for leveling.
pub fn level(mean: &Rates, yaw: f64) -> Result<Dcm<Nav, Body>, AlignmentError> {
    let f = mean.specific_force.components();
    let specific_force = f.norm();
    if specific_force.is_nan() || specific_force < LEAST_GRAVITY {
        return Err(AlignmentError::NoGravity { specific_force });
    }
    let up = f / specific_force;
    // Body x, projected onto the level, is an arbitrary east; a rotation about up then sets the yaw.
    let seed = if up.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
    let east = (seed - up * up.dot(&seed)).normalize();
    let any = from_axes(&east, &up);
    let turn = yaw - any.euler_angles().yaw;
    Ok(Dcm::<Nav, Nav>::about_z(turn) * any)
}

/// The residuals of the mean rates for an attitude: measured minus predicted.
///
/// The gyro part is the estimated bias without its component along east, which the azimuth has absorbed; of the accelerometer
/// part only the component along up remains.
pub fn residual(mean: &Rates, nav_from_body: Dcm<Nav, Body>, station: &Station) -> Rates {
    let body_from_nav = nav_from_body.inverse();
    Rates {
        angular_rate: mean.angular_rate - body_from_nav * station.site.earth_rate(),
        specific_force: mean.specific_force + body_from_nav * station.gravity_vector(),
    }
}

fn covariance(sigma: &MeanUncertainty, station: &Station) -> Matrix3<f64> {
    let earth_rate: InFrame<Nav> = station.site.earth_rate();
    let (north, up) = (earth_rate.components().y, earth_rate.components().z);
    let tilt = sigma.specific_force / station.gravity;
    let by_force = Matrix3::new(0.0, -tilt, 0.0, tilt, 0.0, 0.0, tilt * up / north, 0.0, 0.0);
    let azimuth = sigma.angular_rate / north;
    by_force * by_force.transpose()
        + Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, azimuth * azimuth))
}

fn from_axes(east: &Vector3<f64>, up: &Vector3<f64>) -> Dcm<Nav, Body> {
    let north = up.cross(east);
    let rows = [east.transpose(), north.transpose(), up.transpose()];
    Dcm::from_matrix(Matrix3::from_rows(&rows)).expect("three orthonormal rows are a rotation")
}
