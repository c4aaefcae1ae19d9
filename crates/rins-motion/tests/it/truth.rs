//! The increments of a perfect IMU, compared with a Runge-Kutta integration of its rates.

use nalgebra::{Rotation3, SVector, Vector3};
use proptest::prelude::*;
use rins_frames::units::DEG_PER_SECOND;
use rins_frames::{EARTH_RATE, Increments};
use rins_motion::{Profile, Segment, TrueMotion};
use rins_testing::{any_latitude, assert_close};

use crate::support::{any_attitude, station};

/// The angular acceleration of the table in these profiles \[rad/s²\].
const ACCELERATION: f64 = 0.1;

/// Over 90 s with steps of 5 ms the rounding error of the table angle in the Runge-Kutta method is about 1e-11 rad, and its
/// effect on the integral of gravity is a thousand times as large \[m/s\].
const RUNGE_KUTTA: f64 = 1e-8;

/// The rounding of sums of some thousand m/s.
const ROUNDING: f64 = 2e-10;

/// Rates that reverse, each longer than its ramp.
fn any_segments() -> impl Strategy<Value = Vec<Segment>> {
    let segment = (-1.0..1.0_f64, 21.0..30.0_f64);
    prop::collection::vec(segment.prop_map(|(rate, duration)| Segment { rate, duration }), 2..4)
}

fn motion(
    latitude: f64,
    attitude: rins_frames::Dcm<rins_frames::Nav, rins_frames::Table>,
    segments: &[Segment],
) -> TrueMotion {
    let profile = Profile::new(segments, Some(ACCELERATION)).unwrap();
    TrueMotion { station: station(latitude), nav_from_table: attitude, profile }
}

/// The table's rate as a polygon of time and rate, from the segments themselves.
fn polygon(segments: &[Segment]) -> Vec<(f64, f64)> {
    let mut corners = vec![(0.0, 0.0)];
    let (mut start, mut rate) = (0.0, 0.0);
    for segment in segments {
        corners.push((start + (segment.rate - rate).abs() / ACCELERATION, segment.rate));
        start += segment.duration;
        rate = segment.rate;
        corners.push((start, rate));
    }
    corners
}

/// Table angle, `∫ω_ib^b` and `∫f^b`.
type Integrals = SVector<f64, 7>;

/// The integrals from 0 to `end`, a Runge-Kutta run through each side of the polygon.
fn integrated(motion: &TrueMotion, corners: &[(f64, f64)], end: f64) -> Integrals {
    let latitude = motion.station.site.latitude;
    let s_from_n = motion.nav_from_table.matrix().transpose();
    let w_ie = s_from_n * Vector3::new(0.0, latitude.cos(), latitude.sin()) * EARTH_RATE;
    let f = s_from_n * Vector3::new(0.0, 0.0, motion.station.gravity);
    let slope = |state: &Integrals, rate: f64| {
        let b_from_s = Rotation3::from_axis_angle(&Vector3::z_axis(), -state[0]);
        let (w, f) = (b_from_s * w_ie + Vector3::z() * rate, b_from_s * f);
        Integrals::from([rate, w.x, w.y, w.z, f.x, f.y, f.z])
    };
    let mut state = Integrals::zeros();
    for side in corners.windows(2) {
        let ((begin, first), (finish, last)) = (side[0], side[1]);
        let length = finish.min(end) - begin;
        if length <= 0.0 {
            continue;
        }
        let acceleration = (last - first) / (finish - begin);
        let steps = (length / 5e-3).ceil();
        let h = length / steps;
        let mut step = 0.0;
        while step < steps {
            let rate = |part: f64| first + acceleration * (step + part) * h;
            let k1 = slope(&state, rate(0.0));
            let k2 = slope(&(state + k1 * (0.5 * h)), rate(0.5));
            let k3 = slope(&(state + k2 * (0.5 * h)), rate(0.5));
            let k4 = slope(&(state + k3 * h), rate(1.0));
            state += (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0);
            step += 1.0;
        }
    }
    state
}

