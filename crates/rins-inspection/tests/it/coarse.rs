//! Coarse sensors, whose noise is a few least significant bits.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rins_frames::{InFrame, Increments};
use rins_inspection::{Expected, Suspicion, inspect};
use rins_motion::Recording;

use crate::run::INTERVAL;

/// Readings of a coarse sensor that were rounded once more, as by a division by intervals of its time stamps: an excursion of a few LSBs is
/// no spike, although most readings are equal but for the last digits; one of many LSBs is.
#[test]
fn coarse_readings_are_no_spikes_after_another_rounding() {
    for draw in 0..40_u64 {
        let mut random = Pcg64::seed_from_u64(draw);
        let step = 1e-3;
        // The share of the readings that differ from the usual one, by up to four LSBs.
        let share = random.random_range(0.03..0.4);
        let rounding = 10_f64.powf(random.random_range(-13.0..-6.0));
        let mut recording = Recording::default();
        for sample in 1..=20_000_u32 {
            let mut reading = |mean: f64| {
                let differs = random.random_bool(share);
                let by = if differs { f64::from(random.random_range(-4..=4_i32)) } else { 0.0 };
                let rounded: f64 = random.random_range(-rounding..rounding);
                ((mean / step).round() + by) * step * (1.0 + rounded)
            };
            let angle = InFrame::new(reading(0.0), reading(0.01), reading(0.0));
            let velocity = InFrame::new(reading(0.0), reading(0.0), reading(9.8 * INTERVAL));
            recording.times.push(f64::from(sample) * INTERVAL);
            recording.increments.push(Increments { angle, velocity, interval: INTERVAL });
        }
        let spikes = |recording: &Recording| -> Vec<&'static str> {
            let found = inspect(recording, &Expected::default()).suspicions;
            let of = |one: &Suspicion| match one {
                Suspicion::Spike { channel, .. } => Some(*channel),
                _ => None,
            };
            found.iter().filter_map(of).collect()
        };
        assert!(spikes(&recording).is_empty(), "{draw}");
        let place = random.random_range(100..19_900);
        recording.increments[place].velocity += InFrame::new(0.0, 500.0 * step, 0.0);
        assert_eq!(spikes(&recording), ["accel.y"], "{draw}");
    }
}
