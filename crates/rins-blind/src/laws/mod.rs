//! The laws of effects, each evaluated at an instant of the true motion.

pub(crate) mod accel;
pub(crate) mod encoder;
pub(crate) mod fault;
pub(crate) mod gyro;
pub(crate) mod gyro_force;
pub(crate) mod noise;
pub(crate) mod surroundings;
pub(crate) mod table;

use nalgebra::Vector3;

/// The state of the table at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// The time since the start of the run \[s\].
    pub time: f64,
    /// The table angle \[rad\].
    pub angle: f64,
    /// The last direction of rotation of the table: 1, -1, or 0 before the first rotation.
    pub sense: f64,
}

/// The quantities that act on an IMU over a short step.
#[derive(Clone, Copy, Debug)]
pub struct Instant {
    /// The time since the start of the run \[s\].
    pub time: f64,
    /// The table's rate \[rad/s\].
    pub rate: f64,
    /// The sign of the last change of the table's rate: 1, -1, or 0 before the first change.
    pub rise: f64,
    /// The temperature above that at the start \[K\].
    pub warming: f64,
    /// Its rate of change \[K/s\].
    pub warming_rate: f64,
    /// The body's rate with respect to inertial space \[rad/s\].
    pub turning: Vector3<f64>,
    /// The component of that rate about each gyro's own axis \[rad/s\].
    pub about_axes: Vector3<f64>,
    /// The specific force \[m/s²\].
    pub force: Vector3<f64>,
    /// The magnetic flux density in body axes \[T\].
    pub field: Vector3<f64>,
}

/// The unit step: 0 before `time`, 1 after it.
pub(crate) fn after(time: f64, now: f64) -> f64 {
    if now >= time { 1.0 } else { 0.0 }
}

/// A polynomial of the third degree in the temperature above that at the start.
pub(crate) fn thermal(p: &[f64], now: &Instant) -> Vector3<f64> {
    (axes(p) + (axes(&p[3..]) + axes(&p[6..]) * now.warming) * now.warming) * now.warming
}

/// Three parameters as a vector, one per axis.
pub(crate) fn axes(p: &[f64]) -> Vector3<f64> {
    Vector3::new(p[0], p[1], p[2])
}
