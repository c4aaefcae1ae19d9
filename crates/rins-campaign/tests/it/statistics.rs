//! The paper's filter is consistent under its own model, and a wrong noise density is detected.

use nalgebra::{Matrix3, Vector3};
use rins_calibration::Estimate;
use rins_campaign::{RunFailure, Statistics, Tally};
use rins_simulation::TableRecord;
use rins_testing::assert_close;

use crate::support::cell;

fn statistics(noise_claimed: f64) -> Statistics {
    let mut cell = cell(30.0, TableRecord::CommandedRate);
    cell.setup.imu.gyro.noise_density *= noise_claimed;
    cell.setup.imu.accel.noise_density *= noise_claimed;
    let runs = cell.prepare().expect("the cell can be run").run(0..400);
    Statistics::of(&cell.truth(), &runs).expect("the runs have estimates")
}

#[test]
fn honest_covariances_are_called_so() {
    let statistics = statistics(1.0);
    assert!(statistics.is_honest(), "{statistics:?}");
    assert_eq!((statistics.runs, statistics.failed), (400, 0));
    for parameter in statistics.parameters {
        // Five sigma of a standard deviation, a mean and a frequency from 400 runs.
        assert!((parameter.spread / parameter.claimed - 1.0).abs() < 5.0 / 800_f64.sqrt());
        assert!(parameter.mean_error.abs() < 5.0 * parameter.spread / 20.0);
        assert!((parameter.coverage - 0.95).abs() < 5.0 * (0.95 * 0.05 / 400.0_f64).sqrt());
    }
    assert!((statistics.nis_ratio - 1.0).abs() < 0.01, "{}", statistics.nis_ratio);
}

#[test]
fn half_or_twice_the_noise_is_found_out() {
    for claimed in [0.5, 2.0] {
        let statistics = statistics(claimed);
        assert!(!statistics.is_honest(), "{statistics:?}");
    }
}

#[test]
fn one_run_has_no_statistics() {
    let cell = cell(10.0, TableRecord::CommandedRate);
    let runs = cell.prepare().unwrap().run(0..1);
    assert!(Statistics::of(&cell.truth(), &runs).is_none());
}

#[test]
fn sums_keep_the_digits_of_a_small_spread_about_a_large_error() {
    // Errors of 1e8 + 4, 7, 13 and 16, whose variance is 30; the stated variance is 31.
    let mut tally = Tally::new(Vector3::repeat(-1e8));
    for error in [4.0, 7.0, 13.0, 16.0] {
        tally.add(&Err(RunFailure { reason: "none".into() }));
        let covariance = Matrix3::from_diagonal_element(31.0);
        tally.add(&Ok(Estimate { value: Vector3::repeat(error), covariance, nis_ratio: error }));
    }
    let found = tally.statistics().expect("four runs have estimates");
    assert_eq!((found.runs, found.failed, tally.runs()), (4, 4, 8));
    for parameter in found.parameters {
        assert_close!(parameter.spread, 30_f64.sqrt(), 1e-12);
        assert_close!(parameter.claimed, 31_f64.sqrt(), 1e-12);
        assert_close!(parameter.mean_error, 1e8 + 10.0, 1e-7);
        assert_eq!(parameter.coverage.to_bits(), 0);
    }
    assert_close!(found.nis_ratio, 10.0, 1e-12);
}
