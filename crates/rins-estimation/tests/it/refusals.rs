//! Impossible estimations are refused, with the value that is wrong.

use rins_estimation::{FitError, NoiseKnowledge, NoiseParameters, Reference, Run, RunError, fit};
use rins_imu::ImuError;
use rins_motion::Recording;
use rins_terms::{Model, TermInstance, catalogue};

use crate::support::{fibre, profile, run, scenario, tilted};

fn any_run() -> Run {
    let truth = (ImuError::default(), Model::default());
    run(&scenario(tilted(25.0, 0.0), profile(&[(10.0, 20.0)]), truth, None, 0))
}

#[test]
fn run_lacks_its_reference_is_too_short_or_level() {
    let Run { rig, recording, .. } = any_run();
    let recording = Recording::clone(&recording);
    let of = |rig, recording| Run::new(rig, recording).unwrap_err();
    let short = recording.slice(0, 20);
    let RunError::TooShort { duration, needed } = of(rig, short) else { panic!("it is too short") };
    assert!(duration < needed && needed <= 2.0, "{duration} s of {needed} s");
    let blind = Recording { table_angle: None, ..recording.clone() };
    assert_eq!(of(rig, blind), RunError::NoAngle);
    let commanded = rins_estimation::Rig { reference: Reference::Command { noise: 0.0 }, ..rig };
    assert_eq!(of(commanded, recording.clone()), RunError::NoRate);
    let level = rins_estimation::Rig {
        reference: Reference::Gravity,
        nav_from_table: rins_frames::Dcm::identity(),
        ..rig
    };
    let refusal = of(level, recording.clone());
    assert!(refusal.to_string().starts_with("the spin axis is tilted by 0.00 deg"), "{refusal}");
    let steady = rins_estimation::Rig { wobble: 0.0, ..rig };
    let refusal = of(steady, recording);
    assert_eq!(
        refusal.to_string(),
        "the wobble of the spin axis is 0; it must be finite and more than zero"
    );
}

#[test]
fn nothing_to_estimate_is_said() {
    let imu = fibre();
    let strengths = NoiseParameters::of(&imu);
    let of = |runs: &[Run], model: &Model| {
        fit(runs, model, &imu, NoiseKnowledge::Given(strengths), |_| ()).unwrap_err()
    };
    assert_eq!(of(&[], &Model::full()), FitError::NoRun);
    assert_eq!(of(&[any_run()], &Model::default()), FitError::NothingFree);
    let mut many = Model::full();
    many.terms.extend(std::iter::repeat_n(
        TermInstance::new(&catalogue::ENCODER_HARMONIC).estimated(),
        128,
    ));
    let refusal = of(&[any_run()], &many);
    assert!(
        matches!(refusal, FitError::ManyParameters { parameters: 257.., most: 256 }),
        "{refusal}"
    );
}
