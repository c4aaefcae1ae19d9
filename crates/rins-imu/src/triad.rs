//! The deterministic errors of three sensors on nearly orthogonal axes, and their compensation.

use nalgebra::{Matrix3, Vector3};
use rins_frames::{Body, InFrame};

use crate::axis::Axis;

/// The minimum reciprocal condition number at which `I + S + M` is inverted: below it, the inverse
/// loses more than half the digits of a double.
const LEAST_RECIPROCAL_CONDITION: f64 = 1e-8;

/// Bias, scale error and misalignment of a triad: `measured = true + bias + (S + M) true` (eq. (1)).
///
/// Rates and increments are in the body frame; `(S + M)` multiplies the *true* quantity. The
/// default is a triad without errors.
///
/// The matrix is not a rotation: its six misalignments are independent, so that they contain both the
/// non-orthogonality of the sensors and a common rotation relative to the body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TriadError {
    /// The output of each sensor for a true rate of zero: \[rad/s\] for gyros, \[m/s²\] for accelerometers.
    pub bias: Vector3<f64>,
    /// `(S + M)`: scale errors on the diagonal, misalignments \[rad\] off the diagonal, at (row, column) as in eq. (1).
    pub matrix: Matrix3<f64>,
}

impl TriadError {
    /// The error of the same sensors along other axes: `rotation` maps a vector along the present axes to
    /// `rotation · vector`.
    #[must_use]
    pub fn along(&self, rotation: &Matrix3<f64>) -> Self {
        Self { bias: rotation * self.bias, matrix: rotation * self.matrix * rotation.transpose() }
    }

    /// This error, with another bias: \[rad/s\] for gyros, \[m/s²\] for accelerometers.
    #[must_use]
    pub fn with_bias(mut self, axis: Axis, bias: f64) -> Self {
        self.bias[axis.index()] = bias;
        self
    }

    /// This error, with another scale error (a ratio).
    #[must_use]
    pub fn with_scale(mut self, axis: Axis, scale: f64) -> Self {
        self.matrix[(axis.index(), axis.index())] = scale;
        self
    }

    /// This error, with another misalignment \[rad\]: the fraction of `column`'s quantity that the sensor `row` measures.
    ///
    /// With `row` equal to `column` this is the scale error.
    #[must_use]
    pub fn with_misalignment(mut self, row: Axis, column: Axis, misalignment: f64) -> Self {
        self.matrix[(row.index(), column.index())] = misalignment;
        self
    }

    /// The scale error `S` of a sensor, a ratio; positive if the output is too large.
    pub fn scale(&self, axis: Axis) -> f64 {
        self.matrix[(axis.index(), axis.index())]
    }

    /// The misalignment `M` at (`row`, `column`) of eq. (1) \[rad\]: the fraction of `column`'s quantity
    /// that the sensor `row` measures.
    ///
    /// With `row` equal to `column` this is the scale error.
    pub fn misalignment(&self, row: Axis, column: Axis) -> f64 {
        self.matrix[(row.index(), column.index())]
    }

    /// The output of the triad \[rad/s or m/s²\] for the true `rate`.
    #[must_use]
    pub fn measured_rate(&self, rate: &InFrame<Body>) -> InFrame<Body> {
        self.measured_increment(rate, 1.0)
    }

    /// The output of the triad \[rad or m/s\] over `interval` \[s\] for the true `increment`.
    ///
    /// Eq. (1) is linear with constant coefficients, so its integral is exact for any motion.
    #[must_use]
    pub fn measured_increment(&self, increment: &InFrame<Body>, interval: f64) -> InFrame<Body> {
        let truth = increment.components();
        InFrame::from_components(truth + (self.matrix * truth + self.bias * interval))
    }

    /// The exact compensation of this error.
    ///
    /// # Errors
    /// [`CompensationError`] if the error is not finite, a sensor does not react to motion, or the outputs of the three
    /// sensors are nearly linearly dependent.
    ///
    /// # Examples
    /// A sensor with a scale error of -1 does not react to motion:
    /// ```
    /// use rins_imu::{Axis, CompensationError, TriadError};
    /// let broken = TriadError::default().with_scale(Axis::Y, -1.0);
    /// assert_eq!(
    ///     broken.compensation(),
    ///     Err(CompensationError::DeadAxis { axis: Axis::Y, scale_error: -1.0 }),
    /// );
    /// ```
    pub fn compensation(&self) -> Result<TriadCompensation, CompensationError> {
        if !(self.bias.iter().chain(self.matrix.iter()).all(|x| x.is_finite())) {
            return Err(CompensationError::NotFinite);
        }
        let gain = Matrix3::identity() + self.matrix;
        let size = gain.amax();
        for axis in Axis::ALL {
            if gain.row(axis.index()).amax() <= LEAST_RECIPROCAL_CONDITION * size {
                return Err(CompensationError::DeadAxis { axis, scale_error: self.scale(axis) });
            }
        }
        let singular = CompensationError::Singular { determinant: gain.determinant() };
        // Scaled to a largest element of 1, so that no determinant overflows.
        let inverse = (gain / size).try_inverse().ok_or(singular)?;
        let reciprocal_condition = 1.0 / inverse.amax();
        if reciprocal_condition >= LEAST_RECIPROCAL_CONDITION {
            Ok(TriadCompensation { bias: self.bias, excess: self.matrix * (inverse / size) })
        } else {
            Err(singular)
        }
    }
}

/// The reason why a triad's errors cannot be compensated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompensationError {
    /// A bias, scale error or misalignment is infinite or NaN.
    #[error("a bias, scale or misalignment error is not a finite number")]
    NotFinite,
    /// A sensor does not react to any motion.
    #[error("axis {axis} has a scale error of {scale_error}, so its reading contains no signal")]
    DeadAxis {
        /// The sensor.
        axis: Axis,
        /// Its scale error, a ratio.
        scale_error: f64,
    },
    /// The three sensors do not measure three independent directions.
    #[error("the three axes read nearly the same: I + S + M has determinant {determinant}")]
    Singular {
        /// The determinant of `I + S + M`; without error it is 1.
        determinant: f64,
    },
}

/// The exact compensation of a [`TriadError`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriadCompensation {
    bias: Vector3<f64>,
    /// `(S + M) (I + S + M)⁻¹`: the fraction of a reading that is error. Its subtraction preserves the last
    /// digits, which a multiplication by an inverse near the identity would round away.
    excess: Matrix3<f64>,
}

impl TriadCompensation {
    /// The true rate \[rad/s or m/s²\] for the output `measured`.
    #[must_use]
    pub fn true_rate(&self, measured: &InFrame<Body>) -> InFrame<Body> {
        self.true_increment(measured, 1.0)
    }

    /// The true increment \[rad or m/s\] for the output `measured` over `interval` \[s\].
    #[must_use]
    pub fn true_increment(&self, measured: &InFrame<Body>, interval: f64) -> InFrame<Body> {
        let unbiased = measured.components() - self.bias * interval;
        InFrame::from_components(unbiased - self.excess * unbiased)
    }
}

#[cfg(test)]
mod tests;
