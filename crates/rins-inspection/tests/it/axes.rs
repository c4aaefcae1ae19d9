//! Wrong axes, signs, attitudes and sites are detected, and identified if one error explains all deviations.

use nalgebra::Vector3;
use proptest::prelude::*;
use rins_frames::units::DEG;
use rins_frames::{Body, EulerAngles, InFrame, Increments, SignedAxes};
use rins_inspection::{Correction, Expected, ExpectedAxis, ExpectedTriad, Suspicion, inspect};
use rins_motion::Recording;
use rins_testing::assert_close;

use crate::run::{
    ANGLES, CHIP, NAVIGATION, PAPER_LATITUDE, assert_unsuspected, expected, record, station, usual,
};

/// The recording with the axes of its gyros and accelerometers declared differently.
pub(crate) fn read_as(recording: &Recording, gyro: SignedAxes, accel: SignedAxes) -> Recording {
    let along = |axes: SignedAxes, vector: InFrame<Body>| {
        InFrame::from_components(axes.apply(vector.components()))
    };
    let increments = recording
        .increments
        .iter()
        .map(|sample| Increments {
            angle: along(gyro, sample.angle),
            velocity: along(accel, sample.velocity),
            ..*sample
        })
        .collect();
    Recording { increments, ..recording.clone() }
}

fn axes(source: [usize; 3], sign: [f64; 3]) -> SignedAxes {
    SignedAxes { source, sign }
}

/// The axes that correct an error by `axes`.
pub(crate) fn undone(axes: SignedAxes) -> SignedAxes {
    let mut inverse = axes;
    for row in 0..3 {
        inverse.source[axes.source[row]] = row;
        inverse.sign[axes.source[row]] = axes.sign[row];
    }
    inverse
}

fn without_table(recording: Recording) -> Recording {
    Recording { table_angle: None, ..recording }
}

const RIGHT: SignedAxes = SignedAxes::IDENTITY;

/// The corrections of all suspicions about directions.
pub(crate) fn corrections(recording: &Recording, expected: &Expected) -> Vec<Correction> {
    let inspection = inspect(recording, expected);
    let mut told = inspection.suspicions.iter().filter(|suspicion| {
        matches!(
            suspicion,
            Suspicion::Level { .. }
                | Suspicion::EarthRate { .. }
                | Suspicion::Latitude { .. }
                | Suspicion::Handedness { .. }
        )
    });
    let first = told.next().expect("a suspicion").corrections().to_vec();
    assert!(told.all(|suspicion| suspicion.corrections() == first));
    first
}

#[test]
fn right_runs_are_not_suspected() {
    for (grade, seed, visible) in [(NAVIGATION, 1, true), (NAVIGATION, 2, true), (CHIP, 3, false)] {
        let recording = record(usual(), grade, seed);
        let inspection = assert_unsuspected(&recording, &expected(grade));
        assert_eq!(inspection.earth_rate_visible, visible);
        assert_unsuspected(&recording, &Expected { axis: None, ..expected(grade) });
        assert_unsuspected(&without_table(recording), &expected(grade));
    }
    // Without a data sheet a bias of one degree per hour is not a wrong axis.
    let station = Some(station(PAPER_LATITUDE));
    let known_little = Expected { station, ..Expected::default() };
    let biased = crate::run::Grade { gyro_bias: 0.7 / 3600.0 * DEG, ..NAVIGATION };
    assert_unsuspected(&record(usual(), biased, 4), &known_little);
}

#[test]
fn commonest_mistakes_of_axes_are_named() {
    let recording = record(usual(), NAVIGATION, 5);
    let exchanged = axes([1, 0, 2], [1.0; 3]);
    let half_turn = axes([0, 1, 2], [-1.0, -1.0, 1.0]);
    let gravity = axes([0, 1, 2], [-1.0; 3]);
    for (gyro, accel, correction) in [
        (exchanged, RIGHT, Correction::Gyro(exchanged)),
        (RIGHT, exchanged, Correction::Accel(exchanged)),
        (half_turn, RIGHT, Correction::Gyro(half_turn)),
        (RIGHT, gravity, Correction::Accel(gravity)),
        (exchanged, exchanged, Correction::Imu(exchanged)),
        (half_turn, half_turn, Correction::Imu(half_turn)),
    ] {
        let wrong = read_as(&recording, gyro, accel);
        assert_eq!(corrections(&wrong, &expected(NAVIGATION)), [correction]);
    }
}

