//! Errors of channels and of the table's rotation that an inspection finds.

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal, StudentT};
use rand_pcg::Pcg64;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_SECOND};
use rins_frames::{InFrame, Increments};
use rins_inspection::{CHANNELS, Expected, ExpectedTriad, Suspicion, inspect};
use rins_motion::{Profile, Recording, Segment};
use rins_testing::assert_close;

use crate::run::{
    CHIP, INTERVAL, NAVIGATION, assert_unsuspected, expected, profile, record, usual,
};

/// The only suspicion about a recording.
fn only_suspicion(recording: &Recording, expected: &Expected) -> Suspicion {
    let found = inspect(recording, expected).suspicions;
    assert_eq!(found.len(), 1, "{found:?}");
    found[0].clone()
}

/// The recording with the commanded rate `commanded` instead of the table angle.
fn commanded(recording: Recording, commanded: &Profile) -> Recording {
    let rate = |time: &f64| (commanded.angle(*time) - commanded.angle(time - INTERVAL)) / INTERVAL;
    let table_rate = Some(recording.times.iter().map(rate).collect());
    Recording { table_rate, table_angle: None, ..recording }
}

fn with_table_angle(recording: &Recording, of: impl Fn(f64) -> f64) -> Recording {
    let table_angle = recording.table_angle.iter().flatten().map(|angle| of(*angle)).collect();
    Recording { table_angle: Some(table_angle), ..recording.clone() }
}

#[test]
fn profile_that_the_table_did_not_follow_is_suspected() {
    let segments = [(0.0, 20.0), (10.0, 120.0), (0.0, 20.0)];
    for grade in [NAVIGATION, CHIP] {
        let recording = record(profile(&segments), grade, 1);
        let right = commanded(recording.clone(), &profile(&segments));
        assert_unsuspected(&right, &expected(grade));

        // Without its ramps the profile rotates 10 deg farther in the first two seconds.
        let jumps = segments.map(|(rate, duration)| Segment { rate: rate * DEG, duration });
        let abrupt = commanded(recording.clone(), &Profile::new(&jumps, None).unwrap());
        let late = commanded(recording, &profile(&[(0.0, 22.0), (10.0, 118.0), (0.0, 20.0)]));
        for (wrong, turn) in [(abrupt, 10.0), (late, 20.0)] {
            let Suspicion::SpinProfile { apart, time } = only_suspicion(&wrong, &expected(grade))
            else {
                panic!("no profile is suspected");
            };
            assert_close!(apart, turn * DEG, 0.2 * DEG);
            assert!((21.0..31.0).contains(&time) || (141.0..151.0).contains(&time), "{time}");
        }
    }
}

#[test]
fn encoder_that_loses_a_degree_is_suspected() {
    let mut recording = record(usual(), NAVIGATION, 2);
    for angle in recording.table_angle.iter_mut().flatten().skip(5000) {
        *angle -= DEG;
    }
    let Suspicion::SpinProfile { apart, .. } = only_suspicion(&recording, &expected(NAVIGATION))
    else {
        panic!("no profile is suspected");
    };
    assert_close!(apart, DEG, 0.05 * DEG);
}

/// A bias that is large compared with the table rate is not a scale error, which would give the other direction another profile.
#[test]
fn bias_is_no_other_profile() {
    let mut recording = record(profile(&[(7.0, 150.0), (-7.0, 120.0)]), CHIP, 5);
    assert_unsuspected(&recording, &expected(CHIP));
    for sample in &mut recording.increments {
        sample.angle += InFrame::new(0.0, 0.0, 0.3 * DEG * sample.interval);
    }
    assert_unsuspected(&recording, &expected(CHIP));
}

