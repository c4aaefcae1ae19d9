//! Samples that are excluded from a run have no influence, and are predicted from the others.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use rins_estimation::{
    EpochPrediction, Fit, NoiseKnowledge, NoiseParameters, ParameterPosterior, Run, fit, linearise,
};
use rins_frames::InFrame;
use rins_frames::units::{ARCSEC, DEG_PER_HOUR, MICRO_G, PPM};
use rins_imu::{Axis, ImuError, TriadError};
use rins_terms::Model;

use crate::support::{fibre, profile, run, scenario, tilted, white};

/// Samples of the second rotation.
const SPAN: Range<usize> = 1900..2200;

fn turned() -> Run {
    let gyro = TriadError::default().with_scale(Axis::Z, 200.0 * PPM).with_bias(Axis::X, 1e-7);
    let turns = profile(&[(0.0, 10.0), (10.0, 40.0), (-20.0, 40.0), (0.0, 10.0)]);
    let error = ImuError { gyro, ..ImuError::default() };
    let truth = (error, Model::default());
    run(&scenario(tilted(25.0, 40.0), turns, truth, Some(white(&fibre())), 3))
}

fn fitted(run: &Run) -> Fit {
    let imu = fibre();
    let known = NoiseKnowledge::Given(NoiseParameters::of(&imu));
    fit(std::slice::from_ref(run), &Model::full(), &imu, known, |_| ()).unwrap()
}

/// The largest difference of two fits in sigmas of the first.
fn apart(one: &Fit, other: &Fit) -> f64 {
    let pairs = one.parameters.iter().zip(&other.parameters);
    pairs.map(|(a, b)| ((b.value - a.value) / a.sigma).abs()).fold(0.0, f64::max)
}

#[test]
fn what_is_left_out_may_be_anything() {
    let run = turned();
    let mut spoiled = run.clone();
    let recording = Arc::make_mut(&mut spoiled.recording);
    for sample in SPAN {
        let increments = &mut recording.increments[sample];
        let interval = increments.interval;
        increments.angle += InFrame::new(3.0, -2.0, 4.0) * (DEG_PER_HOUR * interval);
        increments.velocity += InFrame::new(0.0, 500.0, 300.0) * (MICRO_G * interval);
        recording.table_angle.as_mut().unwrap()[sample] += 20.0 * ARCSEC;
    }
    let without = |run: &Run| fitted(&run.clone().leaving_out(vec![SPAN]));
    let (honest, harmless) = (without(&run), without(&spoiled));
    let moved = apart(&honest, &harmless);
    assert!(moved < 0.02, "{moved} sigma");
    // If it is not excluded it biases everything.
    let harmed = apart(&honest, &fitted(&spoiled));
    assert!(harmed > 10.0, "{harmed} sigma");
}

#[test]
fn what_is_left_out_tells_nothing() {
    let run = turned();
    let whole = fitted(&run);
    let most = fitted(&run.clone().leaving_out(vec![SPAN]));
    assert!(most.evidence.figures < whole.evidence.figures);
    for (more, less) in whole.parameters.iter().zip(&most.parameters) {
        assert!(less.sigma > more.sigma * (1.0 - 1e-9), "{}", more.parameter.id);
    }
}

/// The sum of the log-densities of all epochs is that of all data: that of the batch solution, which integrates the
/// parameters out at once.
#[test]
fn what_is_foretold_is_as_likely_as_the_whole() {
    let fit = fitted(&turned());
    let offsets = fit.parameters.iter().map(|one| one.expected - one.value);
    let variances = fit.parameters.iter().map(|one| one.parameter.sigma.powi(2));
    let p = fit.parameters.len();
    let expected = DVector::from_iterator(p, offsets);
    let prior = DMatrix::from_diagonal(&DVector::from_iterator(p, variances));
    let places: Vec<usize> = (0..p).collect();
    let mut known = ParameterPosterior::new(expected, prior);
    let all = known.predict(&fit.linear[0], &fit.noise[0], &places, |_| true).unwrap();
    let sum: f64 = all.iter().map(|epoch| epoch.log_density).sum();
    let figures = fit.evidence.figures as f64;
    let whole = fit.log_likelihood - 0.5 * figures * std::f64::consts::TAU.ln();
    assert!((sum - whole).abs() < 1e-3, "{sum} and {whole}");
}

