//! Sensors and encoders that read in steps: the rounding is no effect.

use rins_diagnosis::diagnose;
use rins_estimation::{NoiseKnowledge, NoiseParameters, Run};
use rins_frames::units::{ARCSEC, DEG_PER_HOUR};
use rins_imu::rounded;
use rins_terms::{Model, TermInstance, catalogue};

use crate::hidden::{RATES, found, hiding};
use crate::support::{SEED, STRONG, fibre, run};

/// A step of a gyro in an increment \[rad\].
const STEP: f64 = 0.3 * ARCSEC;

/// Rates at which a gyro's reading hardly changes \[deg/s\].
const SLOW: [f64; 7] = [0.0, 2.0, -2.0, 0.0, 2.0, -2.0, 2.0];

/// The same run, its encoder read in steps \[rad\].
fn in_steps(run: &Run, step: f64) -> Run {
    let mut recording = (*run.recording).clone();
    for angle in recording.table_angle.iter_mut().flatten() {
        *angle = rounded(*angle, step);
    }
    Run::new(run.rig, recording).unwrap()
}

/// At these rates a sample is a whole number of steps of 5 arcsec, and none of 3.7: either way rounding is no white noise.
#[test]
fn steps_of_an_encoder_are_no_effect() {
    let plain = run(&RATES, Model::default(), 0.0, SEED);
    let lever = TermInstance::new(&catalogue::ACCEL_LEVER_ARM).with_values(&[3e-3, -2e-3]);
    let lever = run(&RATES, Model::default().with(lever), 0.0, SEED);
    for step in [3.7 * ARCSEC, 5.0 * ARCSEC, 40.0 * ARCSEC] {
        let coarse = in_steps(&plain, step);
        assert!(coarse.angle_steps.is_some(), "{step} rad");
        let diagnosis = found(&coarse, NoiseKnowledge::Likely);
        assert!(diagnosis.causes.is_empty(), "{:?}", diagnosis.causes);
        assert!(diagnosis.unexplained.is_empty(), "{:?}", diagnosis.unexplained);
        let diagnosis = found(&in_steps(&lever, step), NoiseKnowledge::Given);
        let [cause] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
        assert_eq!(cause.term.id, "accel_lever_arm");
    }
}

/// Where a gyro's reading hardly changes, the rounding that is carried on is out by a part of a step for long.
#[test]
fn rounding_that_stands_still_is_no_tilt() {
    let bits = [STEP, 0.0];
    let model = hiding(&[(&catalogue::GYRO_QUANTISATION, &bits)]);
    let run = run(&SLOW[..6], model, 0.0, SEED);
    let diagnosis = found(&run, NoiseKnowledge::Likely);
    let [cause] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
    assert_eq!(cause.term.id, "gyro_quantisation");
    assert!(cause.gain > STRONG, "{}", cause.gain);
}

/// The sheet's step, of two sigmas of a sample, is nothing that the model lacks; one three times as high is.
#[test]
fn steps_that_the_sheet_states_are_no_effect() {
    let step = 0.2 * DEG_PER_HOUR;
    let model = hiding(&[(&catalogue::GYRO_QUANTISATION, &[0.0, step])]);
    let runs = [run(&RATES, model, 0.0, SEED)];
    let mut imu = fibre();
    let known = NoiseKnowledge::Likely(NoiseParameters::of(&imu));
    for (stated, named) in [(1.0, 0), (0.3, 1)] {
        imu.gyro.resolution = Some(stated * step);
        let diagnosis = diagnose(&runs, &Model::full(), &imu, known, |_| ()).unwrap();
        let ids: Vec<&str> = diagnosis.causes.iter().map(|cause| cause.term.id).collect();
        assert_eq!(ids, &["gyro_quantisation"][..named], "{stated}");
        assert!(diagnosis.unexplained.is_empty(), "{:?}", diagnosis.unexplained);
    }
}

/// A dead zone of far less than a step is one where what is rounded off is carried on.
#[test]
fn dead_zone_beside_rounding_that_is_carried_on_is_named() {
    let bits = [STEP, 0.0];
    let zone = [0.4 * DEG_PER_HOUR, 0.4 * DEG_PER_HOUR, 0.0];
    let model =
        hiding(&[(&catalogue::GYRO_QUANTISATION, &bits), (&catalogue::GYRO_DEAD_ZONE, &zone)]);
    let diagnosis = found(&run(&SLOW, model, 0.0, SEED), NoiseKnowledge::Likely);
    let names: Vec<&str> = diagnosis.causes.iter().map(|cause| cause.term.id).collect();
    assert!(names.contains(&"gyro_dead_zone"), "{names:?}");
}
