//! Every error of axes, units and columns in a rig file is identified with its correction.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rins_frames::units::{DEG, DEG_PER_HOUR, MICRO_G, STANDARD_GRAVITY};
use rins_frames::{EulerAngles, InFrame, Increments, SignedAxes};
use rins_inspection::{
    Correction, Expected, ExpectedAxis, ExpectedTriad, ReadingOf, ReadingUnit, Suspicion, inspect,
};
use rins_motion::Recording;
use rins_testing::assert_close;

use crate::axes::{corrections, read_as, undone};
use crate::run::{CHIP, INTERVAL, NAVIGATION, assert_unsuspected, expected, profile};
use crate::run::{record, record_tilted, usual};

/// All orders and signs of three axes except the correct one.
fn mistakes() -> Vec<SignedAxes> {
    let orders = [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]];
    let signs =
        |bits: u8| std::array::from_fn(|axis| if bits >> axis & 1 == 1 { -1.0 } else { 1.0 });
    let all = orders.into_iter().flat_map(|source| (0..8).map(move |bits| (source, signs(bits))));
    let all = all.map(|(source, sign)| SignedAxes { source, sign });
    all.filter(|axes| *axes != SignedAxes::IDENTITY).collect()
}

/// Fails unless each of the 141 errors is identified, with at most this number of alternatives.
fn assert_all_named(recording: &Recording, most: usize) {
    let right = SignedAxes::IDENTITY;
    assert_eq!(mistakes().len(), 47);
    for mistake in mistakes() {
        let undo = undone(mistake);
        for (gyro, accel, correction) in [
            (mistake, right, Correction::Gyro(undo)),
            (right, mistake, Correction::Accel(undo)),
            (mistake, mistake, Correction::Imu(undo)),
        ] {
            let wrong = read_as(recording, gyro, accel);
            let told = corrections(&wrong, &expected(NAVIGATION));
            assert!(told.contains(&correction), "{correction:?} is not among {told:?}");
            assert!(told.len() <= most, "{correction:?} is one of {told:?}");
        }
    }
}

#[test]
fn every_order_and_sign_of_axes_is_named_with_its_correction() {
    assert_all_named(&record(usual(), NAVIGATION, 20), 1);
}

/// A table that rotates from the first sample to the last has the same information as a static one.
#[test]
fn every_order_and_sign_is_named_where_nothing_rests() {
    let steady = record(profile(&[(10.0, 130.0)]), NAVIGATION, 26);
    assert_all_named(&steady.slice(500, steady.len()), 1);
    let reversed = record(profile(&[(12.0, 65.0), (-12.0, 65.0)]), NAVIGATION, 27);
    assert_all_named(&reversed.slice(500, reversed.len()), 1);
}

/// The recording with its readings multiplied by factors.
fn scaled(recording: &Recording, gyro: f64, accel: f64, table: f64) -> Recording {
    let increments = recording.increments.iter().map(|sample| Increments {
        angle: sample.angle * gyro,
        velocity: sample.velocity * accel,
        ..*sample
    });
    let table_angle = recording.table_angle.as_ref();
    let table_angle = table_angle.map(|list| list.iter().map(|angle| angle * table).collect());
    Recording { increments: increments.collect(), table_angle, ..recording.clone() }
}

fn causes(recording: &Recording, expected: &Expected) -> Vec<String> {
    let cause = |suspicion: Suspicion| match suspicion {
        Suspicion::Gravity { cause, .. } | Suspicion::SpinScale { cause, .. } => cause,
        _ => None,
    };
    inspect(recording, expected).suspicions.into_iter().filter_map(cause).collect()
}

/// The contribution of one unit over an interval, in SI units.
fn over(unit: ReadingUnit) -> f64 {
    if unit.of == ReadingOf::Rate { unit.factor * INTERVAL } else { unit.factor }
}

/// Fails unless every confusion of two units of a list is identified, and nothing else; `wrong` multiplies the affected
/// readings by a factor.
fn assert_units_named(
    units: &[ReadingUnit],
    said: impl Fn(ReadingUnit) -> Expected,
    wrong: impl Fn(f64) -> Recording,
) {
    for &meant in units {
        for &unit in units.iter().filter(|unit| **unit != meant) {
            let told = causes(&wrong(over(unit) / over(meant)), &said(unit));
            let pair = format!("in {} were declared as {}", meant.symbol, unit.symbol);
            assert_eq!(told, [format!("readings {pair}")]);
        }
    }
}

