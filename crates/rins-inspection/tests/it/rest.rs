//! Static intervals of the IMU, and its mean output in them.

use std::ops::Range;

use nalgebra::Vector3;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G};
use rins_frames::{EulerAngles, InFrame, Increments};
use rins_inspection::{StaticIntervals, StaticOptions};
use rins_motion::{Profile, Recording, RestMean, Segment, TrueMotion};
use rins_testing::assert_close;

use crate::run::{PAPER_LATITUDE, station};

/// The static intervals of at least this duration \[s\].
fn rest_spans(recording: &Recording, shortest: f64) -> Vec<Range<usize>> {
    StaticIntervals::of(recording, &StaticOptions::default()).spans(shortest)
}

const INTERVAL: f64 = 0.02;

/// Samples per second.
const SECOND: usize = 50;

/// White noise densities of a navigation-grade IMU \[rad/s/√Hz\], \[m/s²/√Hz\].
const GYRO_NOISE: f64 = 0.02 * DEG_PER_HOUR;
const ACCEL_NOISE: f64 = 30.0 * MICRO_G;

/// Static for a minute, rotating for one, static for another.
fn dwell_turn_dwell(rate: f64) -> TrueMotion {
    let segments =
        [(0.0, 60.0), (rate, 60.0), (0.0, 60.0)].map(|(rate, duration)| Segment { rate, duration });
    TrueMotion {
        station: station(PAPER_LATITUDE),
        nav_from_table: EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG }.dcm(),
        profile: Profile::new(&segments, Some(0.5)).unwrap(),
    }
}

/// A recording of the motion with `noise` times the sensors' noise, and no table.
fn recorded(motion: &TrueMotion, noise: f64, seed: u64) -> Recording {
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut white = |density: f64| {
        let mut one = || -> f64 { StandardNormal.sample(&mut rng) };
        InFrame::from_components(
            Vector3::new(one(), one(), one()) * (density * noise * INTERVAL.sqrt()),
        )
    };
    let (times, increments) = motion
        .samples(INTERVAL)
        .map(|sample| {
            let truth = sample.increments;
            let angle = truth.angle + white(GYRO_NOISE);
            (
                sample.time,
                Increments { angle, velocity: truth.velocity + white(ACCEL_NOISE), ..truth },
            )
        })
        .unzip();
    Recording { times, increments, ..Recording::default() }
}

/// The same with the table angle, with white noise \[rad\].
fn with_encoder(recording: Recording, motion: &TrueMotion, noise: f64) -> Recording {
    let mut rng = Pcg64::seed_from_u64(77);
    let read = |time: &f64| {
        let one: f64 = StandardNormal.sample(&mut rng);
        motion.profile.angle(*time) + noise * one
    };
    let table_angle = Some(recording.times.iter().map(read).collect());
    Recording { table_angle, ..recording }
}

/// Checks that the spans are the two static intervals, to a second at each end.
fn assert_two_dwells(spans: &[Range<usize>]) {
    let wanted = [0..60 * SECOND, 120 * SECOND..180 * SECOND];
    assert_eq!(spans.len(), 2, "{spans:?}");
    for (got, want) in spans.iter().zip(wanted) {
        assert!(got.start.abs_diff(want.start) <= 2 * SECOND, "{got:?} for {want:?}");
        assert!(got.end.abs_diff(want.end) <= SECOND, "{got:?} for {want:?}");
    }
}

#[test]
fn dwells_are_found_by_the_table() {
    for noise in [0.1 * ARCSEC, 2.0 * ARCSEC] {
        let motion = dwell_turn_dwell(10.0 * DEG_PER_SECOND);
        let recording = with_encoder(recorded(&motion, 1.0, 1), &motion, noise);
        assert_two_dwells(&rest_spans(&recording, 30.0));
    }
}

#[test]
fn slow_turn_that_only_the_table_knows_is_no_rest() {
    // The IMU alone cannot distinguish a hundredth of a degree per second from a gyro bias.
    let motion = dwell_turn_dwell(0.01 * DEG_PER_SECOND);
    let recording = with_encoder(recorded(&motion, 1.0, 2), &motion, ARCSEC);
    assert_two_dwells(&rest_spans(&recording, 30.0));
    let by_rate = Recording {
        table_rate: Some(recording.times.iter().map(|t| motion.profile.rate(*t - 0.01)).collect()),
        table_angle: None,
        ..recording
    };
    assert_two_dwells(&rest_spans(&by_rate, 30.0));
}

#[test]
fn dwells_are_found_without_a_table() {
    for rate in [10.0, -40.0] {
        let motion = dwell_turn_dwell(rate * DEG_PER_SECOND);
        assert_two_dwells(&rest_spans(&recorded(&motion, 1.0, 3), 30.0));
    }
}

