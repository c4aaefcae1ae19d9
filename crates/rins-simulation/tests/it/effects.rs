//! Effects in a run, compared with an equivalent description of the same run.

use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G};
use rins_frames::{Dcm, Increments, Table};
use rins_imu::{ImuError, ImuNoise, ImuSpec, NoiseModel, TriadSpec};
use rins_simulation::{Encoder, Scenario, TableRecord, Temperature, simulate};
use rins_terms::{Model, TermInstance, catalogue};
use rins_testing::assert_close;

use crate::{perfect, realistic};

/// 1e-15 of a rotation at 10 deg/s, and of gravity, over an interval of 0.02 s.
const ROUNDING: (f64, f64) = (4e-18, 4e-16);

fn assert_same(found: &[Increments], expected: &[Increments], (angle, velocity): (f64, f64)) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found.angle - expected.angle).norm() <= angle, "{found:?} {expected:?}");
        assert!((found.velocity - expected.velocity).norm() <= velocity, "{found:?} {expected:?}");
    }
}

/// With all errors large, standstill, ramps, and a rotation in each direction.
#[test]
fn the_terms_of_eq_1_are_eq_1() {
    let imu_error = realistic().imu_error;
    let as_terms = Scenario { effects: Model::from(&imu_error), ..perfect() };
    let as_errors = Scenario { imu_error, ..perfect() };
    let (terms, errors) = (simulate(&as_terms).unwrap(), simulate(&as_errors).unwrap());
    assert_same(&terms.recording.increments, &errors.recording.increments, ROUNDING);
    let clean = simulate(&perfect()).unwrap();
    assert_ne!(terms.recording.increments[5000], clean.recording.increments[5000]);
    assert_eq!(terms.truth.imu_error, ImuError::default());
    assert_eq!(terms.truth.effects.value("gyro.scale.z"), Some(300e-6));
}

/// Noise, resolution and the encoder's own errors are added from the same random numbers.
#[test]
fn an_effect_on_the_encoder_leaves_the_rest_alone() {
    let zero = TermInstance::new(&catalogue::ENCODER_ZERO).with_values(&[20.0 * ARCSEC]);
    let effects = Model { terms: vec![zero] };
    let with = simulate(&Scenario { effects, ..realistic() }).unwrap().recording;
    let TableRecord::Angle(encoder) = realistic().table else { panic!("an encoder") };
    let moved = Encoder { zero: encoder.zero + 20.0 * ARCSEC, ..encoder };
    let other = simulate(&Scenario { table: TableRecord::Angle(moved), ..realistic() }).unwrap();
    let angles = with.table_angle.unwrap().into_iter().zip(other.recording.table_angle.unwrap());
    // A sum in another order is sometimes rounded to the neighboring bit, of 0.36 arcsec.
    let off = angles.filter(|(a, b)| (a - b).abs() > 1e-12).count();
    assert!(off <= 1, "{off} readings");
    assert_same(&with.increments, &other.recording.increments, ROUNDING);
}

/// An axis that is tilted relative to the axis frame is equivalent to a table with another axis frame.
#[test]
fn a_tilted_axis_is_another_axis() {
    let tilt = [300.0 * ARCSEC, -200.0 * ARCSEC, 500.0 * ARCSEC];
    let tilted = TermInstance::new(&catalogue::AXIS_ATTITUDE).with_values(&tilt);
    let effects = Model { terms: vec![tilted] };
    let imu_error = realistic().imu_error;
    let with = simulate(&Scenario { effects, imu_error, ..perfect() }).unwrap();
    let turned = Dcm::<Table, Table>::from_rotation_vector(&tilt.into());
    let nav_from_table = perfect().nav_from_table * turned;
    let other = simulate(&Scenario { nav_from_table, imu_error, ..perfect() }).unwrap();
    // The tilt is evaluated at the middle of a sample: within 4e-6 of its effect, which is 5e-4 m/s and
    // 4e-9 rad per sample.
    assert_same(&with.recording.increments, &other.recording.increments, (2e-14, 2e-9));
    for sample in [0, 4000, 8999] {
        let (found, expected) = (with.truth.attitude(sample), other.truth.attitude(sample));
        let off = found.unwrap().inverse() * expected.unwrap();
        assert_close!(off.rotation_vector().norm(), 0.0, 1e-14);
    }
    let off = with.truth.initial_attitude().inverse() * other.truth.initial_attitude();
    assert_close!(off.rotation_vector().norm(), 0.0, 1e-14);
}

