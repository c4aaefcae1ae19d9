//! One effect, two, and none.

use std::sync::Arc;

use rins_diagnosis::{
    Diagnosis, Stratum, Structure, Unexplained, diagnose, false_alarms, limits, suppose,
};
use rins_estimation::{Fit, NoiseKnowledge, NoiseParameters, Run};
use rins_frames::InFrame;
use rins_frames::units::{ARCSEC, DEG_PER_HOUR, MICRO_G, PPM};
use rins_imu::Seed;
use rins_terms::{Model, SettingKind, Term, TermInstance, Unit, catalogue};
use rins_testing::assert_close;

use crate::support::{SEED, STRONG, fibre, run, run_of};

/// Three rates, both ways: most effects differ here.
pub(crate) const RATES: [f64; 7] = [0.0, 10.0, -10.0, 40.0, -40.0, 20.0, -20.0];

pub(crate) fn found(run: &Run, knowledge: fn(NoiseParameters) -> NoiseKnowledge) -> Diagnosis {
    let imu = fibre();
    diagnose(
        std::slice::from_ref(run),
        &Model::full(),
        &imu,
        knowledge(NoiseParameters::of(&imu)),
        |_| (),
    )
    .unwrap()
}

pub(crate) fn hiding(effects: &[(&'static Term, &[f64])]) -> Model {
    let chosen = effects.iter().map(|(term, values)| TermInstance::new(term).with_values(values));
    Model { terms: chosen.collect() }
}

/// The cause of this id or one whose rival it is.
fn names(diagnosis: &Diagnosis, id: &str) -> bool {
    diagnosis
        .causes
        .iter()
        .any(|cause| cause.term.id == id || cause.rivals.iter().any(|rival| rival.term.id == id))
}

#[test]
fn hidden_effects_are_named_with_their_size() {
    let cases: [(&'static Term, &[f64]); 4] = [
        (&catalogue::ACCEL_LEVER_ARM, &[9e-3, -6e-3]),
        (&catalogue::ENCODER_LATENCY, &[60e-6]),
        (&catalogue::GYRO_SCALE_ASYMMETRY, &[6.0 * PPM]),
        (&catalogue::ENCODER_ECCENTRICITY, &[0.9 * ARCSEC, -0.6 * ARCSEC]),
    ];
    for (term, values) in cases {
        let run = run(&RATES, hiding(&[(term, values)]), 0.0, SEED);
        let diagnosis = found(&run, NoiseKnowledge::Given);
        let [cause] = &diagnosis.causes[..] else {
            panic!("{}: {:?}", term.id, diagnosis.causes);
        };
        assert_eq!(cause.term.id, term.id);
        assert!(cause.gain > STRONG, "{}: {}", term.id, cause.gain);
        for (estimate, truth) in cause.parameters.iter().zip(values) {
            let off = (estimate.value - truth) / estimate.sigma;
            assert!(off.abs() < 4.0, "{}: {off} sigma off", estimate.parameter.id);
        }
    }
}

/// A power of the rate is none of a list, and what is not known of it is not known of the amplitudes.
#[test]
fn the_power_of_the_rate_is_estimated_and_its_uncertainty_is_in_the_amplitudes() {
    const EXPONENT: f64 = 1.4;
    let values = [0.0, 12.0 * MICRO_G, -8.0 * MICRO_G];
    let shaken = TermInstance::new(&catalogue::ACCEL_VIBRATION_RECTIFICATION);
    let shaken = shaken.with_setting(SettingKind::Exponent, EXPONENT).with_values(&values);
    let run = run(&RATES, Model::default().with(shaken.clone()), 0.0, SEED);
    let diagnosis = found(&run, NoiseKnowledge::Given);
    let [cause] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
    assert_eq!(cause.term.id, shaken.term.id);
    let (_, sigma) = cause.sought.expect("an exponent that was sought");
    assert!(sigma < 0.3, "{sigma}");
    let off = (cause.settings[0] - EXPONENT) / sigma;
    assert!(off.abs() < 3.0, "exponent {off} sigma off");
    for (estimate, truth) in cause.parameters.iter().zip(values) {
        let off = (estimate.value - truth) / estimate.sigma;
        assert!(off.abs() < 3.5, "{off} sigma off");
    }
}

/// Half a sample of latency leaves so much that white noise is first taken for flicker: it is not where the search for the
/// noise ends, neither without the latency nor with it.
#[test]
fn half_a_sample_does_not_make_flicker_of_white_noise() {
    let sheet = NoiseParameters::of(&fibre());
    let late = hiding(&[(&catalogue::ENCODER_LATENCY, &[20e-3])]);
    let run = run(&[10.0, -10.0, 10.0, -10.0], late, 0.005 * DEG_PER_HOUR, SEED);
    let diagnosis = found(&run, NoiseKnowledge::Likely);
    let [cause] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
    assert_eq!(cause.term.id, "encoder_latency");
    assert!(cause.rivals.is_empty(), "{:?}", cause.rivals);
    let off = (cause.parameters[0].value - 20e-3) / cause.parameters[0].sigma;
    assert!(off.abs() < 4.0, "{off} sigma off");
    for fit in [&diagnosis.before, &diagnosis.after] {
        let found = fit.noise[0].imu;
        for (found, said) in [(found.gyro, sheet.gyro), (found.accel, sheet.accel)] {
            let off = (found.white / said.white).ln();
            assert!(off.abs() < 0.1, "off by a factor of e^{off}");
        }
    }
}

/// Biases that walk at random, of which the data sheet says nothing, are no ramp, step or slow line.
#[test]
fn a_random_walk_is_named_with_its_density() {
    let density = 2.0 * Unit::DEG_PER_HOUR_PER_ROOT_HOUR.factor;
    let walk = hiding(&[(&catalogue::GYRO_RATE_RANDOM_WALK, &[density])]);
    let diagnosis = found(&run(&RATES, walk, 0.0, SEED), NoiseKnowledge::Likely);
    let [cause] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
    assert_eq!(cause.term.id, "gyro_rate_random_walk");
    // Of the strength of a noise a run shows less; chance is taken for one at 10 nats.
    assert!(cause.gain > 50.0, "{}", cause.gain);
    let [estimate] = &cause.parameters[..] else { panic!("{:?}", cause.parameters) };
    let off = (estimate.value - density) / estimate.sigma;
    assert!(off.abs() < 3.0 && estimate.value > 5.0 * estimate.sigma, "{off} sigma off");
    assert!(diagnosis.unexplained.is_empty(), "{:?}", diagnosis.unexplained);
    // What it gains is over a model that has none.
    let walks = [&diagnosis.before, &diagnosis.after].map(|fit| fit.noise[0].imu.gyro.walk);
    assert!(walks[0] == 0.0 && walks[1] > 0.0, "{walks:?}");
}

/// An encoder that is read when a computer has time, and sensors that read in steps: neither is a signal, and what they do
/// is not left unexplained.
#[test]
fn what_a_logger_does_to_readings_is_named_with_its_size() {
    let cases: [(&'static Term, &[f64], usize); 4] = [
        (&catalogue::TIMESTAMP_JITTER, &[20e-6], 0),
        (&catalogue::GYRO_QUANTISATION, &[0.1 * ARCSEC, 0.0], 0),
        (&catalogue::GYRO_QUANTISATION, &[0.0, 0.2 * DEG_PER_HOUR], 1),
        (&catalogue::ACCEL_QUANTISATION, &[1e-4, 0.0], 0),
    ];
    for (term, values, place) in cases {
        let run = run(&RATES, hiding(&[(term, values)]), 0.0, SEED);
        let diagnosis = found(&run, NoiseKnowledge::Likely);
        let [cause] = &diagnosis.causes[..] else { panic!("{}: {:?}", term.id, diagnosis.causes) };
        assert_eq!(cause.term.id, term.id);
        let [estimate] = &cause.parameters[..] else { panic!("{:?}", cause.parameters) };
        assert_eq!(estimate.parameter.parameter, place, "{}", term.id);
        let off = (estimate.value - values[place]) / estimate.sigma;
        assert!(off.abs() < 3.0 && estimate.value > 5.0 * estimate.sigma, "{off} sigma off");
        assert!(diagnosis.unexplained.is_empty(), "{}: {:?}", term.id, diagnosis.unexplained);
    }
}

/// Jitter scatters more the faster the table turns, which where it ramps is not the same over any block: no heavy tails.
#[test]
fn jitter_on_a_table_that_ramps_leaves_nothing() {
    let late = hiding(&[(&catalogue::TIMESTAMP_JITTER, &[200e-6])]);
    let diagnosis =
        found(&run(&[80.0, -80.0, 80.0, -80.0, 80.0], late, 0.0, SEED), NoiseKnowledge::Likely);
    let [cause] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
    assert_eq!(cause.term.id, "timestamp_jitter");
    assert!(diagnosis.unexplained.is_empty(), "{:?}", diagnosis.unexplained);
}

/// Of what one effect does, another takes away as much as it can: either alone gains little of what both together do.
#[test]
fn effects_that_mask_each_other_are_both_found() {
    let imu = fibre();
    let knowledge = NoiseKnowledge::Given(NoiseParameters::of(&imu));
    let terms = [&catalogue::GYRO_SCALE_RAMP, &catalogue::GYRO_SCALE_NONLINEARITY];
    // The first is 24 of its sigmas beside the other.
    let hidden: [&[f64]; 2] = [&[13.5e-9], &[-38.4e-6, 40.8e-6]];
    let effects = hiding(&[(terms[0], hidden[0]), (terms[1], hidden[1])]);
    let run = run(&RATES, effects, 0.0, SEED);
    let runs = std::slice::from_ref(&run);
    let gain = |terms: &[&'static Term]| {
        let supposed: Vec<_> =
            terms.iter().map(|term| TermInstance::new(term).estimated()).collect();
        let fitted = suppose(runs, &Model::full(), &supposed, &imu, knowledge).unwrap();
        fitted.after.log_likelihood - fitted.before.log_likelihood
    };
    let both = gain(&terms);
    assert!(both > STRONG, "{both}");
    for term in terms {
        assert!(gain(&[term]) < 0.2 * both, "{} alone gains {} of {both}", term.id, gain(&[term]));
    }
    let mut causes = found(&run, NoiseKnowledge::Given).causes;
    causes.sort_by_key(|cause| cause.term.id != terms[0].id);
    let ids: Vec<&str> = causes.iter().map(|cause| cause.term.id).collect();
    assert_eq!(ids, terms.map(|term| term.id));
    for (cause, hidden) in causes.iter().zip(hidden) {
        for estimate in &cause.parameters {
            let off = (estimate.value - hidden[estimate.parameter.parameter]) / estimate.sigma;
            assert!(off.abs() < 4.0, "{}: {off} sigma off", estimate.parameter.id);
        }
    }
}

#[test]
fn two_effects_are_both_found() {
    let effects = hiding(&[
        (&catalogue::ACCEL_LEVER_ARM, &[3e-3, 1e-3]),
        (&catalogue::GYRO_THERMAL_BIAS, &[0.0, 0.0, 0.05 * DEG_PER_HOUR]),
    ]);
    let diagnosis = found(&run(&RATES, effects, 0.0, SEED), NoiseKnowledge::Given);
    let mut ids: Vec<&str> = diagnosis.causes.iter().map(|cause| cause.term.id).collect();
    ids.sort_unstable();
    assert_eq!(ids, ["accel_lever_arm", "gyro_thermal_bias"], "{:?}", diagnosis.causes);
    let gain = diagnosis.after.log_likelihood - diagnosis.before.log_likelihood;
    assert!(gain > 50.0, "{gain}");
}

/// Nothing is named in a run in which nothing is hidden, and in the same run with an effect that effect and no other.
#[test]
fn a_clean_run_is_adequate_and_the_same_with_an_effect_is_not() {
    let clean = found(&run(&RATES, Model::default(), 0.0, SEED), NoiseKnowledge::Given);
    assert!(clean.causes.is_empty(), "{:?}", clean.causes);
    assert!(clean.unexplained.is_empty(), "{:?}", clean.unexplained);
    let arm = hiding(&[(&catalogue::ACCEL_LEVER_ARM, &[9e-3, -6e-3])]);
    let diagnosis = found(&run(&RATES, arm, 0.0, SEED), NoiseKnowledge::Given);
    let ids: Vec<&str> = diagnosis.causes.iter().map(|cause| cause.term.id).collect();
    assert_eq!(ids, ["accel_lever_arm"]);
    assert!(diagnosis.unexplained.is_empty(), "{:?}", diagnosis.unexplained);
}

/// Flicker taken for white noise makes false names; its strength found beside every effect does not.
#[test]
fn flicker_is_not_named_as_an_effect() {
    let run = run(&RATES, Model::default(), 0.02 * DEG_PER_HOUR, SEED);
    let honest = found(&run, NoiseKnowledge::Likely);
    assert!(honest.causes.is_empty(), "{:?}", honest.causes);
    let naive = found(&run, NoiseKnowledge::Given);
    assert!(!naive.causes.is_empty());
}

/// The detectable amplitude is that of a power of 95 %; thrice as much is named, and of a fifth there is no sign.
#[test]
fn limits_are_where_detection_begins() {
    let term = &catalogue::ACCEL_LEVER_ARM;
    let simulated = |hidden| run_of(&RATES, 25.0, hidden, SEED);
    let clean = simulated(Model::default());
    let imu = fibre();
    let before = found(&clean, NoiseKnowledge::Given).before;
    let limits = limits(&[clean], &before, &imu).unwrap();
    let limit = limits.iter().find(|l| l.term.id == term.id && l.parameter == 0).unwrap();
    assert!(limit.detectable > 4.0 * limit.sigma && limit.detectable < 9.0 * limit.sigma);
    assert_close!(limit.power(limit.detectable), 0.95, 1e-6);
    assert_close!(limit.power(limit.significant * limit.sigma), 0.5, 1e-6);
    for (part, named) in [(3.0, &[term.id][..]), (0.2, &[])] {
        let effects = hiding(&[(term, &[part * limit.detectable, 0.0])]);
        let diagnosis = found(&simulated(effects), NoiseKnowledge::Given);
        let ids: Vec<&str> = diagnosis.causes.iter().map(|cause| cause.term.id).collect();
        assert_eq!(ids, named, "{part} of what is detectable: {:?}", diagnosis.causes);
    }
}

/// Simulated runs without an effect are diagnosed as such, and those with three times the noise of the data sheet, which is to be
/// trusted, are not.
#[test]
fn simulated_runs_show_how_often_nothing_is_taken_for_something() {
    let clean = run_of(&RATES, 20.0, Model::default(), SEED);
    let mut fit = found(&clean, NoiseKnowledge::Given).before;
    let (imu, runs) = (fibre(), [clean]);
    let alarms = |draws: u32, fit: &Fit, knowledge: fn(NoiseParameters) -> NoiseKnowledge| {
        let knowledge = knowledge(NoiseParameters::of(&imu));
        false_alarms(&runs, fit, (&imu, knowledge), (draws, Seed::new(5)), |_| ()).unwrap()
    };
    assert!(alarms(5, &fit, NoiseKnowledge::Likely) <= 1);
    fit.noise[0].imu.gyro.white *= 3.0;
    assert_eq!(alarms(2, &fit, NoiseKnowledge::Given), 2);
}

/// Noise that is not as the sheet says is named as such, and with its size.
#[test]
fn stronger_noise_than_the_sheet_says_is_named() {
    let louder = hiding(&[(&catalogue::ACCEL_NOISE_LEVEL, &[0.6])]);
    let diagnosis = found(&run(&RATES, louder, 0.0, SEED), NoiseKnowledge::Likely);
    let [cause] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
    assert_eq!(cause.term.id, "accel_noise_level");
    let excess = &cause.parameters[0];
    assert!((excess.value - 0.6).abs() < 4.0 * excess.sigma, "{excess:?}");
    assert!(excess.sigma < 0.05, "{excess:?}");
}

/// At one constant rate an eccentric encoder and a gyro that feels gravity are one signal.
#[test]
fn what_a_schedule_confuses_is_a_set() {
    let effects = hiding(&[(&catalogue::ENCODER_ECCENTRICITY, &[0.5 * ARCSEC, 0.0])]);
    let diagnosis = found(&run(&[10.0; 6], effects, 0.0, SEED), NoiseKnowledge::Given);
    assert!(!diagnosis.causes.is_empty());
    let set: Vec<&str> = diagnosis.causes[0].rivals.iter().map(|rival| rival.term.id).collect();
    assert!(names(&diagnosis, "encoder_eccentricity"), "{set:?}");
    assert!(!set.is_empty(), "{} alone", diagnosis.causes[0].term.id);
}

/// An order of the table angle that nothing in the catalogue has.
#[test]
fn what_no_effect_explains_is_described_and_not_named() {
    const AMPLITUDE: f64 = 0.1 * DEG_PER_HOUR;
    const ORDER: f64 = 1.37;
    let mut run = run(&RATES, Model::default(), 0.0, SEED);
    let angles = run.recording.table_angle.clone().unwrap();
    for (sample, angle) in Arc::make_mut(&mut run.recording).increments.iter_mut().zip(angles) {
        let rate = AMPLITUDE * (ORDER * angle).cos();
        sample.angle += InFrame::new(0.0, rate * sample.interval, 0.0);
    }
    let diagnosis = found(&run, NoiseKnowledge::Given);
    assert!(diagnosis.causes.is_empty(), "{:?}", diagnosis.causes);
    let [one, ..] = &diagnosis.unexplained[..] else { panic!("nothing is found") };
    let Structure::Order(order) = one.structure else { panic!("{one:?}") };
    // On one axis both senses are one.
    assert!((order.abs() - ORDER).abs() < 0.1, "{order}");
    assert_eq!(one.channel, "gyro.y");
    let (amplitude, unit) = one.amplitude.unwrap();
    assert_eq!(unit.symbol, "deg/h");
    assert!((amplitude / AMPLITUDE - 1.0).abs() < 0.2, "{}", amplitude / DEG_PER_HOUR);
    assert!(one.worst.iter().all(|(_, worst)| *worst > 0.0) && one.worst.len() == 3);
}

/// An effect that is there for a part of the time is named, and said not to be what it seems.
#[test]
fn an_effect_that_comes_and_goes_is_inconstant() {
    let effect = hiding(&[(&catalogue::ENCODER_ECCENTRICITY, &[1.35 * ARCSEC, -0.9 * ARCSEC])]);
    let with = run(&RATES, effect, 0.0, SEED);
    let mut sometimes = run(&RATES, Model::default(), 0.0, SEED);
    let half = sometimes.recording.increments.len() / 2;
    let angles = with.recording.table_angle.as_ref().unwrap();
    Arc::make_mut(&mut sometimes.recording).table_angle.as_mut().unwrap()[..half]
        .copy_from_slice(&angles[..half]);
    let diagnosis = found(&sometimes, NoiseKnowledge::Given);
    assert!(names(&diagnosis, "encoder_eccentricity"), "{:?}", diagnosis.causes);
    let inconstant = |one: &&Unexplained| one.structure == Structure::Inconstant(Stratum::Time);
    let found_on = diagnosis.unexplained.iter().find(inconstant);
    let one = found_on.unwrap_or_else(|| panic!("{:?}", diagnosis.unexplained));
    assert!(one.ln_p < -STRONG, "{one:?}");
    let whole = found(&with, NoiseKnowledge::Given);
    assert!(whole.unexplained.is_empty(), "{:?}", whole.unexplained);
}
