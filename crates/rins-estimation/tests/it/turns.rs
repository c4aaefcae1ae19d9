//! Rotations between static intervals, and the drift of the biases from one to the next.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use rins_estimation::{
    Fit, InSequence, NoiseKnowledge, NoiseParameters, Reference, Run, StatedTurn, Turn, fit,
};
use rins_frames::units::{DEG, DEG_PER_HOUR, PPM};
use rins_frames::{Dcm, EulerAngles, InFrame, Increments, Nav, Table};
use rins_imu::{ImuError, ImuSpec, Seed, Sensor, TriadError};
use rins_motion::Recording;
use rins_terms::{Model, Owner, Role};

use crate::mountings::{drawn_from, truth};
use crate::rests::{ANY, handheld};
use crate::support::{profile, run, scenario, station, white};

/// The sampling interval of a rotation, and its duration \[s\].
const INTERVAL: f64 = 0.01;
const LASTING: f64 = 3.0;

fn consumer() -> ImuSpec {
    handheld(20.0 * DEG_PER_HOUR, 10_000.0 * PPM)
}

fn drawn(seed: u64) -> ImuError {
    drawn_from(&consumer(), seed)
}

/// The gyros' readings while the IMU turns by `whole` turns more than the shortest way about a constant axis, from one attitude to
/// the other.
fn readings(
    from: &Dcm<Nav, Table>,
    to: &Dcm<Nav, Table>,
    whole: f64,
    gyro: &TriadError,
    seed: u64,
) -> Recording {
    let mut random = Seed::new(seed).stream(Sensor::Encoder);
    let shortest = (from.inverse() * *to).rotation_vector();
    let angle = shortest
        + if whole == 0.0 {
            Vector3::zeros()
        } else {
            Vector3::z() * (whole * std::f64::consts::TAU)
        };
    let earth_rate = station().site.earth_rate();
    let noise = consumer().gyro.noise_density / INTERVAL.sqrt();
    let samples = (LASTING / INTERVAL).round();
    let share = |count: f64| 0.5 - 0.5 * (std::f64::consts::PI * count / samples).cos();
    let steps = (0..300_u32).map(|count| {
        let count = f64::from(count);
        let turned =
            *from * Dcm::<Table, Table>::from_rotation_vector(&(angle * share(count + 0.5)));
        let rate = angle * ((share(count + 1.0) - share(count)) / INTERVAL)
            + (turned.inverse() * earth_rate).components();
        let white = Vector3::from_fn(|_, _| noise * random.sample());
        let read = (Matrix3::identity() + gyro.matrix) * rate + gyro.bias + white;
        Increments {
            angle: InFrame::from_components(read * INTERVAL),
            velocity: InFrame::new(0.0, 0.0, 9.8 * INTERVAL),
            interval: INTERVAL,
        }
    });
    let increments: Vec<Increments> = steps.collect();
    let times = (1..=300_u32).map(|count| INTERVAL * f64::from(count)).collect();
    Recording { times, increments, ..Recording::default() }
}

/// Static intervals of five seconds in these attitudes, with the rotations between them; the assumed attitudes are half a degree
/// off. `bias` is added to that of the gyros in each.
fn tumble(attitudes: &[Dcm<Nav, Table>], error: &ImuError, bias: &[f64], seed: u64) -> Vec<Run> {
    let rest = |(number, attitude): (usize, &Dcm<Nav, Table>)| {
        let mut error = *error;
        error.gyro.bias.add_scalar_mut(bias[number]);
        let seed = 100 * seed + number as u64;
        let still = profile(&[(0.0, 5.0)]);
        let effects = (error, Model::default());
        let mut run = run(&scenario(*attitude, still, effects, Some(white(&consumer())), seed));
        let mut recording = (*run.recording).clone();
        // Attitudes follow each other in time.
        recording.times.iter_mut().for_each(|time| *time += 8.0 * number as f64);
        run.recording = Arc::new(recording);
        let off = Vector3::new(8e-3, -5e-3, 3e-3);
        run.rig.nav_from_table = *attitude * Dcm::<Table, Table>::from_rotation_vector(&off);
        run.rig.reference = Reference::Rest;
        let turn = number.checked_sub(1).map(|before| {
            let recording = readings(&attitudes[before], attitude, 0.0, &error.gyro, seed);
            Turn { recording: Arc::new(recording), stated: None }
        });
        run.since(0).in_sequence(InSequence { number, turn })
    };
    attitudes.iter().enumerate().map(rest).collect()
}

/// Twelve attitudes on all sides.
fn attitudes(seed: u64) -> Vec<Dcm<Nav, Table>> {
    let mut random = Seed::new(seed).stream(Sensor::Encoder);
    let mut attitude = || EulerAngles {
        roll: 60.0 * DEG * random.sample(),
        pitch: 40.0 * DEG * random.sample(),
        yaw: 60.0 * DEG * random.sample(),
    };
    (0..12).map(|_| attitude().dcm()).collect()
}