#[test]
fn gyros_ratio_to_the_table_is_told_and_its_causes_named() {
    let recording = record(usual(), CHIP, 3);
    let known = expected(CHIP);
    for (factor, words) in [
        (1.0, None),
        // An uncalibrated sensor.
        (1.03, None),
        (0.93, None),
        (1.0 / 0.9, Some("gon were declared as deg")),
        (0.9, Some("deg were declared as gon")),
        (-1.0, Some("the table is opposite to that of the gyro")),
        (DEG, Some("angle in rad were declared as deg")),
    ] {
        let turned = with_table_angle(&recording, |angle| angle * factor);
        let inspection = inspect(&turned, &Expected { axis: None, ..known });
        // The gyro's bias is 2.4 % of its rate here, and is not part of the ratio.
        let ratio = inspection.spin_ratio.unwrap();
        assert_close!(ratio * factor, 1.0, 1e-3);
        let causes: Vec<&str> = inspection
            .suspicions
            .iter()
            .filter_map(|suspicion| match suspicion {
                Suspicion::SpinScale { cause, .. } => Some(cause.as_deref().unwrap_or_default()),
                _ => None,
            })
            .collect();
        match words {
            None => assert!(causes.is_empty(), "{factor}: {causes:?}"),
            Some(words) => assert!(causes.len() == 1 && causes[0].contains(words), "{causes:?}"),
        }
    }
    assert_eq!(inspect(&Recording { table_angle: None, ..recording }, &known).spin_ratio, None);
}

#[test]
fn spikes_are_found_in_each_channel() {
    for (channel, size) in [(0, 100.0), (2, 0.5), (3, 1e6), (5, -3.0)] {
        let mut recording = record(usual(), NAVIGATION, 4);
        for (index, factor) in [(1000, 0.5), (9000, 1.0)] {
            let Increments { angle, velocity, .. } = &mut recording.increments[index];
            let mut spike = Vector3::zeros();
            spike[channel % 3] = size * factor * INTERVAL;
            let target = if channel < 3 { angle } else { velocity };
            *target += InFrame::from_components(spike);
        }
        let found = inspect(&recording, &expected(NAVIGATION)).suspicions;
        let Some(Suspicion::Spike { channel: name, count, time, reading }) =
            found.iter().find(|suspicion| matches!(suspicion, Suspicion::Spike { .. }))
        else {
            panic!("{found:?}");
        };
        assert_eq!((*name, *count), (CHANNELS[channel], 2));
        assert_close!(*time, 180.02, 1e-9);
        assert!((reading - size).abs() < 10.0, "{reading}");
    }
}

/// Noise with Student's t distribution and few degrees of freedom has large values: the largest reading exceeds the others as
/// these exceed the rest of them. A single spike is detected in it too.
#[test]
fn largest_of_heavy_tails_is_no_spike() {
    /// A value of this size relative to the typical noise would be a spike in normal noise.
    const LARGE: f64 = 80.0;
    let tails = StudentT::new(2.5).unwrap();
    let size = 2e-6;
    let (mut large, mut suspected) = (0, 0);
    let is_spike = |one: &Suspicion| matches!(one, Suspicion::Spike { channel: "gyro.z", .. });
    for seed in 0..20 {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut recording = record(usual(), NAVIGATION, seed);
        let mut most = 0.0_f64;
        for sample in &mut recording.increments {
            let drawn: f64 = tails.sample(&mut random);
            most = most.max(drawn.abs());
            sample.angle += InFrame::new(0.0, 0.0, size * drawn);
        }
        large += u32::from(most > LARGE);
        let found = inspect(&recording, &expected(NAVIGATION)).suspicions;
        suspected += u32::from(found.iter().any(is_spike));
        recording.increments[1000].angle += InFrame::new(0.0, 0.0, 100.0 * most * size);
        let found = inspect(&recording, &expected(NAVIGATION)).suspicions;
        assert!(found.iter().any(is_spike), "{found:?}");
    }
    // In some cases the largest value greatly exceeds all others.
    assert!(large >= 4 && 4 * suspected <= large, "{suspected} of {large}");
}

/// A tilt step of the base within a sample affects both gyros perpendicular to the axis once, rarely by equal amounts, and
/// also the gyro along the axis unless that is vertical.
#[test]
fn base_that_tips_over_is_no_spike() {
    let recording = record(usual(), NAVIGATION, 4);
    let reading = |sample: &Increments| sample.rates().angular_rate.components()[1];
    let squares: f64 = recording.increments[..500]
        .windows(2)
        .map(|pair| (reading(&pair[1]) - reading(&pair[0])).powi(2))
        .sum();
    let scatter = (squares / 499.0).sqrt();
    for (shown, spikes) in [
        ([100.0, -60.0, 0.0], 0),
        ([100.0, -60.0, 40.0], 0),
        ([0.0, 0.0, 40.0], 1),
        ([100.0, -12.0 * scatter, 0.0], 0),
        ([100.0, 0.0, 0.0], 1),
        ([100.0, 0.0, -60.0], 2),
    ] {
        let mut recording = recording.clone();
        let pulse = Vector3::from(shown) * INTERVAL;
        recording.increments[1000].angle += InFrame::from_components(pulse);
        let found = inspect(&recording, &expected(NAVIGATION)).suspicions;
        let count = found.iter().filter(|one| matches!(one, Suspicion::Spike { .. })).count();
        assert_eq!(count, spikes, "{found:?}");
    }
}

