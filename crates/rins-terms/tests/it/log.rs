//! Faults of a log, against what they say of themselves.

use rins_frames::units::{ARCSEC, DEG_PER_SECOND, MICRO_G};
use rins_imu::Seed;
use rins_motion::Recording;
use rins_terms::{Model, SettingKind, TermInstance, catalogue};
use rins_testing::assert_close;

use crate::support::{INTERVAL, run};

fn distorted(chosen: TermInstance) -> (Recording, Recording) {
    let before = run().recording.clone();
    let mut after = before.clone();
    Model::default().with(chosen).distort(Seed::new(7), &mut after);
    (before, after)
}

#[test]
fn stuck_samples_come_in_runs_and_are_as_many_as_said() {
    let stuck = TermInstance::new(&catalogue::STUCK_SAMPLES)
        .with_values(&[0.1])
        .with_setting(SettingKind::SampleCount, 4.0);
    // While the table rests samples repeat anyway: count where it turns.
    let (before, after) = distorted(stuck);
    let turning: Vec<usize> =
        (1..before.len()).filter(|&k| before.increments[k] != before.increments[k - 1]).collect();
    let repeated = |k: &&usize| after.increments[**k] == after.increments[**k - 1];
    let share = turning.iter().filter(repeated).count() as f64 / turning.len() as f64;
    // A run of four comes 2.5 times in a hundred: 4σ of its share over 5000 samples, and a tenth
    // less for those that would start within another.
    assert_close!(share, 0.1, 0.035);
}

#[test]
fn outliers_are_as_many_and_as_large_as_said() {
    let sigma = 1e-3;
    let outliers = TermInstance::new(&catalogue::OUTLIERS).with_values(&[0.01, 0.0, sigma]);
    let (before, after) = distorted(outliers);
    let spikes: Vec<f64> = before
        .increments
        .iter()
        .zip(&after.increments)
        .flat_map(|(before, after)| {
            assert_eq!(before.angle, after.angle);
            let spike = (after.velocity - before.velocity) * (1.0 / INTERVAL);
            spike.components().iter().copied().collect::<Vec<_>>()
        })
        .filter(|spike| *spike != 0.0)
        .collect();
    let expected = 0.01 * 3.0 * before.len() as f64;
    assert_close!(spikes.len() as f64, expected, 4.0 * expected.sqrt());
    let squares = spikes.iter().map(|spike| spike * spike).sum::<f64>() / spikes.len() as f64;
    assert_close!(squares / (sigma * sigma), 1.0, 4.0 * (2.0 / spikes.len() as f64).sqrt());
}

#[test]
fn jitter_scatters_the_angle_by_the_rate() {
    let sigma = 1e-3;
    let jitter = TermInstance::new(&catalogue::TIMESTAMP_JITTER).with_values(&[sigma]);
    let (before, after) = distorted(jitter);
    let rates = before.table_rate.unwrap();
    let (was, is) = (before.table_angle.unwrap(), after.table_angle.unwrap());
    let scatter = |rate: f64| {
        let errors: Vec<f64> = (0..rates.len())
            .filter(|&k| (rates[k] - rate * DEG_PER_SECOND).abs() < 1e-9)
            .map(|k| is[k] - was[k])
            .collect();
        assert!(errors.len() > 500);
        (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
    };
    // 800 samples and more: 4σ is a tenth.
    assert_close!(scatter(20.0) / (20.0 * DEG_PER_SECOND * sigma), 1.0, 0.1);
    assert_close!(scatter(-5.0) / (5.0 * DEG_PER_SECOND * sigma), 1.0, 0.1);
    assert!(scatter(0.0) < 0.1 * ARCSEC);
}

#[test]
fn readings_end_at_the_range() {
    let clipped =
        TermInstance::new(&catalogue::GYRO_SATURATION).with_values(&[12.0 * DEG_PER_SECOND]);
    let (before, after) = distorted(clipped);
    let rates = |recording: &Recording| -> Vec<f64> {
        recording.increments.iter().map(|i| i.rates().angular_rate.components().z).collect()
    };
    for (was, is) in rates(&before).into_iter().zip(rates(&after)) {
        assert_close!(is, was.min(12.0 * DEG_PER_SECOND), 1e-15);
    }
    let clipped = TermInstance::new(&catalogue::ACCEL_SATURATION).with_values(&[5.0]);
    let (_, after) = distorted(clipped);
    let force = |k: usize| *after.increments[k].rates().specific_force.components();
    let largest = (0..after.len()).map(|k| force(k).amax()).fold(0.0, f64::max);
    assert_close!(largest, 5.0, 1e-3 * MICRO_G);
}

#[test]
fn axes_and_senses_are_exchanged() {
    let axes = TermInstance::new(&catalogue::AXIS_CONVENTION)
        .with_setting(SettingKind::Triads, 1.0)
        .with_values(&[-2.0, 1.0, 0.0]);
    let (before, after) = distorted(axes);
    for (was, is) in before.increments.iter().zip(&after.increments) {
        let (was_angle, is_angle) = (was.angle.components(), is.angle.components());
        assert_eq!([is_angle.x, is_angle.y, is_angle.z], [-was_angle.y, was_angle.x, was_angle.z]);
        assert_eq!(was.velocity, is.velocity);
    }
    let (before, after) = distorted(TermInstance::new(&catalogue::TABLE_SENSE).with_values(&[1.0]));
    let (was, is) = (before.table_angle.unwrap(), after.table_angle.unwrap());
    assert!(was.iter().zip(&is).all(|(was, is)| (was + is).abs() < 1e-15));
    assert!(is.iter().any(|angle| *angle < -1.0));
}

#[test]
fn two_items_of_one_fault_have_random_numbers_of_their_own() {
    let one = TermInstance::new(&catalogue::TIMESTAMP_JITTER).with_values(&[1e-3]);
    let (was, single) = distorted(one.clone());
    let mut twice = was.clone();
    Model::default().with(one.clone()).with(one).distort(Seed::new(7), &mut twice);
    let angle = |recording: &Recording, k: usize| recording.table_angle.as_ref().unwrap()[k];
    let k = 2000;
    let first = angle(&single, k) - angle(&was, k);
    let second = angle(&twice, k) - angle(&single, k);
    assert!(first != 0.0 && (first - second).abs() > 1e-3 * first.abs());
}
