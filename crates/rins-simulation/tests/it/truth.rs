//! Runs without random errors consist of the true motion and eq. (1) only.

use rins_frames::InFrame;
use rins_frames::units::{DEG, PPM};
use rins_imu::{Axis, ImuError, ImuNoise, TriadError};
use rins_motion::TrueMotion;
use rins_simulation::{Scenario, TableRecord, Temperature, simulate};
use rins_testing::assert_close;

use crate::{INTERVAL, perfect, realistic};

#[test]
fn perfect_run_is_the_true_motion_to_the_last_bit() {
    let scenario = perfect();
    let run = simulate(&scenario).unwrap();
    let motion = TrueMotion {
        station: scenario.station,
        nav_from_table: scenario.nav_from_table,
        profile: scenario.profile,
    };
    let samples: Vec<_> = motion.samples(INTERVAL).collect();
    assert_eq!(run.recording.len(), 9000);
    assert!(samples.iter().map(|sample| sample.increments).eq(run.recording.increments));
    assert!(samples.iter().map(|sample| sample.time).eq(run.recording.times));
    assert_eq!(run.recording.table_angle.as_ref(), Some(&run.truth.table_angle));
}

#[test]
fn noise_of_zero_is_no_noise() {
    let silent = Scenario { noise: Some(ImuNoise::default()), ..perfect() };
    assert_eq!(simulate(&silent).unwrap(), simulate(&perfect()).unwrap());
}

#[test]
fn compensation_recovers_the_true_motion() {
    let imu_error = realistic().imu_error;
    let measured = simulate(&Scenario { imu_error, ..perfect() }).unwrap().recording;
    let truth = simulate(&perfect()).unwrap().recording;
    let compensation = imu_error.compensation().unwrap();
    for (measured, truth) in measured.increments.iter().zip(&truth.increments) {
        let undone = compensation.compensate(measured);
        assert!((undone.angle - truth.angle).norm() <= 1e-15 * (truth.angle.norm() + 1e-3));
        assert!((undone.velocity - truth.velocity).norm() <= 1e-15 * truth.velocity.norm());
    }
}

#[test]
fn scale_error_shows_as_the_turn_times_itself() {
    let gyro = TriadError::default().with_scale(Axis::Z, 300.0 * PPM);
    let scenario = Scenario { imu_error: ImuError { gyro, ..ImuError::default() }, ..perfect() };
    let total = |scenario: &Scenario, until: usize| {
        let increments = simulate(scenario).unwrap().recording.increments;
        increments[..until].iter().fold(InFrame::zeros(), |sum, k| sum + k.angle)
    };
    // After the forward rotation: 60 s at 10 deg/s, minus 10 deg for a ramp of 2 s, and the
    // Earth rotation about a tilted axis, which is at most 0.5 deg.
    let excess = total(&scenario, 6000) - total(&perfect(), 6000);
    assert_close!(excess.components().z, 300.0 * PPM * 590.0 * DEG, 300.0 * PPM * 0.5 * DEG);
    // The reverse rotation is 560 deg, because its ramp takes 4 s with a sum of zero: 30 deg remain.
    let excess = total(&scenario, 9000) - total(&perfect(), 9000);
    assert_close!(excess.components().z, 300.0 * PPM * 30.0 * DEG, 300.0 * PPM * 0.8 * DEG);
}

#[test]
fn attitude_turns_with_the_table() {
    let truth = simulate(&perfect()).unwrap().truth;
    assert_eq!(truth.attitude(2999), Some(truth.initial_attitude()));
    assert_eq!(truth.attitude(9000), None);
    let turned = truth.initial_attitude().inverse() * truth.attitude(3499).unwrap();
    // Ten seconds at 10 deg/s, minus 10 deg for the ramp.
    let angle = turned.rotation_vector();
    assert_close!(angle.z, 90.0 * DEG, 1e-12);
    assert_close!(angle.xy().norm(), 0.0, 1e-12);
}

#[test]
fn only_what_was_asked_for_is_recorded() {
    let record = |table| simulate(&Scenario { table, ..perfect() }).unwrap().recording;
    let nothing = record(TableRecord::Nothing);
    assert_eq!((nothing.table_angle, nothing.table_rate, nothing.temperature), (None, None, None));

    let commanded = record(TableRecord::CommandedRate);
    assert_eq!(commanded.table_angle, None);
    let rates = commanded.table_rate.unwrap();
    assert_eq!(rates.len(), 9000);
    assert_close!(rates[1000], 0.0, 1e-15);
    assert_close!(rates[5000], 10.0 * DEG, 1e-12);
    assert_close!(rates[8000], -10.0 * DEG, 1e-12);

    let warm = simulate(&Scenario { temperature: Some(Temperature::Constant(25.0)), ..perfect() })
        .unwrap()
        .recording;
    assert_eq!(warm.temperature, Some(vec![25.0; 9000]));
}
