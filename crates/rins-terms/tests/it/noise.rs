//! Noise that terms make of a data sheet's.

use rins_imu::{ImuNoise, NoiseModel, Quantisation};
use rins_terms::{Model, Noises, TermInstance, catalogue};
use rins_testing::assert_close;

fn sheet() -> Noises {
    let gyro = NoiseModel { flicker: Some(3.0), bias_random_walk: 0.4, ..NoiseModel::white(2.0) };
    Noises { imu: ImuNoise { gyro, accel: NoiseModel::white(5.0) }, encoder: 1.0 }
}

#[test]
fn densities_add_and_levels_multiply() {
    let model = Model::default()
        .with(TermInstance::new(&catalogue::GYRO_NOISE_LEVEL).with_values(&[0.5]))
        .with(TermInstance::new(&catalogue::ACCEL_NOISE_LEVEL).with_values(&[-0.5]))
        .with(TermInstance::new(&catalogue::GYRO_BIAS_INSTABILITY).with_values(&[4.0]))
        .with(TermInstance::new(&catalogue::ACCEL_BIAS_INSTABILITY).with_values(&[7.0]))
        .with(TermInstance::new(&catalogue::GYRO_RATE_RANDOM_WALK).with_values(&[0.3]));
    let noises = model.stirred(sheet());
    assert_close!(noises.imu.gyro.white_density, 3.0, 1e-12);
    assert_close!(noises.imu.accel.white_density, 2.5, 1e-12);
    assert_close!(noises.imu.gyro.flicker.unwrap(), 5.0, 1e-12);
    assert_close!(noises.imu.accel.flicker.unwrap(), 7.0, 1e-12);
    assert_close!(noises.imu.gyro.bias_random_walk, 0.5, 1e-12);
    assert_close!(noises.encoder, 1.0, 1e-12);
}

#[test]
fn least_bit_is_of_increments_where_both_are_given() {
    let bit = |values: &[f64]| {
        let model = Model::default()
            .with(TermInstance::new(&catalogue::GYRO_QUANTISATION).with_values(values));
        model.stirred(sheet()).imu.gyro.quantisation
    };
    assert_eq!(bit(&[1e-6, 1e-5]), Some(Quantisation::Increment(1e-6)));
    assert_eq!(bit(&[0.0, 1e-5]), Some(Quantisation::Rate(1e-5)));
    assert_eq!(bit(&[0.0, 0.0]), None);
}
