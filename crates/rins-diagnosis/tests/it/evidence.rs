//! The search by the score of whole hypotheses.

use rins_diagnosis::{Cause, Diagnosis, diagnose, suppose};
use rins_estimation::{NoiseKnowledge, NoiseParameters, Run};
use rins_frames::units::{ARCSEC, DEG_PER_HOUR, MICRO_G, PPM};
use rins_imu::ImuSpec;
use rins_terms::{Model, SettingKind, Term, TermInstance, catalogue};

use crate::hidden::{RATES, hiding};
use crate::support::{SEED, fibre, run};

fn found_with(run: &Run, imu: &ImuSpec) -> Diagnosis {
    let knowledge = NoiseKnowledge::Likely(NoiseParameters::of(imu));
    let runs = std::slice::from_ref(run);
    diagnose(runs, &Model::full(), imu, knowledge, |_| ()).unwrap()
}

fn found(run: &Run) -> Diagnosis {
    found_with(run, &fibre())
}

/// Whether a cause is this effect or may be it.
fn may_be(cause: &Cause, term: &Term) -> bool {
    cause.term.is(term) || cause.rivals.iter().any(|rival| rival.term.is(term))
}

fn assert_amplitudes(cause: &Cause, values: &[f64]) {
    for (estimate, truth) in cause.parameters.iter().zip(values) {
        let off = (estimate.value - truth) / estimate.sigma;
        assert!(off.abs() < 4.0, "{}: {off} sigma off", estimate.parameter.id);
    }
}

#[test]
fn hidden_effects_are_named_with_their_amplitudes() {
    let cases: [(&'static Term, &[f64]); 3] = [
        (&catalogue::GYRO_SCALE_ASYMMETRY, &[6.0 * PPM]),
        (&catalogue::ENCODER_ECCENTRICITY, &[0.9 * ARCSEC, -0.6 * ARCSEC]),
        (&catalogue::ACCEL_BIAS_RAMP, &[0.0, 0.2 * MICRO_G, 0.0]),
    ];
    for (term, values) in cases {
        let diagnosis = found(&run(&RATES, hiding(&[(term, values)]), 0.0, SEED));
        let [cause] = &diagnosis.causes[..] else {
            panic!("{}: {:?}", term.id, diagnosis.causes);
        };
        assert!(may_be(cause, term), "{}: {cause:?}", term.id);
        let stated: f64 = cause.rivals.iter().map(|rival| cause.probability_of(rival)).sum();
        assert!((cause.probability() + stated - 1.0).abs() < 1e-9);
        if cause.term.is(term) {
            assert_amplitudes(cause, values);
        }
        assert!(diagnosis.unexplained.is_empty(), "{:?}", diagnosis.unexplained);
    }
}

#[test]
fn nothing_is_named_where_nothing_is() {
    for flicker in [0.0, 0.02 * DEG_PER_HOUR] {
        let diagnosis = found(&run(&RATES, Model::default(), flicker, SEED));
        assert!(diagnosis.causes.is_empty(), "{:?}", diagnosis.causes);
        assert!(diagnosis.unexplained.is_empty(), "{:?}", diagnosis.unexplained);
    }
}

#[test]
fn two_effects_are_named_together() {
    let step = TermInstance::new(&catalogue::GYRO_BIAS_STEP);
    let step = step.with_setting(SettingKind::Time, 173.0).with_values(&[
        0.3 * DEG_PER_HOUR,
        0.0,
        -0.2 * DEG_PER_HOUR,
    ]);
    let latency = TermInstance::new(&catalogue::ENCODER_LATENCY).with_values(&[80e-6]);
    let hidden = Model::default().with(step).with(latency);
    let diagnosis = found(&run(&RATES, hidden, 0.0, SEED));
    assert_eq!(diagnosis.causes.len(), 2, "{:?}", diagnosis.causes);
    for term in [&catalogue::GYRO_BIAS_STEP, &catalogue::ENCODER_LATENCY] {
        assert!(diagnosis.causes.iter().any(|cause| may_be(cause, term)), "{}", term.id);
    }
}

/// A bias of 25 sigmas of its data sheet is no effect of the catalogue.
#[test]
fn bias_beyond_its_data_sheet_is_a_hypothesis() {
    let mut imu = fibre();
    imu.gyro.bias_sigma = 0.002 * DEG_PER_HOUR;
    let diagnosis = found_with(&run(&RATES, Model::default(), 0.0, SEED), &imu);
    let [cause] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
    assert!(may_be(cause, &catalogue::GYRO_BIAS), "{cause:?}");
    if cause.term.is(&catalogue::GYRO_BIAS) {
        let y = cause.parameters.iter().find(|one| one.parameter.id == "gyro.bias.y").unwrap();
        assert!((y.value - 0.05 * DEG_PER_HOUR).abs() < 4.0 * y.sigma, "{y:?}");
    }
}

/// A ramp of four thousand sigmas moves everything that is estimated with it: pairs of effects that nearly cancel promise as much in
/// the linear pass.
#[test]
fn strong_ramp_is_named_alone() {
    let values = [200.0 * DEG_PER_HOUR / 3600.0, 0.0, 0.0];
    let hidden = hiding(&[(&catalogue::GYRO_BIAS_RAMP, &values)]);
    let diagnosis = found(&run(&[0.0, 10.0, -10.0], hidden, 0.0, SEED));
    let [cause] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
    assert!(cause.term.is(&catalogue::GYRO_BIAS_RAMP), "{cause:?}");
    assert_amplitudes(cause, &values);
}

/// A walk of which the fit without it makes a bias instability: the white noise of the gyros is nothing beside either. No series
/// of steps, ramps and transients stands in its place.
#[test]
fn strong_walk_is_named_alone() {
    let density = 3.0 * DEG_PER_HOUR / 60.0;
    let hidden = hiding(&[(&catalogue::GYRO_RATE_RANDOM_WALK, &[density])]);
    let diagnosis = found(&run(&RATES, hidden, 0.0, SEED));
    let [cause] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
    assert!(cause.term.is(&catalogue::GYRO_RATE_RANDOM_WALK), "{cause:?}");
    assert!(cause.ln_p < 1e-6_f64.ln(), "{cause:?}");
    assert_amplitudes(cause, &[density]);
    let relative = cause.parameters[0].sigma / cause.parameters[0].value;
    assert!((0.01..0.5).contains(&relative), "{cause:?}");
}

/// A given hypothesis has the score that the search gives it.
#[test]
fn given_hypothesis_has_the_significance_of_the_search() {
    let values = [9e-3, -6e-3];
    let run = run(&RATES, hiding(&[(&catalogue::ACCEL_LEVER_ARM, &values)]), 0.0, SEED);
    let searched = found(&run);
    let imu = fibre();
    let given = suppose(
        std::slice::from_ref(&run),
        &Model::full(),
        &[TermInstance::new(&catalogue::ACCEL_LEVER_ARM).estimated()],
        &imu,
        NoiseKnowledge::Likely(NoiseParameters::of(&imu)),
    )
    .unwrap();
    assert_amplitudes(&given.causes[0], &values);
    let [searched, given] = [searched, given].map(|one| one.causes[0].ln_p);
    assert!((searched - given).abs() < 1.0, "{searched} {given}");
}
