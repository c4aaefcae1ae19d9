//! The deterministic errors of an IMU, and their compensation.

use nalgebra::Matrix3;
use rins_frames::Increments;

use crate::axis::Triad;
use crate::triad::{CompensationError, TriadCompensation, TriadError};

/// The errors of a gyro and an accelerometer triad (eq. (1) for each). The default is no error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImuError {
    /// The gyros' errors: biases in rad/s.
    pub gyro: TriadError,
    /// The accelerometers' errors: biases in m/s².
    pub accel: TriadError,
}

impl ImuError {
    /// The errors of the same sensors along other axes: `rotation` maps a vector along the present axes to
    /// `rotation · vector`.
    #[must_use]
    pub fn along(&self, rotation: &Matrix3<f64>) -> Self {
        Self { gyro: self.gyro.along(rotation), accel: self.accel.along(rotation) }
    }

    /// The output of an IMU with these errors for the true increments `truth`.
    #[must_use]
    pub fn measure(&self, truth: &Increments) -> Increments {
        let interval = truth.interval;
        Increments {
            angle: self.gyro.measured_increment(&truth.angle, interval),
            velocity: self.accel.measured_increment(&truth.velocity, interval),
            interval,
        }
    }

    /// The exact compensation of these errors.
    ///
    /// # Errors
    /// [`ImuCompensationError`] if either triad cannot be inverted.
    pub fn compensation(&self) -> Result<Compensation, ImuCompensationError> {
        let of = |error: &TriadError, triad| {
            error.compensation().map_err(|reason| ImuCompensationError { triad, reason })
        };
        Ok(Compensation {
            gyro: of(&self.gyro, Triad::Gyro)?,
            accel: of(&self.accel, Triad::Accel)?,
        })
    }
}

/// The error of a triad that cannot be compensated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the {triad} errors cannot be compensated")]
pub struct ImuCompensationError {
    /// The triad.
    pub triad: Triad,
    /// The reason.
    #[source]
    pub reason: CompensationError,
}

/// The exact compensation of an [`ImuError`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensation {
    /// The compensation of the gyros.
    pub gyro: TriadCompensation,
    /// The compensation of the accelerometers.
    pub accel: TriadCompensation,
}

impl Compensation {
    /// The true increments for the output `measured` of the IMU.
    #[must_use]
    pub fn compensate(&self, measured: &Increments) -> Increments {
        let interval = measured.interval;
        Increments {
            angle: self.gyro.true_increment(&measured.angle, interval),
            velocity: self.accel.true_increment(&measured.velocity, interval),
            interval,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Axis;
    use proptest::prelude::*;
    use rins_frames::InFrame;

    proptest! {
        #[test]
        fn compensating_a_measurement_yields_the_truth(
            parameters in prop::array::uniform24(-0.01..0.01_f64),
            angle in [-0.1..0.1_f64, -0.1..0.1_f64, -0.1..0.1_f64],
            velocity in [-0.2..0.2_f64, -0.2..0.2_f64, -0.2..0.2_f64],
        ) {
            let triad = |p: &[f64]| TriadError {
                bias: nalgebra::Vector3::from_column_slice(&p[..3]),
                matrix: Matrix3::from_column_slice(&p[3..]),
            };
            let error = ImuError { gyro: triad(&parameters[..12]), accel: triad(&parameters[12..]) };
            let truth = Increments {
                angle: InFrame::from_components(angle.into()),
                velocity: InFrame::from_components(velocity.into()),
                interval: 0.02,
            };
            let undone = error.compensation().unwrap().compensate(&error.measure(&truth));
            // Relative to the signal, or to the bias if that is larger.
            prop_assert!((undone.angle - truth.angle).norm() <= 1e-15 * (truth.angle.norm() + 1e-3));
            prop_assert!(
                (undone.velocity - truth.velocity).norm() <= 1e-15 * (truth.velocity.norm() + 1e-3)
            );
        }
    }

    #[test]
    fn refusal_names_the_triad() {
        let error = ImuError {
            accel: TriadError::default().with_scale(Axis::Z, -1.0),
            ..ImuError::default()
        };
        let refusal = error.compensation().unwrap_err();
        assert_eq!(refusal.triad, Triad::Accel);
        assert_eq!(refusal.to_string(), "the accelerometer errors cannot be compensated");
        assert_eq!(
            refusal.reason.to_string(),
            "axis z has a scale error of -1, so its reading contains no signal"
        );
    }
}