#[test]
fn wrong_attitude_and_place_are_named() {
    let recording = record(usual(), NAVIGATION, 6);
    let right = expected(NAVIGATION);
    let with = |angles: EulerAngles| Expected {
        axis: Some(ExpectedAxis { angles, sigma: 0.1 * DEG }),
        ..right
    };
    let (roll, pitch, yaw) = (ANGLES.roll, ANGLES.pitch, ANGLES.yaw);
    for (wrong, correction) in [
        (with(EulerAngles { roll: pitch, pitch: roll, ..ANGLES }), Correction::RollAndPitch),
        (with(EulerAngles { roll: -roll, ..ANGLES }), Correction::RollSign),
        (with(EulerAngles { pitch: -pitch, ..ANGLES }), Correction::PitchSign),
        (with(EulerAngles { yaw: -yaw, ..ANGLES }), Correction::YawSign),
        (Expected { station: Some(station(-PAPER_LATITUDE)), ..right }, Correction::LatitudeSign),
    ] {
        assert!(corrections(&recording, &wrong).contains(&correction), "{correction:?}");
    }
    // A wrong yaw that is no error of a sign is detected too, without a correction.
    assert_eq!(corrections(&recording, &with(EulerAngles { yaw: 1.2, ..ANGLES })), []);
    // Half a degree is within the attitude's sigma, five degrees are not.
    let off = |angle: f64| with(EulerAngles { roll: roll + angle * DEG, ..ANGLES });
    assert_unsuspected(&recording, &off(0.5));
    assert_eq!(corrections(&recording, &off(5.0)), []);
}

#[test]
fn two_mistakes_of_sense_that_hide_each_other_are_found() {
    let recording = record(usual(), NAVIGATION, 7);
    let flipped = axes([0, 1, 2], [1.0, 1.0, -1.0]);
    let mut wrong = read_as(&recording, flipped, RIGHT);
    for angle in wrong.table_angle.iter_mut().flatten() {
        *angle = -*angle;
    }
    let told = corrections(&wrong, &expected(NAVIGATION));
    assert_eq!(told, [Correction::GyroAndTableSense(flipped)]);
}

#[test]
fn latitude_tells_when_the_attitude_is_not_known() {
    let recording = record(usual(), NAVIGATION, 8);
    let unknown = Expected { axis: None, ..expected(NAVIGATION) };
    let elsewhere = Expected { station: Some(station(50.0 * DEG)), ..unknown };
    let found = inspect(&recording, &elsewhere).suspicions;
    let [Suspicion::Latitude { seen, expected, corrections }] = &found[..] else {
        panic!("{found:?}");
    };
    assert_close!(*seen, PAPER_LATITUDE, 0.5 * DEG);
    assert_close!(*expected, 50.0 * DEG, 1e-12);
    assert_eq!(corrections[..], []);
    let south = Expected { station: Some(station(-PAPER_LATITUDE)), ..unknown };
    assert!(self::corrections(&recording, &south).contains(&Correction::LatitudeSign));
}

/// With a MEMS chip neither the Earth's rate nor a given attitude decides, but the rotation itself does.
#[test]
fn turning_tells_the_hand_without_table_and_attitude() {
    let recording = without_table(record(usual(), CHIP, 9));
    let unknown = Expected { station: Some(station(PAPER_LATITUDE)), ..Expected::default() };
    for accel in [axes([0, 1, 2], [-1.0, 1.0, 1.0]), axes([1, 0, 2], [1.0; 3])] {
        let wrong = read_as(&recording, RIGHT, accel);
        let found = inspect(&wrong, &unknown).suspicions;
        let [Suspicion::Handedness { ratio, correlation, corrections }] = &found[..] else {
            panic!("{found:?}");
        };
        assert!((ratio + 1.0).abs() < 0.05 && *correlation < -0.95, "{ratio} {correlation}");
        // Either sign of x or y, of either triad: all of them correct it.
        assert!(corrections.len() > 1 && corrections.contains(&Correction::Accel(undone(accel))));
    }
}

fn any_mistake() -> impl Strategy<Value = SignedAxes> {
    let orders = [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]];
    (prop::sample::select(orders.to_vec()), prop::array::uniform3(prop::bool::ANY))
        .prop_map(|(source, minus)| axes(source, minus.map(|minus| if minus { -1.0 } else { 1.0 })))
        .prop_filter("a mistake", |axes| *axes != RIGHT)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn any_mixture_of_one_triads_axes_is_suspected(mistake in any_mistake(), of_gyro in prop::bool::ANY) {
        let recording = record(usual(), NAVIGATION, 10);
        let (gyro, accel) = if of_gyro { (mistake, RIGHT) } else { (RIGHT, mistake) };
        let right = undone(mistake);
        let correction = if of_gyro { Correction::Gyro(right) } else { Correction::Accel(right) };
        let wrong = read_as(&recording, gyro, accel);
        prop_assert!(corrections(&wrong, &expected(NAVIGATION)).contains(&correction));
    }
}

#[test]
fn bias_larger_than_the_earths_rate_is_no_wrong_axis() {
    let recording = record(usual(), CHIP, 11);
    let optimistic = ExpectedTriad { bias_sigma: Some(1e-9), ..ExpectedTriad::default() };
    assert_unsuspected(&recording, &Expected { gyro: optimistic, ..expected(CHIP) });
}

#[test]
fn axes_apply_as_they_say() {
    let read = Vector3::new(1.0, 2.0, 3.0);
    assert_eq!(axes([1, 0, 2], [-1.0, 1.0, 1.0]).apply(&read), Vector3::new(-2.0, 1.0, 3.0));
}
