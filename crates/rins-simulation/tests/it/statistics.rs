//! Random errors have the specified statistics, and follow from the seed alone.

use rins_frames::units::{ARCSEC, DEG, MICRO_G};
use rins_imu::{ImuNoise, NoiseModel, Seed};
use rins_simulation::{Encoder, Scenario, TableRecord, simulate};
use rins_testing::assert_close;

use crate::{INTERVAL, perfect, realistic};

/// The mean and the variance.
fn moments(series: &[f64]) -> (f64, f64) {
    let mean = series.iter().sum::<f64>() / series.len() as f64;
    let squares = series.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
    (mean, squares / (series.len() - 1) as f64)
}

/// Asserts that `series` is white, with mean `mean` and standard deviation `sigma`, to five sigma.
fn assert_white(series: &[f64], mean: f64, sigma: f64) {
    let count = series.len() as f64;
    let (found, variance) = moments(series);
    assert_close!(found, mean, 5.0 * sigma / count.sqrt());
    assert_close!(variance, sigma * sigma, 5.0 * sigma * sigma * (2.0 / count).sqrt());
    let pairs = series.iter().zip(&series[1..]).map(|(a, b)| (a - mean) * (b - mean));
    assert_close!(pairs.sum::<f64>() / count / variance, 0.0, 5.0 / count.sqrt());
}

#[test]
fn imu_noise_has_its_density() {
    let (gyro, accel) = (1e-6, 30.0 * MICRO_G);
    let noise = ImuNoise { gyro: NoiseModel::white(gyro), accel: NoiseModel::white(accel) };
    let noisy = simulate(&Scenario { noise: Some(noise), ..perfect() }).unwrap().recording;
    let clean = simulate(&perfect()).unwrap().recording;
    for axis in 0..3 {
        let pairs = || noisy.increments.iter().zip(&clean.increments);
        let angles: Vec<f64> =
            pairs().map(|(a, b)| (a.angle - b.angle).components()[axis]).collect();
        assert_white(&angles, 0.0, gyro * INTERVAL.sqrt());
        let velocities: Vec<f64> =
            pairs().map(|(a, b)| (a.velocity - b.velocity).components()[axis]).collect();
        assert_white(&velocities, 0.0, accel * INTERVAL.sqrt());
    }
}

#[test]
fn encoder_reads_with_its_zero_noise_and_resolution() {
    let errors = |encoder| {
        let table = TableRecord::Angle(encoder);
        let run = simulate(&Scenario { table, ..perfect() }).unwrap();
        let readings = run.recording.table_angle.unwrap();
        // The part in motion: at standstill the rounding error is constant.
        readings
            .iter()
            .zip(&run.truth.table_angle)
            .map(|(a, b)| a - b)
            .skip(3000)
            .collect::<Vec<_>>()
    };
    let noise = 2.0 * ARCSEC;
    assert_white(&errors(Encoder { noise, zero: 3.0 * DEG, resolution: None }), 3.0 * DEG, noise);

    let bit = 7.3 * ARCSEC;
    let rounded = errors(Encoder { noise, zero: 0.0, resolution: Some(bit) });
    assert_white(&rounded, 0.0, (noise * noise + bit * bit / 12.0).sqrt());
}

#[test]
fn encoder_delivers_whole_bits() {
    let bit = 0.36 * ARCSEC;
    for angle in simulate(&realistic()).unwrap().recording.table_angle.unwrap() {
        let bits = angle / bit;
        assert!((bits - bits.round()).abs() < 1e-7, "{bits} bits");
    }
}

#[test]
fn same_seed_makes_the_same_run() {
    assert_eq!(simulate(&realistic()).unwrap(), simulate(&realistic()).unwrap());
}

#[test]
fn another_run_or_seed_makes_other_noise_of_the_same_motion() {
    let with = |seed| simulate(&Scenario { seed, ..realistic() }).unwrap();
    let first = with(Seed { seed: 1, run: 0 });
    for seed in [Seed { seed: 1, run: 1 }, Seed { seed: 2, run: 0 }] {
        let other = with(seed);
        assert_eq!(other.truth, first.truth);
        let pairs = first.recording.increments.iter().zip(&other.recording.increments);
        assert!(pairs.clone().all(|(a, b)| a.angle != b.angle && a.velocity != b.velocity));
        assert_ne!(first.recording.table_angle, other.recording.table_angle);
    }
}

#[test]
fn sensors_do_not_share_random_numbers() {
    let quiet_encoder = Scenario { table: TableRecord::Angle(Encoder::default()), ..realistic() };
    let (one, other) = (simulate(&realistic()).unwrap(), simulate(&quiet_encoder).unwrap());
    assert_eq!(one.recording.increments, other.recording.increments);

    let louder = realistic().noise.map(|noise| ImuNoise { gyro: NoiseModel::white(1.0), ..noise });
    let other = simulate(&Scenario { noise: louder, ..realistic() }).unwrap();
    assert_eq!(one.recording.table_angle, other.recording.table_angle);
    let velocities = |run: &rins_simulation::Simulated| {
        run.recording.increments.iter().map(|k| k.velocity).collect::<Vec<_>>()
    };
    assert_eq!(velocities(&one), velocities(&other));
}
