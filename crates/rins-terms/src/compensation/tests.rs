//! What is made and undone is the truth.

use super::*;
use crate::catalogue;
use crate::measurement_model::MeasurementModel;
use crate::model::TermInstance;
use crate::setting::SettingKind;
use crate::term::Term;
use proptest::prelude::*;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{EulerAngles, Site};
use rins_imu::{ImuError, ImuSpec, TriadError, TriadSpec};
use rins_motion::{Profile, Segment, Station, TrueMotion};

/// A tilted table that rests, turns forth with a ramp, and back.
fn motion() -> TrueMotion {
    let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
    let attitude = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    let segments =
        [0.0, 10.0, -20.0].map(|rate| Segment { rate: rate * DEG_PER_SECOND, duration: 12.0 });
    TrueMotion {
        station: Station::with_normal_gravity(site),
        nav_from_table: attitude.dcm(),
        profile: Profile::new(&segments, Some(5.0 * DEG_PER_SECOND)).unwrap(),
    }
}

/// A data sheet of fibre gyros.
fn sheet() -> ImuSpec {
    let triad = |noise_density, bias_sigma| {
        TriadSpec::white(noise_density, bias_sigma, 500.0 * PPM, 120.0 * ARCSEC)
    };
    ImuSpec {
        gyro: triad(0.02 * DEG_PER_HOUR, 0.1 * DEG_PER_HOUR),
        accel: triad(30.0 * MICRO_G, 200.0 * MICRO_G),
    }
}

/// What happens on the table, and what is read there: with an encoder, or without.
fn run(model: &Model, encoder: bool) -> (Surroundings, Recording, Recording) {
    let motion = motion();
    let around = Surroundings::new(motion.station, motion.nav_from_table);
    let samples: Vec<_> = motion.samples(0.02).collect();
    let times: Vec<f64> = samples.iter().map(|sample| sample.time).collect();
    let angles = std::iter::once(0.0).chain(samples.iter().map(|sample| sample.angle));
    let temperature: Vec<f64> = times.iter().map(|time| 20.0 + 0.01 * time).collect();
    let track = Track::new(
        around,
        times.clone(),
        vec![0.02; times.len()],
        angles.collect(),
        Some(temperature.clone()),
    );
    let truth = Recording {
        times,
        increments: samples.iter().map(|sample| sample.increments).collect(),
        table_angle: encoder.then(|| samples.iter().map(|sample| sample.angle).collect()),
        temperature: Some(temperature),
        ..Recording::default()
    };
    let mut making = MeasurementModel::new(model, &track);
    let mut read = truth.clone();
    for (sample, moment) in track.moments().enumerate() {
        let reading = making.read(&moment, &truth.increments[sample]);
        read.increments[sample] = reading.increments;
        if let Some(angle) = &mut read.table_angle {
            angle[sample] += reading.angle_error;
        }
    }
    (around, truth, read)
}