/// Rotation by hand, a shock, and another rotation: none of it is a spike.
#[test]
fn motion_by_hand_is_no_spike() {
    let mut rng = Pcg64::seed_from_u64(5);
    let mut one = || -> f64 { StandardNormal.sample(&mut rng) };
    let mut recording = Recording::default();
    for index in 0..6000_u32 {
        let time = f64::from(index) * 0.01;
        let phase = time % 10.0;
        // A rotation of three seconds, then a shock with a decaying oscillation, then a static interval.
        let rate = if phase < 3.0 { 100.0 * DEG * (phase * 2.1).sin().powi(2) } else { 0.0 };
        let after = phase - 3.0;
        let ring =
            if after > 0.0 { 20.0 * (-after / 0.02).exp() * (after * 300.0).cos() } else { 0.0 };
        recording.times.push(time + 0.01);
        recording.increments.push(Increments {
            angle: InFrame::new(rate + 1e-3 * one(), 0.3 * rate + 1e-3 * one(), 1e-3 * one())
                * 0.01,
            velocity: InFrame::new(
                ring + 0.02 * one(),
                0.02 * one(),
                9.8 + 0.4 * ring + 0.02 * one(),
            ) * 0.01,
            interval: 0.01,
        });
    }
    assert_unsuspected(&recording, &Expected::default());
}

#[test]
fn saturated_gyros_are_found_by_their_range_and_without_it() {
    let mut recording = record(profile(&[(0.0, 20.0), (40.0, 60.0)]), NAVIGATION, 6);
    recording.table_angle = None;
    let known = expected(NAVIGATION);
    let range = Some(50.0 * DEG_PER_SECOND);
    assert_unsuspected(
        &recording,
        &Expected { gyro: ExpectedTriad { range, ..known.gyro }, ..known },
    );
    let limit = 30.0 * DEG_PER_SECOND;
    for sample in &mut recording.increments {
        let cut = sample.angle.components().map(|angle| angle.min(limit * sample.interval));
        sample.angle = InFrame::from_components(cut);
    }
    // 20 s of a static interval and a ramp of 6 s come before.
    let (channel, first) = ("gyro.z", 26.0);
    match only_suspicion(&recording, &known) {
        Suspicion::FlatTop { channel: found, count, time, reading } => {
            assert_eq!(found, channel);
            assert!(count.abs_diff(2700) < 3, "{count}");
            assert_close!(time, first, 0.05);
            assert_close!(reading, limit, 1e-9);
        }
        other => panic!("{other:?}"),
    }
    let known = Expected { gyro: ExpectedTriad { range: Some(limit), ..known.gyro }, ..known };
    match only_suspicion(&recording, &known) {
        Suspicion::Saturated { channel: found, count, time, range } => {
            assert_eq!((found, range), (channel, limit));
            assert!(count.abs_diff(2700) < 3, "{count}");
            assert_close!(time, first, 0.05);
        }
        other => panic!("{other:?}"),
    }
}

/// A coarse sensor repeats its readings, including the largest, and is not clipped.
#[test]
fn coarse_sensors_are_not_cut_off_and_show_their_step() {
    let step = 20.0 * ARCSEC;
    let mut recording = record(usual(), CHIP, 7);
    for sample in &mut recording.increments {
        let rounded = sample.angle.components().map(|angle| (angle / step).round() * step);
        sample.angle = InFrame::from_components(rounded);
    }
    let inspection = assert_unsuspected(&recording, &expected(CHIP));
    for axis in 0..3 {
        assert_close!(inspection.resolution[axis].unwrap(), step, 1e-3 * step);
    }
    assert_eq!(inspection.resolution[3..], [None; 3]);
}

