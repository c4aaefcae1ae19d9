//! What is read while the table speeds up or slows down, against the motion itself.

use rins_terms::{SettingKind, TermInstance, catalogue, values};

use crate::support::{INTERVAL, run};

/// A part of a sample, and several samples.
const LATE: [f64; 2] = [5e-3, 0.137];

#[test]
fn force_and_rate_are_the_means_over_every_sample() {
    let run = run();
    for (moment, felt) in run.track.moments().zip(&run.recording.increments) {
        let felt = felt.rates();
        let force = (moment.force - felt.specific_force.components()).norm();
        let rate = (moment.rate - felt.angular_rate.components()).norm();
        // Of what the angle in the middle of the way would make of ramps, a twentieth is left where one begins.
        assert!(force < 2e-6, "at {} s: {force} m/s²", moment.end.time);
        assert!(rate < 2e-11, "at {} s: {rate} rad/s", moment.end.time);
    }
}

#[test]
fn acceleration_is_that_of_the_sample_where_ramps_begin_and_end() {
    let run = run();
    let rate = |time: f64| run.motion.profile.rate(time);
    for moment in run.track.moments().skip(3).take(5990) {
        let change = rate(moment.end.time) - rate(moment.end.time - INTERVAL);
        let off = (moment.mean.acceleration - change / INTERVAL).abs();
        assert!(off < 1e-9, "at {} s: {off} rad/s²", moment.end.time);
    }
}

/// A late reading is that of an earlier angle, which the motion knows.
#[test]
fn late_readings_are_earlier_ones_in_every_sample() {
    let run = run();
    let angle = |time: f64| run.motion.profile.angle(time.max(0.0));
    for delay in LATE {
        let late = |term| TermInstance::new(term).with_values(&[delay]);
        let lag = late(&catalogue::GYRO_LAG);
        let latency = late(&catalogue::ENCODER_LATENCY);
        let lost = late(&catalogue::DROPPED_SAMPLES).with_setting(SettingKind::Time, 0.0);
        for moment in run.track.moments().skip(3).take(5980) {
            let end = moment.end.time;
            let turned = |by: f64| angle(end + by) - angle(end);
            let over = |by: f64| angle(end + by) - angle(end - INTERVAL + by);
            let gyro = values(&lag.signals(&moment, None).gyro).z;
            let want = (over(-delay) - over(0.0)) / INTERVAL;
            assert!((gyro - want).abs() < 1e-9, "gyro at {end} s: {gyro} {want}");
            for (chosen, by) in [(&latency, -delay), (&lost, delay)] {
                let read = chosen.signals(&moment, None).angle.re;
                let off = (read - turned(by)).abs();
                assert!(off < 1e-11, "{} at {end} s: {off} rad", chosen.term.id);
            }
        }
    }
}
