//! A line's mean over a sample against a sum over many parts of it.

use std::f64::consts::TAU;

use rins_terms::{SettingKind, TermInstance, catalogue, values};
use rins_testing::assert_close;

use crate::support::{INTERVAL, run};

#[test]
fn line_is_integrated_over_its_sample() {
    const PARTS: u32 = 2000;
    let track = &run().track;
    for frequency in [0.3, 7.0, 24.9, 60.0] {
        let line = TermInstance::new(&catalogue::INTERFERENCE_LINE)
            .with_setting(SettingKind::Frequency, frequency)
            .with_setting(SettingKind::Axis, 2.0)
            .with_values(&[1.0, 0.5, 0.2, -3.0]);
        for moment in track.moments().step_by(371) {
            let start = moment.mean.time - INTERVAL / 2.0;
            let (mut cos, mut sin) = (0.0, 0.0);
            for part in 0..PARTS {
                let time = start + INTERVAL * (f64::from(part) + 0.5) / f64::from(PARTS);
                let (s, c) = (TAU * frequency * time).sin_cos();
                cos += c / f64::from(PARTS);
                sin += s / f64::from(PARTS);
            }
            let signals = line.signals(&moment, None);
            let (gyro, accel) = (values(&signals.gyro), values(&signals.accel));
            // The midpoint rule, relative: (2π f T / 2000)² / 24.
            assert_close!(gyro.y, cos + 0.5 * sin, 1e-6);
            assert_close!(accel.y, 0.2 * cos - 3.0 * sin, 1e-6);
            assert_eq!((gyro.x, gyro.z, accel.x, accel.z), (0.0, 0.0, 0.0, 0.0));
        }
    }
}

#[test]
fn line_of_a_whole_turn_a_sample_is_not_seen() {
    let track = &run().track;
    let line = TermInstance::new(&catalogue::INTERFERENCE_LINE)
        .with_setting(SettingKind::Frequency, 1.0 / INTERVAL)
        .with_values(&[1.0; 4]);
    for moment in track.moments().step_by(371) {
        assert_close!(values(&line.signals(&moment, None).gyro).z, 0.0, 1e-9);
    }
}
