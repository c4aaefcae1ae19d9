//! An encoder with a coarse resolution.

use rins_estimation::{AngleSteps, Noise, NoiseParameters, Run, innovations, linearise};
use rins_frames::units::ARCSEC;
use rins_imu::ImuError;
use rins_terms::Model;

use crate::support::{fibre, profile, run, scenario, tilted};

/// Static intervals, rates of an integer number of LSBs per sample, and other rates.
const RATES: [(f64, f64); 6] =
    [(0.0, 40.0), (10.0, 60.0), (-5.0, 60.0), (0.0, 30.0), (3.217, 60.0), (-7.77, 60.0)];

/// A run without noise, whose encoder has a resolution of this many arcseconds.
fn rounded(step: f64) -> Run {
    rounded_at(&RATES, step)
}

/// The same at other rates.
fn rounded_at(rates: &[(f64, f64)], step: f64) -> Run {
    let perfect = (ImuError::default(), Model::default());
    let run = run(&scenario(tilted(25.0, 30.0), profile(rates), perfect, None, 1));
    let mut recording = (*run.recording).clone();
    for angle in recording.table_angle.iter_mut().flatten() {
        *angle = (*angle / (step * ARCSEC)).round() * step * ARCSEC;
    }
    Run::new(run.rig, recording).unwrap()
}

/// The sum of squares of all innovations of a run.
fn squares(run: &Run) -> f64 {
    let linear = linearise(run, &Model::default(), &[]);
    let noise = Noise::on(&run.rig, &NoiseParameters::of(&fibre()));
    let all = innovations(&linear, &noise, &[]).unwrap();
    all.iter().map(nalgebra::Matrix::norm_squared).sum()
}

#[test]
fn all_rounding_of_a_run_is_worth_no_more_than_chance_is() {
    for step in [2.0, 5.0, 20.0, 36.0] {
        let mut run = rounded(step);
        let steps = run.angle_steps.unwrap();
        assert!((steps.step / (step * ARCSEC) - 1.0).abs() < 1e-6, "{step}: {steps:?}");
        assert!(steps.blur < 0.02, "{step}: {steps:?}");
        let worth = squares(&run);
        assert!((0.1..6.0).contains(&worth), "{step} arcsec: {worth}");
        run.angle_steps = None;
        let taken_for_noise = squares(&run);
        assert!(taken_for_noise > 30.0 * worth, "{step} arcsec: {worth}, {taken_for_noise}");
    }
}

#[test]
fn a_table_without_noise_reads_in_no_steps() {
    assert_eq!(rounded(1e-6).angle_steps, None);
    // Nor does one whose LSB is small compared with the noise of 0.5 arcsec.
    assert_eq!(rounded(0.3).angle_steps, None);
}

/// Nothing in the data shows that readings are rounded, but they would cause outliers.
#[test]
fn steps_that_a_table_turns_by_in_whole_numbers_are_believed_if_they_are_stated() {
    let step = 3.6 * ARCSEC;
    let run = rounded_at(&[(10.0, 60.0), (-5.0, 60.0)], 3.6);
    assert_eq!(run.angle_steps, None);
    let stated = |step| AngleSteps::of(&run.recording, 0.5 * ARCSEC, Some(step));
    let steps = stated(step).unwrap();
    assert!((steps.step / step - 1.0).abs() < 1e-6, "{steps:?}");
    // An LSB that is small compared with the noise is not used, even if it is stated.
    assert_eq!(stated(0.1 * step), None);
}
