//! Section 5: the effect of Table 5's errors in a quarter of an hour, and that of the IMU's grade.

use crate::causes::{self, Basis, Cause};
use crate::experiment::Experiment;
use crate::{printed, real_test};
use rins_frames::units::{ARCSEC, DEG, PPM};
use rins_testing::assert_close;

#[test]
fn scale_error_alone_makes_most_of_the_yaw() {
    let experiment = Experiment::real_test().unwrap();
    let predicted = real_test::predicted(&experiment).unwrap();
    // 84.0126 ppm over 9000 deg are 0.756 deg; the rotation of the level with 5 m/s of velocity subtracts 0.01 deg.
    let by_hand = printed::TABLE_5[2] * PPM * 9000.0 * DEG;
    assert_close!(predicted.attitude.yaw, by_hand, 0.015 * DEG);
    assert!(predicted.attitude.yaw < by_hand);
    // The printed value is larger.
    assert!(printed::TABLE_6_BEFORE.attitude_error[2] * DEG > by_hand + 0.1 * DEG);
}

/// The estimates are those of Table 5 except for noise, whatever the biases and the table rate; the true errors vary.
#[test]
fn emulated_runs_estimate_table_5_from_errors_that_differ() {
    let experiment = Experiment::real_test().unwrap();
    let runs = real_test::emulate(&experiment, 6, || ()).unwrap();
    // 1σ of noise over 100 s, 0.02 deg/h/sqrt(Hz) over 10 deg/s and sqrt(100 s): 0.0115 arcsec, 0.056 ppm. Through the
    // zero velocity, accelerometer biases add a few hundredths.
    let noise = [0.0115, 0.0115, 0.056];
    for run in &runs {
        for (place, want) in printed::TABLE_5.into_iter().enumerate() {
            let unit = if place < 2 { ARCSEC } else { PPM };
            assert_close!(run.estimate[place] / unit, want, 5.0 * noise[place] + 0.05);
            // A bias of 0.1 deg/h is 0.57 arcsec and 2.8 ppm, the table rate another 10 ppm; five times the former.
            let within = if place < 2 { 2.9 } else { 24.0 };
            assert_close!(run.truth[place] / unit, want, within);
        }
        assert!(run.after.velocity.iter().all(|velocity| velocity.abs() < 8.0), "{run:?}");
        // The rotation that the table lacks appears as yaw, over 9000 deg: at most 10 ppm, and some drift.
        assert_close!(run.after.attitude.yaw, 0.0, 0.1 * DEG);
        assert!((run.online.attitude.yaw - run.after.attitude.yaw).abs() < 0.002 * DEG, "{run:?}");
    }
    let spread = |of: &dyn Fn(&real_test::Emulated) -> f64| {
        crate::statistics::Sample::of(runs.iter().map(of)).deviation
    };
    assert!(spread(&|run| run.truth.z) > 1.0 * PPM);
    assert!(spread(&|run| run.after.attitude.yaw) > 0.005 * DEG);
    assert!((runs[0].after.velocity[1] - runs[1].after.velocity[1]).abs() > 1e-3);
}

/// A yaw of `-e × 9000 deg` if the attitude is compared with the table angle, and no velocity.
#[test]
fn the_tables_stated_rate_accuracy_makes_the_yaw() {
    let experiment = Experiment::real_test().unwrap();
    let wanted = printed::TABLE_6_AFTER.figures();
    let causes = real_test::causes_after(&experiment).unwrap();
    let rate = causes.iter().find(|graded| graded.cause == Cause::TableRate).unwrap();
    assert_close!(rate.effect[4], -9000.0 * PPM, 0.01 * 9000.0 * PPM);
    assert_close!(rate.needed(4, wanted[4]), -0.0771 / 9000.0 / PPM, 0.1);
    assert_close!(rate.grade, 10.0, 1e-9);
    assert!(rate.multiple(4, wanted[4]) < 1.0, "{rate:?}");
    // The drift that is unobservable in the calibration is too small by a factor of three, and so is the effect of a bias.
    for other in [Cause::GyroBiasChange(2), Cause::Estimate(2)] {
        let graded = causes.iter().find(|graded| graded.cause == other).unwrap();
        assert!(graded.multiple(4, wanted[4]) > 3.0, "{graded:?}");
    }
    let first = causes::ranked(&causes, 4, wanted[4]);
    let stated = first.iter().find(|(graded, _)| graded.basis == Basis::Stated).unwrap();
    assert_eq!(stated.0.cause, Cause::TableRate);
    assert!(stated.1 > 1.0 && stated.1 < 1.3, "{stated:?}");
}

#[test]
fn no_stated_cause_makes_the_roll() {
    let experiment = Experiment::real_test().unwrap();
    let wanted = printed::TABLE_6_AFTER.figures();
    let causes = real_test::causes_after(&experiment).unwrap();
    for graded in &causes {
        match graded.cause {
            // 0.0734 deg are 264 arcsec, independent of the others.
            Cause::Tilt(1) => assert_close!(graded.needed(2, wanted[2]), -264.2, 0.5),
            Cause::GyroNoise => assert!(graded.multiple(2, wanted[2]) > 10.0, "{graded:?}"),
            _ => assert!(graded.multiple(2, wanted[2]) > 20.0, "{graded:?}"),
        }
    }
    assert!(causes::share_of_all(&causes, 2, wanted[2]) < 0.1);
}
