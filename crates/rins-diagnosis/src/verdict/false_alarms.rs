//! How often the whole diagnosis names something in simulated runs without an effect.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use rins_estimation::{Fit, Noise, NoiseKnowledge, Run, TriadStrengths};
use rins_imu::{ImuNoise, ImuSpec, NoiseModel, Seed, Sensor, Span};
use rins_motion::Recording;
use rins_terms::{Model, Track};

use crate::diagnosis::{DiagnosisError, diagnose};
use crate::prediction::overlay::{along, readings};

/// In how many of so many simulated experiments [`diagnose`] names an effect, or reports residual structure, that is not there.
///
/// Each experiment has the motion, the model and the noise of `fit`, with noise drawn anew, and is diagnosed as the measured one with
/// the model of the fit. The base is at rest, and timing jitter of the encoder is part of its noise at the rate of each sample.
/// `progress` is told after each how many are done.
///
/// # Errors
/// [`DiagnosisError`] if a simulated experiment cannot be diagnosed.
pub fn false_alarms(
    runs: &[Run],
    fit: &Fit,
    (imu, knowledge): (&ImuSpec, NoiseKnowledge),
    (draws, seed): (u32, Seed),
    progress: impl Fn(usize) + Sync,
) -> Result<u32, DiagnosisError> {
    let of_run = |draw: u32, place: usize| {
        let run = seed.run + u64::from(draw) * runs.len() as u64 + place as u64;
        Seed { run, ..seed }
    };
    let motions: Vec<(Model, Track)> =
        runs.iter().enumerate().map(|(place, run)| along(run, fit, place)).collect();
    let done = AtomicUsize::new(0);
    let of_draw = |draw: u32| {
        let simulated: Vec<Run> = (0..runs.len())
            .map(|place| {
                let noise = &fit.noise[place];
                simulated(&runs[place], &motions[place], noise, of_run(draw, place))
            })
            .collect::<Result<_, _>>()?;
        let diagnosis = diagnose(&simulated, fit.model(), imu, knowledge, |_| ())?;
        progress(1 + done.fetch_add(1, Ordering::Relaxed));
        let is_alarm = !diagnosis.causes.is_empty() || !diagnosis.unexplained.is_empty();
        Ok(u32::from(is_alarm))
    };
    (0..draws).into_par_iter().map(of_draw).sum()
}

/// A run with the model and the motion of a fit and noise drawn anew.
fn simulated(
    run: &Run,
    (model, track): &(Model, Track),
    noise: &Noise,
    seed: Seed,
) -> Result<Run, DiagnosisError> {
    let recording = &run.recording;
    let (first, last) = (recording.times[0], recording.times[recording.len() - 1]);
    let span = Span { interval: recording.mean_interval(), duration: last - first };
    let of = |of: &TriadStrengths| NoiseModel {
        bias_random_walk: of.walk,
        flicker: (of.flicker > 0.0).then_some(of.flicker),
        ..NoiseModel::white(of.white)
    };
    let of_imu = ImuNoise { gyro: of(&noise.imu.gyro), accel: of(&noise.imu.accel) };
    let mut source = of_imu.source(&span, seed)?;
    let mut of_encoder = seed.stream(Sensor::Encoder);
    let white = run.angle_steps.map_or(noise.encoder, |steps| steps.blur * steps.step);
    let ends = track.angles().iter().skip(1).zip(track.moments());
    let read = readings(model, track).zip(ends).map(|((reading, error), (angle, moment))| {
        let jitter = noise.imu.jitter * moment.end.rate;
        let angle = angle + error + white.hypot(jitter) * of_encoder.sample();
        let angle =
            run.angle_steps.map_or(angle, |steps| (angle / steps.step).round() * steps.step);
        (source.corrupt(&reading), angle)
    });
    let (increments, angles) = read.unzip();
    let table_angle = recording.table_angle.is_some().then_some(angles);
    let recording = Recording { increments, table_angle, ..Recording::clone(recording) };
    Ok(Run { recording: Arc::new(recording), ..run.clone() })
}
