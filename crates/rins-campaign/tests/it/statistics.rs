//! The paper's filter is honest about its own model, and a wrong noise is found out.

use rins_campaign::Statistics;
use rins_simulation::TableRecord;

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