#[test]
fn perfect_log_has_its_dwells_too() {
    let motion = dwell_turn_dwell(10.0 * DEG_PER_SECOND);
    assert_two_dwells(&rest_spans(&recorded(&motion, 0.0, 4), 30.0));
}

#[test]
fn knock_that_leaves_the_imu_elsewhere_ends_a_rest() {
    let motion = dwell_turn_dwell(10.0 * DEG_PER_SECOND);
    let knocked = |tilt: f64| {
        let mut recording = recorded(&motion, 1.0, 5);
        for sample in &mut recording.increments[1500..1510] {
            sample.angle += InFrame::new(tilt / 10.0, 0.0, 0.0);
            sample.velocity += InFrame::new(0.01, -0.01, 0.0);
        }
        recording
    };
    let apart = [0..1500, 1510..3000];
    assert_eq!(rest_spans(&knocked(1.0 * DEG), 10.0)[..2], apart);
    // A footstep beside the table does not, with or without a measured table angle; it is reported.
    assert_eq!(rest_spans(&knocked(0.0), 10.0)[0], 0..3000);
    let watched = with_encoder(knocked(0.0), &motion, ARCSEC);
    assert_eq!(rest_spans(&watched, 10.0)[0], 0..3000);
    for recording in [knocked(0.0), watched] {
        let found = StaticIntervals::of(&recording, &StaticOptions::default());
        let knock = apart[0].end..apart[1].start;
        assert_eq!(found.all[0].disturbances, vec![knock]);
    }
}

#[test]
fn shorter_rests_are_left_out() {
    let motion = dwell_turn_dwell(10.0 * DEG_PER_SECOND);
    let recording = recorded(&motion, 1.0, 6);
    assert!(rest_spans(&recording, 61.0).is_empty());
    assert!(rest_spans(&Recording::default(), 1.0).is_empty());
}

#[test]
fn turning_table_is_never_at_rest() {
    let turn = Segment { rate: 10.0 * DEG_PER_SECOND, duration: 60.0 };
    let motion =
        TrueMotion { profile: Profile::new(&[turn], None).unwrap(), ..dwell_turn_dwell(0.1) };
    let recording = recorded(&motion, 1.0, 7);
    assert!(rest_spans(&recording, 2.0).is_empty());
    assert!(rest_spans(&with_encoder(recording, &motion, ARCSEC), 2.0).is_empty());
}

/// Over many static intervals, the means scatter as white noise does, `density / √duration`, and the sigma of each agrees
/// with that on average.
#[test]
fn sigma_of_a_mean_is_that_of_white_noise() {
    const DWELLS: u32 = 300;
    let standing = TrueMotion {
        profile: Profile::new(&[Segment { rate: 0.0, duration: 40.0 }], None).unwrap(),
        ..dwell_turn_dwell(1.0)
    };
    let truth = standing.increments(0.0, 40.0).rates();
    let (mut gyro_square, mut gyro_shown, mut accel_square, mut accel_shown) = (0.0, 0.0, 0.0, 0.0);
    for dwell in 0..DWELLS {
        let recording = recorded(&standing, 1.0, u64::from(dwell));
        let mean = RestMean::of(&recording, 0..recording.len()).unwrap();
        assert_close!(mean.duration, 40.0, 1e-9);
        gyro_square += (mean.rates.angular_rate - truth.angular_rate).components().norm_squared();
        accel_square +=
            (mean.rates.specific_force - truth.specific_force).components().norm_squared();
        gyro_shown += mean.angular_rate_sigma.norm_squared();
        accel_shown += mean.specific_force_sigma.norm_squared();
    }
    // Four sigma of a mean of n squares is 4 √(2 / n); one of 20 batches has 19 of them.
    let means = f64::from(3 * DWELLS);
    for (square, shown, density) in
        [(gyro_square, gyro_shown, GYRO_NOISE), (accel_square, accel_shown, ACCEL_NOISE)]
    {
        let theory = density * density / 40.0;
        assert_close!(square / means / theory, 1.0, 4.0 * (2.0 / means).sqrt());
        assert_close!(shown / means / theory, 1.0, 4.0 * (2.0 / (19.0 * means)).sqrt());
    }
}

#[test]
fn mean_needs_two_samples_of_the_recording() {
    let recording = recorded(&dwell_turn_dwell(1.0), 1.0, 8);
    assert_eq!(RestMean::of(&recording, 5..5), None);
    assert_eq!(RestMean::of(&recording, 5..6), None);
    assert_eq!(RestMean::of(&recording, 8000..9001), None);
    assert!(RestMean::of(&recording, 5..7).is_some());
}
