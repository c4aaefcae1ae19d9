//! What happens at once, or comes at another time than it is stamped with.

use rins_estimation::{NoiseKnowledge, Run};
use rins_frames::units::ARCSEC;
use rins_terms::{Model, SettingKind, Term, TermInstance, catalogue};

use crate::hidden::{RATES, found, hiding};
use crate::support::{INTERVAL, SEED, run};

/// However far an encoder slips, or whatever it loses: in which sample that was is seen.
#[test]
fn what_an_encoder_does_at_once_is_named_in_its_sample() {
    const TIME: f64 = 133.333;
    let cases: [(&'static Term, f64); 3] = [
        (&catalogue::ENCODER_SLIP, 8.0 * ARCSEC),
        (&catalogue::ENCODER_SLIP, 200.0 * ARCSEC),
        (&catalogue::DROPPED_SAMPLES, 20e-3),
    ];
    for (term, size) in cases {
        let event =
            TermInstance::new(term).with_setting(SettingKind::Time, TIME).with_values(&[size]);
        let run = run(&RATES, Model::default().with(event), 0.0, SEED);
        let diagnosis = found(&run, NoiseKnowledge::Likely);
        let [cause] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
        assert_eq!(cause.term.id, term.id);
        assert!((cause.settings[0] - TIME).abs() < 0.04, "{}: {:?}", term.id, cause.settings);
        let [estimate] = &cause.parameters[..] else { panic!("{:?}", cause.parameters) };
        let off = (estimate.value - size) / estimate.sigma;
        assert!(off.abs() < 4.0, "{}: {off} sigma off", term.id);
        assert!(diagnosis.unexplained.is_empty(), "{:?}", diagnosis.unexplained);
    }
}

/// A step of the base is over within an epoch, and no grid of times would meet it.
#[test]
fn a_step_is_found_at_its_instant() {
    let mut step =
        TermInstance::new(&catalogue::BASE_TILT_STEP).with_setting(SettingKind::Time, 137.31);
    step.values[0] = 0.3 * ARCSEC;
    let hidden = Model { terms: vec![step] };
    let diagnosis = found(&run(&RATES, hidden, 0.0, SEED), NoiseKnowledge::Likely);
    let [cause] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
    assert_eq!(cause.term.id, "base_tilt_step");
    assert!((cause.settings[0] - 137.31).abs() < 0.5, "{:?}", cause.settings);
    let off = (cause.parameters[0].value - 0.3 * ARCSEC) / cause.parameters[0].sigma;
    assert!(off.abs() < 4.0, "{off}");
}

/// One reversal, within an epoch: play shifts the reading from that very sample on, and a slip would need its time.
#[test]
fn backlash_shows_at_the_instant_of_a_reversal() {
    for rate in [11.0, 12.5, 14.3] {
        let play = -2.0 * ARCSEC;
        let hidden = hiding(&[(&catalogue::ENCODER_BACKLASH, &[play])]);
        let run = run(&[0.0, rate, -rate], hidden, 0.0, SEED);
        let diagnosis = found(&run, NoiseKnowledge::Likely);
        let [cause] = &diagnosis.causes[..] else { panic!("{rate}: {:?}", diagnosis.causes) };
        assert_eq!(cause.term.id, "encoder_backlash", "{rate}");
        let [of] = &cause.parameters[..] else { panic!("{:?}", cause.parameters) };
        assert!((of.value - play).abs() < 4.0 * of.sigma, "{rate}: {} of {play}", of.value);
        assert!(diagnosis.unexplained.is_empty(), "{rate}: {:?}", diagnosis.unexplained);
    }
}

/// Stamps that are those of the next sample, over stops and starts that take a second: a delay of many thousand sigmas, and nothing
/// beside it.
#[test]
fn angles_that_are_one_sample_off_are_late_and_no_more() {
    let rates: Vec<f64> = (0..13).map(|stop| [0.0, 15.0, 0.0, -15.0][stop % 4]).collect();
    for shift in [1, -1] {
        let given = run(&rates, Model::default(), 0.0, SEED);
        let mut recording = (*given.recording).clone();
        let angles = recording.table_angle.as_mut().unwrap();
        // The table rests where the run begins and where it ends.
        let last = angles.len() - 1;
        if shift > 0 {
            angles.copy_within(1.., 0);
        } else {
            angles.copy_within(..last, 1);
        }
        let shifted = Run::new(given.rig, recording).unwrap();
        let diagnosis = found(&shifted, NoiseKnowledge::Likely);
        let [cause] = &diagnosis.causes[..] else { panic!("{shift}: {:?}", diagnosis.causes) };
        assert_eq!(cause.term.id, "encoder_latency");
        let [delay] = &cause.parameters[..] else { panic!("{:?}", cause.parameters) };
        let off = (delay.value + f64::from(shift) * INTERVAL) / delay.sigma;
        assert!(off.abs() < 4.0 && delay.sigma < 1e-5, "{off} sigma of {} s", delay.sigma);
        assert!(diagnosis.unexplained.is_empty(), "{shift}: {:?}", diagnosis.unexplained);
    }
}

/// A base that tips over within an epoch, at once or in a fifth of a second, under a table whose axis is not upright: the gyros show in
/// which samples, and what it does about the axis is no slip of the encoder.
#[test]
fn a_base_that_tips_over_is_found_in_its_samples() {
    let tilt = [3.0 * ARCSEC, -2.0 * ARCSEC, 1.2 * ARCSEC];
    for duration in [0.0, 0.2] {
        let step = TermInstance::new(&catalogue::BASE_TILT_STEP)
            .with_setting(SettingKind::Time, 151.13)
            .with_setting(SettingKind::Duration, duration);
        let hidden = Model { terms: vec![step.with_values(&tilt)] };
        let diagnosis = found(&run(&RATES, hidden, 0.0, SEED), NoiseKnowledge::Likely);
        let [cause] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
        assert_eq!(cause.term.id, "base_tilt_step");
        let [time, lasting] = cause.settings[..] else { panic!("{:?}", cause.settings) };
        assert!((time - 151.13).abs() < 0.04, "{time}");
        // To a sample.
        assert!((lasting - duration).abs() < INTERVAL, "{lasting} of {duration}");
        for (estimate, truth) in cause.parameters.iter().zip(tilt) {
            let off = (estimate.value - truth) / estimate.sigma;
            assert!(off.abs() < 4.0 && estimate.sigma < 0.1 * ARCSEC, "{off} sigma off");
        }
        assert!(diagnosis.unexplained.is_empty(), "{:?}", diagnosis.unexplained);
    }
}
