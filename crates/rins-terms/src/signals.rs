//! What terms add to: the readings of the sensors and the encoder, and the direction of the axis.

use nalgebra::Vector3;
use num_dual::Dual64;

/// A vector whose components carry a derivative.
pub type DualVector = [Dual64; 3];

/// What the terms add over one sample, each number with its derivative by one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Signals {
    /// To the mean rate that the gyros read \[rad/s\].
    pub gyro: DualVector,
    /// To the mean specific force that the accelerometers read \[m/s²\].
    pub accel: DualVector,
    /// To the table angle that is read at the sample's end \[rad\].
    pub angle: Dual64,
    /// The rotation vector, in the axis frame, by which table and IMU are tilted at the sample's end \[rad\].
    ///
    /// It is a true motion: gyros and accelerometers feel it, and a reading of the table angle does not.
    pub tilt: DualVector,
}

impl Default for Signals {
    fn default() -> Self {
        let zero = Dual64::from_re(0.0);
        Self { gyro: [zero; 3], accel: [zero; 3], angle: zero, tilt: [zero; 3] }
    }
}

impl Signals {
    /// Adds what other terms add.
    pub fn add(&mut self, other: &Self) {
        for axis in 0..3 {
            self.gyro[axis] += other.gyro[axis];
            self.accel[axis] += other.accel[axis];
            self.tilt[axis] += other.tilt[axis];
        }
        self.angle += other.angle;
    }

    /// Adds `factor · vector` to the gyros \[rad/s\].
    pub(crate) fn add_gyro(&mut self, factor: Dual64, vector: &Vector3<f64>) {
        add(&mut self.gyro, factor, vector);
    }

    /// Adds `factor · vector` to the accelerometers \[m/s²\].
    pub(crate) fn add_accel(&mut self, factor: Dual64, vector: &Vector3<f64>) {
        add(&mut self.accel, factor, vector);
    }

    /// Adds `factor · vector` to the tilt \[rad\].
    pub(crate) fn add_tilt(&mut self, factor: Dual64, vector: &Vector3<f64>) {
        add(&mut self.tilt, factor, vector);
    }
}

fn add(to: &mut DualVector, factor: Dual64, vector: &Vector3<f64>) {
    for (axis, component) in vector.iter().enumerate() {
        to[axis] += factor * *component;
    }
}

/// Adds `factor · parameters`, one parameter a component.
pub(crate) fn add_constant(to: &mut DualVector, parameters: &[Dual64], factor: f64) {
    for (to, &parameter) in to.iter_mut().zip(parameters) {
        *to += parameter * factor;
    }
}

/// Adds to each component a parameter of its own times the component of a vector.
pub(crate) fn add_scaled(to: &mut DualVector, parameters: &[Dual64], of: &Vector3<f64>) {
    for axis in 0..3 {
        to[axis] += parameters[axis] * of[axis];
    }
}

/// Adds `[parameters] · of`, the parameters being a matrix row by row.
pub(crate) fn add_matrix(to: &mut DualVector, parameters: &[Dual64], of: &Vector3<f64>) {
    for (to, row) in to.iter_mut().zip(parameters.chunks_exact(3)) {
        for (&parameter, &component) in row.iter().zip(of) {
            *to += parameter * component;
        }
    }
}

/// The values of a vector, without its derivatives.
pub fn values(vector: &DualVector) -> Vector3<f64> {
    Vector3::from(vector.map(|dual| dual.re))
}

/// The derivatives of a vector.
pub fn derivatives(vector: &DualVector) -> Vector3<f64> {
    Vector3::from(vector.map(|dual| dual.eps))
}