fn stacked(increments: &Increments) -> SVector<f64, 6> {
    let (angle, velocity) = (increments.angle.components(), increments.velocity.components());
    SVector::from([angle.x, angle.y, angle.z, velocity.x, velocity.y, velocity.z])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn increments_are_the_integrals_of_the_rates(
        latitude in any_latitude(),
        attitude in any_attitude(),
        segments in any_segments(),
        parts in [0.0..1.0_f64, 0.0..1.0_f64],
    ) {
        let motion = motion(latitude, attitude, &segments);
        let corners = polygon(&segments);
        let from = parts[0].min(parts[1]) * motion.profile.duration();
        let to = parts[0].max(parts[1]) * motion.profile.duration();
        let (begin, end) = (integrated(&motion, &corners, from), integrated(&motion, &corners, to));
        prop_assert!((motion.profile.angle(to) - end[0]).abs() < RUNGE_KUTTA);
        let off = stacked(&motion.increments(from, to)) - (end - begin).fixed_rows::<6>(1);
        prop_assert!(off.norm() < RUNGE_KUTTA, "off by {off}");
    }

    #[test]
    fn increments_of_neighbouring_intervals_add(
        latitude in any_latitude(),
        attitude in any_attitude(),
        segments in any_segments(),
        mut times in [0.0..80.0_f64, 0.0..80.0_f64, 0.0..80.0_f64],
    ) {
        times.sort_by(f64::total_cmp);
        let [a, b, c] = times;
        let motion = motion(latitude, attitude, &segments);
        let sum = stacked(&motion.increments(a, b)) + stacked(&motion.increments(b, c));
        let off = (sum - stacked(&motion.increments(a, c))).norm();
        prop_assert!(off < ROUNDING, "off by {off:e}");
    }

    #[test]
    fn samples_add_up_to_the_run(
        attitude in any_attitude(),
        segments in any_segments(),
    ) {
        let motion = motion(0.6, attitude, &segments);
        let samples: Vec<_> = motion.samples(0.02).collect();
        let end = samples.last().unwrap().time;
        prop_assert!(end > motion.profile.duration() - 0.02);
        let sum: SVector<f64, 6> = samples.iter().map(|s| stacked(&s.increments)).sum();
        let off = (sum - stacked(&motion.increments(0.0, end))).norm();
        prop_assert!(off < ROUNDING, "off by {off:e}");
        let turned: f64 = samples.iter().map(|sample| sample.mean_rate * 0.02).sum();
        prop_assert!((turned - motion.profile.angle(end)).abs() < ROUNDING);
    }

    #[test]
    fn gravity_averages_out_across_the_spin_over_whole_turns(
        attitude in any_attitude(),
        rate in 0.1..1.0_f64,
        turns in 1..5_u8,
    ) {
        let duration = f64::from(turns) * std::f64::consts::TAU / rate;
        let profile = Profile::new(&[Segment { rate, duration }], None).unwrap();
        let motion = TrueMotion { station: station(0.6), nav_from_table: attitude, profile };
        let gain = motion.increments(0.0, duration).velocity;
        let along = attitude.matrix()[(2, 2)] * motion.station.gravity * duration;
        prop_assert!(gain.components().xy().norm() < 1e-10);
        prop_assert!((gain.components().z - along).abs() < 1e-10);
    }
}

#[test]
fn run_of_whole_intervals_keeps_its_last_one() {
    let turn = Segment { rate: 10.0 * DEG_PER_SECOND, duration: 360.0 };
    let motion = TrueMotion {
        station: station(0.6),
        nav_from_table: rins_frames::Dcm::identity(),
        profile: Profile::new(&[turn], None).unwrap(),
    };
    assert_eq!(motion.samples(0.02).count(), 18_000);
    assert_eq!(motion.samples(0.01).count(), 36_000);
    assert_eq!(motion.samples(7.0).count(), 51);
    assert_close!(motion.samples(0.02).last().unwrap().time, 360.0, 1e-10);
}

#[test]
fn interval_that_is_not_longer_than_zero_gives_no_samples() {
    let turn = Segment { rate: 1.0, duration: 1.0 };
    let motion = TrueMotion {
        station: station(0.6),
        nav_from_table: rins_frames::Dcm::identity(),
        profile: Profile::new(&[turn], None).unwrap(),
    };
    for interval in [0.0, -0.01, f64::NAN] {
        assert_eq!(motion.samples(interval).count(), 0);
    }
}
