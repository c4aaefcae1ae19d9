//! How effects act, each on an instant of the true motion.

pub(crate) mod accel;
pub(crate) mod encoder;
pub(crate) mod fault;
pub(crate) mod gyro;
pub(crate) mod gyro_force;
pub(crate) mod noise;
pub(crate) mod surroundings;
pub(crate) mod table;

use nalgebra::Vector3;

/// Where the table is at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// Since the run began \[s\].
    pub time: f64,
    /// The table angle \[rad\].
    pub angle: f64,
    /// The way the table turned last: 1, -1, or 0 before it ever turned.
    pub sense: f64,
}

/// What an IMU feels over a short step.
#[derive(Clone, Copy, Debug)]
pub struct Instant {
    /// Since the run began \[s\].
    pub time: f64,
    /// The table's rate \[rad/s\].
    pub rate: f64,
    /// The way the table's rate changed last: 1, -1, or 0 before it ever changed.
    pub rise: f64,
    /// The temperature above that at the start \[K\].
    pub warming: f64,
    /// How fast it changes \[K/s\].
    pub warming_rate: f64,
    /// The body's rate with respect to inertial space \[rad/s\].
    pub turning: Vector3<f64>,
    /// Of that, what each gyro turns about its own axis \[rad/s\].
    pub about_axes: Vector3<f64>,
    /// The specific force \[m/s²\].
    pub force: Vector3<f64>,
    /// The magnetic flux density in body axes \[T\].
    pub field: Vector3<f64>,
}

/// 0 before `time`, 1 after it.
pub(crate) fn after(time: f64, now: f64) -> f64 {
    if now >= time { 1.0 } else { 0.0 }
}

/// Three parameters, one an axis.
pub(crate) fn axes(p: &[f64]) -> Vector3<f64> {
    Vector3::new(p[0], p[1], p[2])
}