#[test]
fn every_unit_taken_for_another_is_named() {
    let steady = record(profile(&[(10.0, 130.0)]), NAVIGATION, 28);
    for recording in [record(usual(), NAVIGATION, 21), steady.slice(500, steady.len())] {
        let known = expected(NAVIGATION);
        let gyro =
            |unit| Expected { gyro: ExpectedTriad { unit: Some(unit), ..known.gyro }, ..known };
        assert_units_named(&ReadingUnit::GYRO, gyro, |f| scaled(&recording, f, 1.0, 1.0));
        let accel =
            |unit| Expected { accel: ExpectedTriad { unit: Some(unit), ..known.accel }, ..known };
        assert_units_named(&ReadingUnit::ACCEL, accel, |f| scaled(&recording, 1.0, f, 1.0));
        let table = |unit| Expected {
            gyro: ExpectedTriad { unit: Some(ReadingUnit::GYRO[0]), ..known.gyro },
            table_unit: Some(unit),
            ..known
        };
        for (place, meant) in ReadingUnit::TABLE_ANGLE.into_iter().enumerate() {
            for said in ReadingUnit::TABLE_ANGLE.into_iter().skip(place + 1) {
                for (meant, said) in [(meant, said), (said, meant)] {
                    let wrong = scaled(&recording, 1.0, 1.0, said.factor / meant.factor);
                    let told = causes(&wrong, &table(said));
                    let pair =
                        format!("angle in {} were declared as {}", meant.symbol, said.symbol);
                    assert!(told.len() == 1 && told[0].contains(&pair), "{pair}: {told:?}");
                }
            }
        }
        let told = causes(&scaled(&recording, 1.0, 1.0, -1.0), &known);
        assert_eq!(
            told,
            ["the direction of rotation of the table is opposite to that of the gyro"]
        );
    }
}

/// Gyro and accelerometer columns are exchanged, each with the unit of the other.
#[test]
fn exchanged_triads_are_named_whatever_their_units() {
    let recording = record(usual(), NAVIGATION, 22);
    for (gyro_unit, accel_unit) in
        [(1.0, 1.0), (DEG, 1.0), (DEG_PER_HOUR, STANDARD_GRAVITY), (DEG, 1e3 * MICRO_G)]
    {
        let mut wrong = recording.clone();
        for sample in &mut wrong.increments {
            let (angle, velocity) = (*sample.angle.components(), *sample.velocity.components());
            sample.angle = InFrame::from_components(velocity / accel_unit * gyro_unit);
            sample.velocity = InFrame::from_components(angle / gyro_unit * accel_unit);
        }
        let found = inspect(&wrong, &expected(NAVIGATION)).suspicions;
        let named = |suspicion: &Suspicion| matches!(suspicion, Suspicion::Triads { gyro, accel } if *accel > 0.99 && *gyro < 0.3);
        assert!(found.iter().any(named), "{found:?}");
    }
}

/// The same if the table rotates at a constant rate, without correlations.
#[test]
fn exchanged_triads_are_named_at_one_rate() {
    let run = record(profile(&[(10.0, 130.0)]), NAVIGATION, 29);
    let mut wrong = run.slice(500, run.len());
    for sample in &mut wrong.increments {
        let (angle, velocity) = (*sample.angle.components(), *sample.velocity.components());
        sample.angle = InFrame::from_components(velocity);
        sample.velocity = InFrame::from_components(angle);
    }
    let found = inspect(&wrong, &expected(NAVIGATION)).suspicions;
    let [Suspicion::TurningTriads { gyro, accel }] = found[..] else { panic!("{found:?}") };
    assert!(gyro > 0.3 && accel < 0.01, "{gyro} {accel}");
}

/// A hundred correct runs, in random attitudes and at random sites, without any suspicion.
#[test]
fn a_hundred_good_runs_are_not_suspected() {
    let mut rng = Pcg64::seed_from_u64(23);
    for seed in 0..100 {
        let mut angle = |most: f64| rng.random_range(-most..most) * DEG;
        let angles = EulerAngles { roll: angle(60.0), pitch: angle(60.0), yaw: angle(180.0) };
        let rate = angle(20.0) / DEG;
        let rate = rate + 3.0_f64.copysign(rate);
        let grade = if seed % 4 == 3 { CHIP } else { NAVIGATION };
        let turns = profile(&[(0.0, 40.0), (rate, 40.0), (-1.5 * rate, 30.0), (0.0, 10.0)]);
        let recording = record_tilted(angles.dcm(), turns, grade, 1000 + seed);
        let axis = Some(ExpectedAxis { angles, sigma: 0.1 * DEG });
        assert_unsuspected(&recording, &Expected { axis, ..expected(grade) });
    }
}

#[test]
fn a_late_table_is_seen_by_so_much() {
    let recording = record(usual(), NAVIGATION, 24);
    let on_time = inspect(&recording, &expected(NAVIGATION)).table_lag.unwrap();
    assert!(on_time.latency.abs() < 20e-6 && on_time.sigma < 10e-6, "{on_time:?}");
    assert_close!(on_time.ratio, 1.0, 1e-6);
    // The angle at each time stamp is that of 1.5 ms before: 0.075 of an interval.
    let mut late = recording.clone();
    let angle = late.table_angle.as_mut().unwrap();
    for index in (1..angle.len()).rev() {
        angle[index] -= 0.0015 / INTERVAL * (angle[index] - angle[index - 1]);
    }
    let lag = inspect(&late, &expected(NAVIGATION)).table_lag.unwrap();
    assert_close!(lag.latency - on_time.latency, 0.0015, 10e-6);
    // For a table with a constant rate no latency is observable.
    let steady = record(profile(&[(10.0, 60.0)]), NAVIGATION, 25);
    let from = steady.slice(500, steady.len());
    assert_eq!(inspect(&from, &expected(NAVIGATION)).table_lag, None);
}