#[test]
fn a_body_that_is_mounted_askew_stands_askew() {
    let mounting = TermInstance::new(&catalogue::MOUNTING).with_values(&[0.01 * DEG, 0.0]);
    let run =
        simulate(&Scenario { effects: Model { terms: vec![mounting] }, ..perfect() }).unwrap();
    let straight = simulate(&perfect()).unwrap();
    for sample in [0, 4000, 8999] {
        // The rotation is about its own x axis, whatever the table angle.
        let found = run.truth.attitude(sample).unwrap();
        let off = straight.truth.attitude(sample).unwrap().inverse() * found;
        assert_close!(off.rotation_vector().x, 0.01 * DEG, 1e-12);
        assert_close!(off.rotation_vector().yz().norm(), 0.0, 1e-12);
    }
}

#[test]
fn temperature_is_recorded_as_it_goes() {
    let recorded = |temperature| {
        let scenario = Scenario { temperature: Some(temperature), ..perfect() };
        simulate(&scenario).unwrap().recording.temperature.unwrap()
    };
    let ramp = recorded(Temperature::Ramp { start: 20.0, rate: 0.01 });
    assert_close!(ramp[0], 20.0002, 1e-12);
    assert_close!(ramp[8999], 21.8, 1e-12);
    let sinus = recorded(Temperature::Sinus { start: 20.0, amplitude: 5.0, period: 120.0 });
    // At a quarter, a half and three quarters of its period after the start.
    for (time, expected) in [(30, 25.0), (60, 20.0), (90, 15.0)] {
        assert_close!(sinus[50 * time - 1], expected, 1e-12);
    }
    let warm_up = recorded(Temperature::WarmUp { start: 20.0, rise: 10.0, time_constant: 50.0 });
    // The remaining rise decreases by 1/e in each time constant.
    let left = |time: usize| 30.0 - warm_up[50 * time - 1];
    assert_close!(left(50) / left(100), std::f64::consts::E, 1e-12);
    assert_close!(left(50), 10.0 / std::f64::consts::E, 1e-12);
}

/// A data sheet of fiber-optic gyros, from which typical magnitudes follow.
fn sheet() -> ImuSpec {
    let triad = |noise_density, bias_sigma| {
        TriadSpec::white(noise_density, bias_sigma, 500e-6, 120.0 * ARCSEC)
    };
    ImuSpec {
        gyro: triad(0.02 * DEG_PER_HOUR, 0.1 * DEG_PER_HOUR),
        accel: triad(30.0 * MICRO_G, 200.0 * MICRO_G),
    }
}

#[test]
fn every_effect_of_the_catalogue_shows_in_a_run() {
    let warming = Temperature::WarmUp { start: 20.0, rise: 5.0, time_constant: 60.0 };
    let scenario = Scenario { temperature: Some(warming), ..realistic() };
    let without = simulate(&scenario).unwrap().recording;
    for term in catalogue::CATALOGUE {
        // No usable sensor saturates at 10 deg/s or at standstill: here it does.
        let saturates = term.id.ends_with("_saturation");
        let value = |parameter: &rins_terms::Parameter| {
            if saturates { 0.05 } else { parameter.range(&sheet()).1 }
        };
        let values: Vec<f64> = term.parameters.iter().map(value).collect();
        let chosen = TermInstance::new(term).with_values(&values);
        let effects = Model { terms: vec![chosen] };
        let with = simulate(&Scenario { effects, ..scenario.clone() }).unwrap();
        assert!(with.recording != without, "{} does nothing", term.id);
        let is_finite =
            |k: &Increments| k.angle.norm().is_finite() && k.velocity.norm().is_finite();
        assert!(with.recording.increments.iter().all(is_finite), "{}", term.id);
        assert_eq!(with.truth.effects.terms[0].term.id, term.id);
    }
}

#[test]
fn an_effect_on_the_noise_is_other_noise() {
    let louder =
        TermInstance::new(catalogue::term("gyro_noise_level").unwrap()).with_values(&[1.0]);
    let effects = Model { terms: vec![louder] };
    let quiet = Scenario {
        noise: Some(ImuNoise { gyro: NoiseModel::white(1e-6), ..ImuNoise::default() }),
        ..perfect()
    };
    let noise = Some(ImuNoise { gyro: NoiseModel::white(2e-6), ..ImuNoise::default() });
    let with = simulate(&Scenario { effects, ..quiet.clone() }).unwrap();
    let other = simulate(&Scenario { noise, ..quiet }).unwrap();
    assert_eq!(with.recording, other.recording);
}

#[test]
fn a_thermal_effect_needs_a_temperature() {
    let thermal = TermInstance::new(catalogue::term("gyro_thermal_bias").unwrap());
    let scenario = Scenario { effects: Model { terms: vec![thermal] }, ..perfect() };
    assert_eq!(
        simulate(&scenario).unwrap_err().to_string(),
        "the effect gyro_thermal_bias needs a temperature, which this run does not have"
    );
}
