//! Rotations that are too slow to be distinguished from a gyro bias end a static interval; the sway of a base does not.

use std::ops::Range;

use rins_frames::InFrame;
use rins_frames::units::{DEG, DEG_PER_SECOND};
use rins_inspection::{StaticIntervals, StaticOptions};
use rins_motion::Recording;

use crate::run::{CHIP, Grade, NAVIGATION, profile, record};

/// The static intervals of at least this duration \[s\].
fn rest_spans(recording: &Recording, shortest: f64) -> Vec<Range<usize>> {
    StaticIntervals::of(recording, &StaticOptions::default()).spans(shortest)
}

/// A recording of these segments without table readings.
fn unattended(segments: &[(f64, f64)]) -> Recording {
    Recording { table_angle: None, ..record(profile(segments), NAVIGATION, 1) }
}

#[test]
fn steady_slow_turn_is_never_at_rest() {
    for rate in [0.5, -0.1, 0.02] {
        let recording = unattended(&[(rate, 300.0)]);
        assert_eq!(rest_spans(&recording, 1.0), [], "{rate} deg/s");
    }
}

#[test]
fn slow_turn_after_a_rest_ends_it() {
    for (rate, late) in [(0.5, 150), (0.02, 500)] {
        let spans = rest_spans(&unattended(&[(0.0, 60.0), (rate, 300.0), (0.0, 60.0)]), 1.0);
        let [first, last] = &spans[..] else { panic!("{spans:?}") };
        assert!(first.start == 0 && first.end.abs_diff(3000) <= late, "{spans:?}");
        assert!(last.start.abs_diff(18000) <= late && last.end == 21000, "{spans:?}");
    }
}

/// 0.3 deg in half a minute is less than the sway of a base, but continues steadily.
#[test]
fn short_steady_turn_is_no_rest() {
    assert_eq!(rest_spans(&unattended(&[(0.02, 30.0)]), 1.0), []);
}

#[test]
fn noisy_sensors_rest_as_well() {
    // The means over a second scatter by 0.05 deg/s, which would be a rotation for a good gyro.
    let coarse = Grade { gyro_noise: 0.03 * DEG_PER_SECOND, ..CHIP };
    for (grade, seed) in [(CHIP, 2), (coarse, 3)] {
        let recording = record(profile(&[(0.0, 300.0)]), grade, seed);
        let recording = Recording { table_angle: None, ..recording };
        let spans = rest_spans(&recording, 1.0);
        assert!(spans.len() == 1 && spans[0] == (0..15000), "{spans:?}");
    }
}

/// A floor that tilts by 0.2 deg in three seconds, and back, due to a bystander.
#[test]
fn swaying_base_stays_at_rest() {
    let mut recording = unattended(&[(0.0, 600.0)]);
    let mut tilt = 0.0_f64;
    for (index, sample) in recording.increments.iter_mut().enumerate() {
        let second = index / 50;
        let target = match second {
            100..250 => 0.2,
            250..300 => -0.1,
            300..450 => 0.15,
            _ => 0.0,
        } * DEG;
        let step = (target - tilt).clamp(-0.07 * DEG / 50.0, 0.07 * DEG / 50.0);
        tilt += step;
        sample.angle += InFrame::new(step, 0.0, 0.0);
        let force = sample.velocity;
        sample.velocity += force.cross(&InFrame::new(tilt, 0.0, 0.0));
    }
    let spans = rest_spans(&recording, 1.0);
    assert!(spans.len() == 1 && spans[0] == (0..30000), "{spans:?}");
}