/// Checks `found` against `truth`: 1e-12 of the largest signal.
fn assert_same(found: &Recording, truth: &Recording) {
    for (found, truth) in found.increments.iter().zip(&truth.increments) {
        let turn = 20.0 * DEG * 0.02;
        assert!((found.angle - truth.angle).norm() < 1e-12 * turn, "{found:?} {truth:?}");
        let push = 9.8 * 0.02;
        assert!((found.velocity - truth.velocity).norm() < 1e-12 * push, "{found:?} {truth:?}");
    }
    let angles = |recording: &Recording| recording.table_angle.clone().unwrap_or_default();
    for (found, truth) in angles(found).iter().zip(angles(truth)) {
        assert!((found - truth).abs() < 1e-12, "{found} {truth}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn what_was_made_is_undone(
        errors in prop::array::uniform24(-1e-2..1e-2_f64),
        zero in -1.0..1.0_f64,
        encoder in any::<bool>(),
    ) {
        let triad = |p: &[f64]| TriadError {
            bias: nalgebra::Vector3::from_column_slice(&p[..3]),
            matrix: nalgebra::Matrix3::from_column_slice(&p[3..]),
        };
        let error = ImuError { gyro: triad(&errors[..12]), accel: triad(&errors[12..]) };
        let model = Model::from(&error)
            .with(TermInstance::new(&catalogue::ENCODER_ZERO).with_values(&[zero]));
        let (around, truth, read) = run(&model, encoder);
        prop_assert!((read.increments[0].angle - truth.increments[0].angle).norm() > 1e-6);
        assert_same(&compensated(&model, around, &read).unwrap(), &truth);
    }
}

/// A term of the catalogue, each parameter as large as it is usual at most.
fn largest_usual(term: &'static Term) -> TermInstance {
    let values = term.parameters.iter().map(|parameter| parameter.range(&sheet()).1);
    // Steps come in the middle of the run.
    TermInstance::new(term)
        .with_values(&values.collect::<Vec<_>>())
        .with_setting(SettingKind::Time, 18.0)
}

/// Whether a term moves the table at any time of the run.
fn moves(chosen: &TermInstance) -> bool {
    let (around, truth, _) = run(&Model::default(), true);
    let track = turning(&truth, around, 0.0);
    track.moments().any(|moment| chosen.signals(&moment, None).tilt != Signals::default().tilt)
}

/// One after the other, and then all at once.
#[test]
fn every_error_of_the_catalogue_is_undone_and_every_motion_stays() {
    let mut all = Model::default();
    for term in catalogue::CATALOGUE.iter().filter(|term| term.is_signal()) {
        // Where it reads nothing there is nothing to undo: tested below.
        if term.id == "gyro_dead_zone" {
            continue;
        }
        let chosen = largest_usual(term);
        let model = Model { terms: vec![chosen.clone()] };
        let (around, truth, read) = run(&model, true);
        assert_ne!(read, truth, "{}", term.id);
        let found = compensated(&model, around, &read).unwrap();
        if moves(&chosen) {
            assert_same(&found, &read);
        } else {
            assert_same(&found, &truth);
            all.terms.push(chosen);
        }
    }
    assert!(all.terms.len() > 30);
    let (around, truth, read) = run(&all, true);
    assert_same(&compensated(&all, around, &read).unwrap(), &truth);
}

#[test]
fn a_rate_that_was_not_read_is_not_made_up() {
    let zone = largest_usual(catalogue::term("gyro_dead_zone").unwrap());
    let model = Model { terms: vec![zone] };
    let (around, _, read) = run(&model, true);
    let refusal = compensated(&model, around, &read).unwrap_err();
    assert!(matches!(refusal, NotUndone::Endless { .. }), "{refusal}");
}

/// An IMU on a tilting table feels the tilt, and goes on feeling it.
#[test]
fn true_motion_stays() {
    let scale = TermInstance::new(&catalogue::GYRO_SCALE).with_values(&[100.0 * PPM; 3]);
    let mounting = TermInstance::new(&catalogue::MOUNTING).with_values(&[100.0 * ARCSEC, 0.0]);
    let tilting = Model { terms: vec![mounting.clone()] };
    let (around, _, felt) = run(&tilting, true);
    let both = tilting.with(scale);
    let (_, _, read) = run(&both, true);
    let found = compensated(&both, around, &read).unwrap();
    assert_same(&found, &felt);
}

#[test]
fn what_cannot_be_undone_is_refused() {
    let refusal = |scale: [f64; 3]| {
        let chosen = TermInstance::new(&catalogue::GYRO_SCALE).with_values(&scale);
        let model = Model { terms: vec![chosen] };
        let (around, _, read) = run(&model, true);
        compensated(&model, around, &read).err()
    };
    assert_eq!(refusal([0.1, 0.0, 0.0]), None);
    assert!(matches!(refusal([0.0, -1.0, 0.0]), Some(NotUndone::Triads(_))));
    assert!(matches!(refusal([0.0, 1.5, 0.0]), Some(NotUndone::Endless { .. })));
}

#[test]
fn nothing_is_made_of_no_samples() {
    let motion = motion();
    let around = Surroundings::new(motion.station, motion.nav_from_table);
    let none = Recording::default();
    assert_eq!(compensated(&Model::full(), around, &none), Ok(none));
}
