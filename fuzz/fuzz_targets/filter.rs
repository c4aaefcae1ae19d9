//! The filter with any numbers: it says what is wrong and stays as it was, or stays a filter.
#![no_main]

use nalgebra::{Matrix2, Matrix2x3, Matrix3, Vector2, Vector3};
use rins_ekf::{Filter, Measurement};

/// A start, and the steps from there on.
type Steps = ([f64; 3], [f64; 6], Vec<([f64; 9], [f64; 3], [f64; 2], [f64; 6], [f64; 3])>);

libfuzzer_sys::fuzz_target!(|input: Steps| {
    let (state, [a, b, c, d, e, f], steps) = input;
    let covariance = Matrix3::new(a, b, c, b, d, e, c, e, f);
    let Ok(mut filter) = Filter::new(Vector3::from(state), covariance) else { return };
    for (transition, noise, value, matrix, [p, q, r]) in steps {
        let transition = Matrix3::from_column_slice(&transition);
        filter.predict(&transition, &Matrix3::from_diagonal(&Vector3::from(noise)));
        let before = filter.clone();
        let measurement = Measurement::new(
            Vector2::from(value),
            Matrix2x3::from_column_slice(&matrix),
            Matrix2::new(p, q, q, r),
        );
        match filter.update(&measurement) {
            Ok(innovation) => {
                assert!(filter.state.iter().chain(&filter.covariance).all(|x| x.is_finite()));
                assert!(filter.covariance == filter.covariance.transpose());
                assert!(filter.covariance.diagonal().iter().all(|variance| *variance >= 0.0));
                assert!(innovation.nis() >= 0.0);
            }
            Err(error) => {
                assert!(!error.to_string().is_empty());
                let bits = |filter: &Filter<3>| -> Vec<u64> {
                    let all = filter.state.iter().chain(&filter.covariance);
                    all.map(|number| number.to_bits()).collect()
                };
                assert_eq!(bits(&filter), bits(&before));
            }
        }
    }
});
