//! What comes again: the marks of a disc at every turn, and what happens twice.

use rins_diagnosis::Cause;
use rins_estimation::NoiseKnowledge;
use rins_frames::units::{ARCSEC, DEG_PER_HOUR};
use rins_terms::{Model, SettingKind, Term, TermInstance, catalogue};

use crate::hidden::{RATES, found};
use crate::support::{SEED, run};

/// The marks of a disc, faster than an epoch at all but the lowest rate, are no lines: each rate would have its own.
#[test]
fn a_high_harmonic_of_the_encoder_is_named_with_its_order() {
    let values = [0.2 * ARCSEC, -0.3 * ARCSEC];
    let harmonic =
        TermInstance::new(&catalogue::ENCODER_HARMONIC).with_setting(SettingKind::Order, 37.0);
    let hidden = Model { terms: vec![harmonic.with_values(&values)] };
    let diagnosis = found(&run(&RATES, hidden, 0.0, SEED), NoiseKnowledge::Given);
    let [cause] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
    assert_eq!((cause.term.id, &cause.settings[..]), ("encoder_harmonic", &[37.0][..]));
    assert!(diagnosis.unexplained.is_empty(), "{:?}", diagnosis.unexplained);
    for (estimate, truth) in cause.parameters.iter().zip(values) {
        let off = (estimate.value - truth) / estimate.sigma;
        assert!(off.abs() < 4.0, "{off} sigma off");
    }
}

/// An event, when it happens \[s\], and how large it is.
type Twice = (&'static Term, [f64; 2], [&'static [f64]; 2]);

/// What happens twice is two events, and neither a drift nor anything else that has two parameters more.
#[test]
fn what_happens_twice_is_named_twice() {
    let cases: [Twice; 2] = [
        (&catalogue::ENCODER_SLIP, [70.0, 190.0], [&[4.0 * ARCSEC], &[-6.0 * ARCSEC]]),
        (
            &catalogue::GYRO_BIAS_STEP,
            [60.0, 180.0],
            [&[0.0, 0.3 * DEG_PER_HOUR, 0.0], &[0.0, -0.3 * DEG_PER_HOUR, 0.0]],
        ),
    ];
    for (term, times, values) in cases {
        let at = |event: usize| {
            TermInstance::new(term)
                .with_setting(SettingKind::Time, times[event])
                .with_values(values[event])
        };
        let run = run(&RATES, Model { terms: vec![at(0), at(1)] }, 0.0, SEED);
        let diagnosis = found(&run, NoiseKnowledge::Given);
        assert_eq!(diagnosis.causes.len(), 2, "{:?}", diagnosis.causes);
        assert!(diagnosis.unexplained.is_empty(), "{:?}", diagnosis.unexplained);
        for (time, values) in times.into_iter().zip(values) {
            let is_it = |cause: &&Cause| (cause.settings[0] - time).abs() < 1.0;
            let cause = diagnosis.causes.iter().find(is_it).expect("an event at its time");
            assert_eq!(cause.term.id, term.id);
            for estimate in &cause.parameters {
                let off = (estimate.value - values[estimate.parameter.parameter]) / estimate.sigma;
                assert!(off.abs() < 4.0, "{} at {time} s: {off} sigma off", term.id);
            }
        }
    }
}

/// Electronics warm up sooner than the block that they are on: what settles with two time constants is no chain of other effects,
/// and what settles with one is one.
#[test]
fn warm_up_of_two_time_constants_is_two() {
    let warm_up = |values: [f64; 3], time_constant: f64| {
        let chosen = TermInstance::new(&catalogue::GYRO_WARMUP)
            .with_setting(SettingKind::TimeConstant, time_constant);
        chosen.with_values(&values.map(|value| value * DEG_PER_HOUR))
    };
    let both = [warm_up([0.0, 0.5, 0.0], 15.0), warm_up([0.0, 0.4, 0.0], 130.0)];
    for hidden in [&both[..], &both[1..]] {
        let run = run(&RATES, Model { terms: hidden.to_vec() }, 0.0, SEED);
        let mut diagnosis = found(&run, NoiseKnowledge::Likely);
        diagnosis.causes.sort_by(|a, b| a.settings[0].total_cmp(&b.settings[0]));
        let names: Vec<&str> = diagnosis.causes.iter().map(|cause| cause.term.id).collect();
        assert_eq!(names, vec!["gyro_warmup"; hidden.len()]);
        assert!(diagnosis.unexplained.is_empty(), "{:?}", diagnosis.unexplained);
        for (cause, hidden) in diagnosis.causes.iter().zip(hidden) {
            let (_, sigma) = cause.sought.expect("a time constant that was sought");
            let off = (cause.settings[0] - hidden.settings[0]) / sigma;
            assert!(off.abs() < 3.5, "{} s, {off} sigma off", cause.settings[0]);
            for (estimate, truth) in cause.parameters.iter().zip(&hidden.values) {
                let off = (estimate.value - truth) / estimate.sigma;
                assert!(off.abs() < 3.5, "{off} sigma off");
            }
        }
    }
}
