//! Channels that are stuck, for some time or throughout.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rins_frames::InFrame;
use rins_inspection::{CHANNELS, Suspicion, inspect};
use rins_motion::Recording;

use crate::run::{CHIP, NAVIGATION, expected, record, usual};

#[test]
fn channel_that_sticks_for_long_is_suspected() {
    for (channel, grade) in [(0, NAVIGATION), (4, NAVIGATION), (2, CHIP)] {
        let mut recording = record(usual(), grade, 12);
        let held = recording.increments[4000];
        for sample in &mut recording.increments[4001..4100] {
            let (mut angle, mut velocity) =
                (*sample.angle.components(), *sample.velocity.components());
            match channel {
                0..3 => angle[channel] = held.angle.components()[channel],
                _ => velocity[channel - 3] = held.velocity.components()[channel - 3],
            }
            sample.angle = InFrame::from_components(angle);
            sample.velocity = InFrame::from_components(velocity);
        }
        let found = inspect(&recording, &expected(grade)).suspicions;
        let sticks = Suspicion::Sticks {
            channel: CHANNELS[channel],
            rows: 1,
            count: 99,
            time: recording.times[4001],
        };
        assert!(found.contains(&sticks), "{found:?}");
    }
}

/// For any fraction of a log, from less than a percent to all but the first ninth: one channel, or all six, at the previous
/// reading or at zero.
#[test]
fn channels_that_stick_for_any_share_of_a_log_are_suspected() {
    let mut missed = Vec::new();
    for draw in 0..200_u64 {
        let mut random = Pcg64::seed_from_u64(draw);
        let grade = if draw % 3 == 0 { CHIP } else { NAVIGATION };
        let mut recording = record(usual(), grade, 100 + draw);
        let samples = recording.len();
        let length = (samples / random.random_range(1..150)).clamp(60, samples * 8 / 9);
        let first = random.random_range(samples / 10..samples - length + 1);
        let (channel, zero) = (random.random_range(0..7_usize), random.random_range(0..2) == 0);
        let held = recording.increments[first - 1];
        for sample in &mut recording.increments[first..first + length] {
            let mut readings = [*sample.angle.components(), *sample.velocity.components()];
            for of in (0..6).filter(|of| channel == 6 || *of == channel) {
                let before = [held.angle.components(), held.velocity.components()];
                let reading = if zero { 0.0 } else { before[of / 3][of % 3] };
                readings[of / 3][of % 3] = reading;
            }
            sample.angle = InFrame::from_components(readings[0]);
            sample.velocity = InFrame::from_components(readings[1]);
        }
        let found = inspect(&recording, &expected(grade)).suspicions;
        let stuck = |suspicion: &Suspicion| match suspicion {
            Suspicion::Sticks { channel: of, .. } | Suspicion::FlatTop { channel: of, .. } => {
                channel == 6 || *of == CHANNELS[channel]
            }
            _ => false,
        };
        if !found.iter().any(stuck) {
            missed.push((draw, channel, zero, length, first));
        }
    }
    assert!(missed.is_empty(), "{} of 200: {missed:?}", missed.len());
}

/// A channel that never changes beside noisy ones is stuck; one of a coarse triad, or without noise, may be static.
#[test]
fn channel_that_never_moves_is_told_by_the_others_of_its_triad() {
    let stuck = |recording: &Recording| {
        let found = inspect(recording, &expected(NAVIGATION)).suspicions;
        found.iter().filter(|found| matches!(found, Suspicion::StuckChannel { .. })).count()
    };
    let hold = |recording: &mut Recording, step: f64| {
        for sample in &mut recording.increments {
            let held = *sample.velocity.components();
            let held = held.map(|v| if step > 0.0 { (v / step).round() * step } else { v });
            sample.velocity = InFrame::new(held.x, held.y, 0.098);
        }
    };
    let mut noisy = record(usual(), NAVIGATION, 11);
    hold(&mut noisy, 0.0);
    assert_eq!(stuck(&noisy), 1);
    let mut coarse = record(usual(), NAVIGATION, 11);
    hold(&mut coarse, 0.01);
    assert_eq!(stuck(&coarse), 0);
}
