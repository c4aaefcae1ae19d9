//! The baseline of the triads is eq. (1) as `rins-imu` has it.

use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use rins_imu::{ImuError, TriadError};
use rins_terms::{MeasurementModel, Model};
use rins_testing::any_matrix;

use crate::support::run;

/// Sets a triad's parameters in a model.
fn with(model: Model, triad: &str, error: &TriadError) -> Model {
    let names = ["x", "y", "z"];
    let mut model = model;
    for row in 0..3 {
        model = model.with_value(&format!("{triad}.bias.{}", names[row]), error.bias[row]);
        for column in 0..3 {
            let element = error.matrix[(row, column)];
            let id = if row == column {
                format!("{triad}.scale.{}", names[row])
            } else {
                format!("{triad}.misalignment.{}{}", names[row], names[column])
            };
            model = model.with_value(&id, element);
        }
    }
    model
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn triads_measure_as_imu_errors_do(gyro in any_matrix(), accel in any_matrix()) {
        let matrix = |rows: [[f64; 3]; 3]| Matrix3::from_fn(|row, column| 1e-3 * rows[row][column]);
        let error = ImuError {
            gyro: TriadError { bias: Vector3::new(1e-6, -2e-6, 3e-6), matrix: matrix(gyro) },
            accel: TriadError { bias: Vector3::new(-1e-3, 2e-3, 3e-3), matrix: matrix(accel) },
        };
        let model = with(with(Model::full(), "gyro", &error.gyro), "accel", &error.accel);
        let run = run();
        let mut making = MeasurementModel::new(&model, &run.track);
        for (moment, truth) in run.track.moments().zip(&run.recording.increments).step_by(53) {
            let got = making.read(&moment, truth).increments;
            let want = error.measure(truth);
            prop_assert!((got.angle - want.angle).norm() < 1e-15);
            prop_assert!((got.velocity - want.velocity).norm() < 1e-15);
        }
    }
}