/// A prediction includes the uncertainty of an inaccurate parameter; after a few epochs the parameter is known.
#[test]
fn what_is_not_known_is_learnt() {
    let run = turned();
    let fit = fitted(&run.clone().leaving_out(vec![SPAN]));
    let off = 20.0 * PPM;
    let scale = fit.models[0].value("gyro.scale.z").unwrap();
    let wrong = fit.models[0].clone().with_value("gyro.scale.z", scale + off);
    let place = wrong.terms.iter().position(|chosen| chosen.term.id == "gyro.scale").unwrap();
    let linear = linearise(&run, &wrong, &[(place, 2)]);
    let held = |samples: &Range<usize>| samples.start >= SPAN.start && samples.end <= SPAN.end;
    let predicted = |sigma: f64| {
        let variance = DMatrix::from_element(1, 1, sigma * sigma);
        let mut known = ParameterPosterior::new(DVector::zeros(1), variance);
        known.predict(&linear, &fit.noise[0], &[0], held).unwrap()
    };
    let mean = |told: &[EpochPrediction]| {
        let squares: f64 = told.iter().map(|one| one.innovation.norm_squared()).sum();
        squares / told.len() as f64
    };
    let density = |told: &[EpochPrediction]| told.iter().map(|one| one.log_density).sum::<f64>();
    let (sure, unsure) = (predicted(0.01 * PPM), predicted(off));
    assert!(density(&unsure) > density(&sure) + 100.0, "{} {}", density(&unsure), density(&sure));
    // Six measurements per epoch: the innovations agree with the prediction, which they do not if the parameter is assumed
    // known.
    assert!((mean(&unsure) - 6.0).abs() < 1.0, "{}", mean(&unsure));
    assert!(mean(&sure) > 12.0, "{}", mean(&sure));
}

/// A wrong parameter predicts held-out data worse than the correct one.
#[test]
fn right_parameters_foretell_best() {
    let run = turned();
    let fit = fitted(&run.clone().leaving_out(vec![SPAN]));
    let density = |model: &Model| {
        let linear = linearise(&run, model, &[]);
        let held = |samples: &Range<usize>| samples.start >= SPAN.start && samples.end <= SPAN.end;
        let mut known = ParameterPosterior::new(DVector::zeros(0), DMatrix::zeros(0, 0));
        let predicted = known.predict(&linear, &fit.noise[0], &[], held).unwrap();
        predicted.iter().map(|one| one.log_density).sum::<f64>()
    };
    let right = density(&fit.models[0]);
    let scale = fit.models[0].value("gyro.scale.z").unwrap();
    let wrong = density(&fit.models[0].clone().with_value("gyro.scale.z", scale + 5.0 * PPM));
    assert!(right > wrong + 10.0, "{right} against {wrong}");
}

/// Samples are lost while the table changes its rate, and the rates of the next sample are held over the gap.
#[test]
fn lost_samples_put_nothing_off() {
    let run = turned();
    let whole = fitted(&run);
    let mut lossy = run.clone();
    let recording = Arc::make_mut(&mut lossy.recording);
    // In the ramps, from the last on: earlier indices do not change.
    for first in [2286, 1290, 1280, 255] {
        let lost = first..first + 3;
        let lasting: f64 = recording.increments[lost.clone()].iter().map(|one| one.interval).sum();
        let after = &mut recording.increments[lost.end];
        let longer = 1.0 + lasting / after.interval;
        after.angle = after.angle * longer;
        after.velocity = after.velocity * longer;
        after.interval += lasting;
        recording.increments.drain(lost.clone());
        recording.times.drain(lost.clone());
        recording.table_angle.as_mut().unwrap().drain(lost.clone());
        recording.temperature.as_mut().unwrap().drain(lost);
    }
    let without = fitted(&lossy);
    let moved = apart(&whole, &without);
    assert!(moved < 1.0, "{moved} sigma");
    let squares = without.innovations(0).iter().map(nalgebra::Matrix::norm_squared).sum::<f64>();
    let mean = squares / without.innovations(0).len() as f64;
    assert!((5.0..7.0).contains(&mean), "{mean}");
}
