//! Late readings against the same motion read earlier.

use rins_terms::{MeasurementModel, Model, SettingKind, TermInstance, catalogue};
use rins_testing::assert_close;

use crate::support::{ACCELERATION, INTERVAL, Run, run};

/// Two delays: less than a sample, and more.
const DELAYS: [f64; 2] = [3e-3, 15e-3];

/// Whether the acceleration changes within two samples of `time`.
fn at_a_corner(run: &Run, time: f64) -> bool {
    let span = 3.0 * INTERVAL;
    let rate = |time: f64| run.motion.profile.rate(time);
    let (before, after) = (rate(time) - rate(time - span), rate(time + span) - rate(time));
    (before - after).abs() > 1e-9
}

/// By how much a reading at a corner may be wrong: half of the acceleration is not known there.
fn corner(delay: f64) -> f64 {
    ACCELERATION * (delay + INTERVAL).powi(2)
}

/// The errors of the angle against those of `shifted` times.
fn check_angle(model: &Model, shifted: impl Fn(f64) -> f64, largest_delay: f64) {
    let run = run();
    let mut making = MeasurementModel::new(model, &run.track);
    for (moment, truth) in run.track.moments().zip(&run.recording.increments) {
        let time = moment.end.time;
        let got = making.read(&moment, truth).angle_error;
        let want = run.motion.profile.angle(shifted(time)) - run.motion.profile.angle(time);
        let within = if at_a_corner(run, time) { corner(largest_delay) } else { 1e-11 };
        assert_close!(got, want, within);
    }
}

#[test]
fn late_encoder_reads_an_earlier_angle() {
    for delay in DELAYS {
        let late = TermInstance::new(catalogue::term("readout_lag").unwrap()).with_values(&[delay]);
        check_angle(&Model::default().with(late), |time| time - delay, delay);
    }
}

#[test]
fn drifting_clock_reads_later_and_later() {
    let drift = TermInstance::new(&catalogue::CLOCK_DRIFT).with_values(&[50e-6]);
    check_angle(&Model::default().with(drift), |time| time * (1.0 - 50e-6), 6e-3);
}

#[test]
fn dropped_samples_leave_later_angles() {
    let dropped = TermInstance::new(&catalogue::DROPPED_SAMPLES)
        .with_setting(SettingKind::Time, 47.0)
        .with_values(&[0.01]);
    let shifted = |time: f64| if time < 47.0 { time } else { time + 0.01 };
    check_angle(&Model::default().with(dropped), shifted, 0.01);
}

#[test]
fn late_sensors_read_earlier_motion() {
    let run = run();
    for delay in DELAYS {
        let model = Model::default()
            .with(TermInstance::new(&catalogue::GYRO_LAG).with_values(&[delay]))
            .with(TermInstance::new(&catalogue::ACCEL_LATENCY).with_values(&[delay]));
        let mut making = MeasurementModel::new(&model, &run.track);
        let mut shown = 0.0_f64;
        for (moment, truth) in run.track.moments().zip(&run.recording.increments) {
            let (from, to) = (moment.end.time - INTERVAL - delay, moment.end.time - delay);
            let got = making.read(&moment, truth).increments;
            let want = run.motion.increments(from, to);
            let abrupt = at_a_corner(run, moment.mean.time);
            // A sample's mean of a vector that turns along a ramp, delayed, is another by 1e-7 of it.
            let angle = if abrupt { ACCELERATION * (delay + INTERVAL) * INTERVAL } else { 1e-11 };
            let velocity = if abrupt { 9.8 * corner(delay) * INTERVAL } else { 1e-8 };
            assert!((got.angle - want.angle).norm() < angle);
            assert!((got.velocity - want.velocity).norm() < velocity);
            shown = shown.max((want.velocity - truth.velocity).norm());
        }
        // At 20 deg/s a transverse gravity of 5 m/s² and more turns by the delay's angle.
        assert!(shown > 5.0 * 0.35 * delay * INTERVAL);
    }
}