/// Rates with integer LSBs over intervals from time stamps that are rounded to microseconds and jitter: their increments have
/// a grid of the product of two roundings, which is not the resolution. A reading that changes by one or two LSBs and back is
/// not a spike.
#[test]
fn resolution_of_rates_shows_over_uneven_intervals() {
    for draw in 0..200_u64 {
        let mut random = Pcg64::seed_from_u64(draw);
        let interval = 1e-6 * f64::from(random.random_range(500..20_000_u32));
        let step = 1e-5 * 10_f64.powf(random.random_range(0.0..3.0));
        let noise = step * random.random_range(0.25..5.0);
        let jitter = random.random_range(0..20_u32);
        let mut recording = Recording::default();
        let mut end = 0.0;
        for _ in 0..2000 {
            let late = 1e-6 * f64::from(random.random_range(0..=jitter));
            let interval = interval + late;
            end += interval;
            let mut rate = || {
                let drawn: f64 = StandardNormal.sample(&mut random);
                (noise * drawn / step).round() * step * interval
            };
            let angle = InFrame::new(rate(), rate(), rate());
            let velocity = InFrame::new(rate(), rate(), rate() + 9.8 * interval);
            recording.times.push(end);
            recording.increments.push(Increments { angle, velocity, interval });
        }
        let seen = inspect(&recording, &Expected::default());
        for (channel, found) in seen.resolution.iter().enumerate() {
            let found = found.unwrap_or_default() / seen.timing.interval;
            assert!((found / step - 1.0).abs() < 1e-3, "{draw}: {channel}: {found}, not {step}");
        }
        let is_spike = |suspicion: &Suspicion| matches!(suspicion, Suspicion::Spike { .. });
        assert!(!seen.suspicions.iter().any(is_spike), "{draw}: {:?}", seen.suspicions);
    }
}

/// If the rate of a table is between two values of a gyro, the gyro repeats one of them for long, with single readings of the
/// other, and is not clipped.
#[test]
fn constant_rate_between_two_steps_is_not_cut_off() {
    let step = 0.3 * ARCSEC;
    let slow = profile(&[(0.0, 40.0), (2.0, 200.0), (-2.0, 200.0)]);
    let mut recording = record(slow, NAVIGATION, 11);
    let mut carried = Vector3::<f64>::zeros();
    for sample in &mut recording.increments {
        carried += sample.angle.components();
        let rounded = carried.map(|angle| (angle / step).round() * step);
        carried -= rounded;
        sample.angle = InFrame::from_components(rounded);
    }
    assert_unsuspected(&recording, &expected(NAVIGATION));
    // At half the rate it would be.
    let limit = 1.0 * DEG_PER_SECOND;
    for sample in &mut recording.increments {
        let cut = sample.angle.components().map(|angle| angle.min(limit * sample.interval));
        sample.angle = InFrame::from_components(cut);
    }
    recording.table_angle = None;
    let cut = only_suspicion(&recording, &expected(NAVIGATION));
    assert!(matches!(cut, Suspicion::FlatTop { channel: "gyro.z", .. }), "{cut:?}");
}

/// Decimal numbers with a fixed number of significant digits have no resolution.
#[test]
fn rounded_decimals_are_no_resolution() {
    let mut recording = record(usual(), NAVIGATION, 8);
    for sample in &mut recording.increments {
        let written = sample.angle.components().map(|angle| format!("{:.5e}", angle / INTERVAL));
        let read = Vector3::from_fn(|axis, _| written[axis].parse::<f64>().unwrap() * INTERVAL);
        sample.angle = InFrame::from_components(read);
    }
    let inspection = assert_unsuspected(&recording, &expected(NAVIGATION));
    assert_eq!(inspection.resolution, [None; 6]);
}

#[test]
fn recordings_of_nothing_are_looked_through() {
    let nothing = inspect(&Recording::default(), &expected(NAVIGATION));
    assert!(nothing.rests.is_empty() && nothing.suspicions.is_empty());
    for samples in 1..4 {
        let few = record(usual(), NAVIGATION, 9).slice(0, samples);
        assert_unsuspected(&few, &Expected { station: None, ..expected(NAVIGATION) });
    }
    let mut zero = record(usual(), NAVIGATION, 10).slice(0, 500);
    for sample in &mut zero.increments {
        *sample = Increments { angle: InFrame::zeros(), velocity: InFrame::zeros(), ..*sample };
    }
    zero.table_angle = None;
    let suspicions = inspect(&zero, &Expected::default()).suspicions;
    assert!(suspicions.iter().all(|suspicion| matches!(suspicion, Suspicion::StuckChannel { .. })));
    assert_eq!(suspicions.len(), 6);
}
