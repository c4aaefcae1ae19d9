//! Errors that depend on temperature refer to the model's reference temperature, at any temperature of a run.

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;
use rins_estimation::{Estimate, Fit, NoiseKnowledge, NoiseParameters, Run, fit};
use rins_frames::units::{DEG_PER_HOUR, PPM};
use rins_imu::{ImuError, Seed, Sensor};
use rins_simulation::Temperature;
use rins_terms::{Model, Role, TermInstance, catalogue};

use crate::mountings::{drawn, truth};
use crate::support::{fibre, profile, run, scenario, tilted, white};

/// The number of IMUs, each drawn from its data sheet, with runs at random temperatures.
const IMUS: u64 = 200;

/// 1σ of the temperature coefficients of a gyro's bias and of its scale factor.
const BIAS_PER_KELVIN: f64 = 0.02 * DEG_PER_HOUR;
const SCALE_PER_KELVIN: f64 = 10.0 * PPM;

fn within(chosen: TermInstance, sigma: f64) -> TermInstance {
    let roles = vec![Role::Within(sigma); chosen.values.len()];
    TermInstance { roles, ..chosen }
}

/// The model, with its reference temperature \[°C\].
fn model(reference: f64) -> Model {
    Model::full()
        .with(within(TermInstance::new(&catalogue::GYRO_THERMAL_BIAS), BIAS_PER_KELVIN))
        .with(within(TermInstance::new(&catalogue::GYRO_THERMAL_SCALE), SCALE_PER_KELVIN))
        .about_temperature(reference)
}

/// The errors of an IMU in each of two runs, its coefficients at a reference temperature, and the runs at other temperatures.
struct Drawn {
    errors: [ImuError; 2],
    coefficients: [f64; 4],
    reference: f64,
    runs: Vec<Run>,
}

fn drawn_runs(seed: u64) -> Drawn {
    let mut random = Seed::new(seed ^ 0x7e_3b).stream(Sensor::Encoder);
    let first = drawn(seed);
    // There is a power cycle in between.
    let mut second = drawn(seed + 10 * IMUS);
    (second.gyro.matrix, second.accel.matrix) = (first.gyro.matrix, first.accel.matrix);
    let errors = [first, second];
    let mut coefficient = |sigma: f64| sigma * random.sample();
    let mut coefficients = [BIAS_PER_KELVIN; 4].map(&mut coefficient);
    coefficients[3] *= SCALE_PER_KELVIN / BIAS_PER_KELVIN;
    let mut temperature = || (15.0 + 25.0 * random.sample()).clamp(-40.0, 85.0);
    let reference = temperature();
    let effects = Model::default()
        .with(TermInstance::new(&catalogue::GYRO_THERMAL_BIAS).with_values(&coefficients[..3]))
        .with(TermInstance::new(&catalogue::GYRO_THERMAL_SCALE).with_values(&coefficients[3..]))
        .about_temperature(reference);
    let runs = (0..2_u64)
        .zip(errors)
        .map(|(place, error)| {
            let (start, noise) = (temperature(), Some(white(&fibre())));
            let rate = (temperature() - start) / 3600.0;
            let turns = profile(&[(0.0, 10.0), (12.0, 35.0), (-12.0, 35.0)]);
            let stand = tilted(20.0 + 30.0 * place as f64, 100.0 * place as f64);
            let truth = (error, effects.clone());
            let mut scenario = scenario(stand, turns, truth, noise, 2 * seed + place);
            scenario.temperature = Some(Temperature::Ramp { start, rate });
            run(&scenario)
        })
        .collect();
    Drawn { errors, coefficients, reference, runs }
}

fn fitted(drawn: &Drawn, reference: f64) -> Fit {
    let imu = fibre();
    let known = NoiseKnowledge::Given(NoiseParameters::of(&imu));
    fit(&drawn.runs, &model(reference), &imu, known, |_| ()).unwrap()
}

/// The true value of a parameter.
fn true_value(drawn: &Drawn, id: &str, run: Option<usize>) -> Option<f64> {
    let thermal = ["gyro_thermal_bias.x", "gyro_thermal_bias.y", "gyro_thermal_bias.z"];
    let place = thermal.iter().position(|of| *of == id);
    match place.or((id == "gyro_thermal_scale.z").then_some(3)) {
        Some(place) => Some(drawn.coefficients[place]),
        None => truth(&drawn.errors[run.unwrap_or(0)], id),
    }
}

/// The sum of squared errors normalized by the covariance, and the number of values; in units of the priors.
fn squares(fit: &Fit, drawn: &Drawn) -> (f64, usize) {
    let of = |(place, estimate): (usize, &Estimate)| {
        let value = true_value(drawn, &estimate.parameter.id, estimate.run)?;
        Some((place, (estimate.value - value) / estimate.parameter.sigma))
    };
    let off: Vec<(usize, f64)> = fit.parameters.iter().enumerate().filter_map(of).collect();
    let sigma = |row: usize| fit.parameters[off[row].0].parameter.sigma;
    let covariance = DMatrix::from_fn(off.len(), off.len(), |row, column| {
        fit.covariance[(off[row].0, off[column].0)] / (sigma(row) * sigma(column))
    });
    let vector = DVector::from_iterator(off.len(), off.iter().map(|(_, off)| *off));
    (vector.dot(&Cholesky::new(covariance).unwrap().solve(&vector)), off.len())
}

#[test]
fn runs_at_any_temperature_are_joined_at_the_reference_temperature() {
    let of = |seed: u64| {
        let drawn = drawn_runs(seed);
        squares(&fitted(&drawn, drawn.reference), &drawn)
    };
    let all: Vec<(f64, usize)> = (0..IMUS).into_par_iter().map(of).collect();
    let sum: f64 = all.iter().map(|(squares, _)| squares).sum();
    let figures = all.iter().map(|(_, figures)| figures).sum::<usize>() as f64;
    let off = (sum - figures) / (2.0 * figures).sqrt();
    assert!(off.abs() < 4.0, "{sum} of {figures} figures: {off} sigma");
}

/// Estimates from the same data at two reference temperatures differ by the coefficient times the temperature difference.
#[test]
fn a_scale_error_moves_with_the_reference_temperature_by_its_coefficient() {
    let drawn = drawn_runs(11);
    let [cold, warm] = [0.0, 50.0].map(|reference| fitted(&drawn, reference));
    let value = |fit: &Fit, id: &str| fit.parameter(id).unwrap().value;
    let per_kelvin = value(&cold, "gyro_thermal_scale.z");
    let moved = value(&warm, "gyro.scale.z") - value(&cold, "gyro.scale.z");
    let sigma = warm.parameter("gyro.scale.z").unwrap().sigma;
    // The priors refer to the reference temperature, so that the estimates are not exactly equal.
    assert!((moved - 50.0 * per_kelvin).abs() < 3.0 * sigma, "{moved} {per_kelvin} {sigma}");
    assert!(per_kelvin.abs() * 50.0 > 50.0 * sigma, "{per_kelvin} {sigma}");
}