fn fitted(runs: &[Run], knowledge: NoiseKnowledge) -> Fit {
    let model = ["x", "y", "z"].iter().fold(Model::full(), |model, axis| {
        model.with_role(&format!("axis.attitude.{axis}"), Role::Within(ANY))
    });
    fit(runs, &model, &consumer(), knowledge, |_| ())
        .unwrap()
        .marginal(|estimate| estimate.parameter.owner != Owner::Placement)
}

/// The squares of the errors of some parameters, in sigmas.
fn squares(fit: &Fit, error: &ImuError, ids: &[&str]) -> Vec<f64> {
    let square = |id: &&str| {
        let estimate = fit.parameter(id).unwrap();
        ((estimate.value - truth(error, id).unwrap()) / estimate.sigma).powi(2)
    };
    ids.iter().map(square).collect()
}

const SCALES: [&str; 3] = ["gyro.scale.x", "gyro.scale.y", "gyro.scale.z"];
const BIASES: [&str; 3] = ["gyro.bias.x", "gyro.bias.y", "gyro.bias.z"];

#[test]
fn rotations_between_rests_show_the_scales_of_the_gyros() {
    let sheet = NoiseParameters::of(&consumer());
    let of_imu = |seed: u64| {
        let error = drawn(seed);
        let fit = fitted(
            &tumble(&attitudes(seed), &error, &[0.0; 12], seed),
            NoiseKnowledge::Likely(sheet),
        );
        for id in SCALES {
            let estimate = fit.parameter(id).unwrap();
            assert!(10.0 * estimate.sigma < estimate.parameter.sigma, "{seed}: {estimate:?}");
        }
        squares(&fit, &error, &SCALES)
    };
    let all: Vec<f64> = (0..20_u64).into_par_iter().flat_map_iter(of_imu).collect();
    let sum: f64 = all.iter().sum();
    // Chi-square of 60: 1e-5 of it is below 23, and 1e-5 above 118.
    assert!(23.0 < sum && sum < 118.0, "{sum} of {}", all.len());
}

#[test]
fn a_stated_angle_shows_the_scale_where_gravity_does_not() {
    let mut error = ImuError::default();
    error.gyro.matrix[(2, 2)] = -19_400.0 * PPM;
    let level = EulerAngles { roll: 0.0, pitch: 0.0, yaw: 0.4 }.dcm();
    let mut runs = tumble(&[level; 2], &error, &[0.0; 2], 3);
    let angle = 2.0 * std::f64::consts::TAU;
    let turned = |sigma: f64| {
        let recording = Arc::new(readings(&level, &level, 2.0, &error.gyro, 9));
        let stated = Some(StatedTurn { angle, sigma, mark: 0.0 });
        InSequence { number: 1, turn: Some(Turn { recording, stated }) }
    };
    let sheet = NoiseKnowledge::Given(NoiseParameters::of(&consumer()));
    for sigma in [0.2 * DEG, 2.0 * DEG] {
        runs[1].in_sequence = Some(turned(sigma));
        let fit = fitted(&runs, sheet);
        let scale = fit.parameter("gyro.scale.z").unwrap();
        assert!((scale.value + 19_400.0 * PPM).abs() < 4.0 * scale.sigma, "{scale:?}");
        assert!((0.9..2.0).contains(&(scale.sigma / (sigma / angle))), "{scale:?}");
    }
    // Without the angle the rotation about the vertical shows nothing.
    if let Some(InSequence { turn: Some(turn), .. }) = &mut runs[1].in_sequence {
        turn.stated = None;
    }
    let scale = fitted(&runs, sheet).parameter("gyro.scale.z").unwrap().sigma;
    assert!(scale > 0.9 * consumer().gyro.scale_sigma, "{scale}");
}

#[test]
fn biases_that_drift_between_rests_are_as_uncertain_as_they_are() {
    // A random walk of 60 deg/h in the time between two intervals.
    let walk = 60.0 * DEG_PER_HOUR / 8.0_f64.sqrt();
    let imu = consumer();
    let mut sheet = NoiseParameters::of(&imu);
    sheet.gyro.walk = walk;
    let of_imu = |seed: u64| {
        let error = drawn(seed);
        let mut random = Seed::new(1000 + seed).stream(Sensor::Encoder);
        let mut bias = 0.0;
        let biases: Vec<f64> = (0..12)
            .map(|number| {
                bias += if number > 0 { walk * 8.0_f64.sqrt() * random.sample() } else { 0.0 };
                bias
            })
            .collect();
        let runs = tumble(&attitudes(seed), &error, &biases, seed);
        // The bias is that of the first interval, at which the walk begins.
        squares(&fitted(&runs, NoiseKnowledge::Given(sheet)), &error, &BIASES)
    };
    let with: Vec<f64> = (0..20_u64).into_par_iter().flat_map_iter(of_imu).collect();
    let sum: f64 = with.iter().sum();
    // The same drift about every axis: 20 independent values, of which chi-square is between 4.1 and 57 but for 1e-5.
    assert!(3.0 * 4.1 < sum && sum < 3.0 * 57.0, "{sum}");
}
