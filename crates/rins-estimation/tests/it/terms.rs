//! Every effect of the catalogue: simulated, and recovered by the estimator.

use rayon::prelude::*;
use rins_estimation::{NoiseKnowledge, NoiseParameters, Run, fit, joint};
use rins_imu::ImuError;
use rins_terms::{Model, Role, SettingKind, Term, TermInstance, catalogue};

use crate::support::{fibre, profile, run, scenario, tilted, white};

/// Choices of a frame, which are unobservable together with the alternative choice.
const GAUGES: [&str; 3] = ["mounting", "encoder.zero", "wrong_gravity"];

/// The size of a simulated effect, in sigmas of its predicted uncertainty.
const STRENGTH: f64 = 20.0;

/// The tolerance of an estimate, in sigmas: one of 200 values exceeds it by chance once in 80 catalogues.
const WITHIN: f64 = 4.0;

/// Two tilts and azimuths, three rates in both directions.
fn runs(effects: &Model, seed: Option<u64>) -> Vec<Run> {
    let turns =
        [(0.0, 12.0), (10.0, 40.0), (-10.0, 40.0), (30.0, 20.0), (-30.0, 20.0), (20.0, 20.0)];
    let noise = seed.map(|_| white(&fibre()));
    let at = |tilt, yaw, place| {
        let truth = (ImuError::default(), effects.clone());
        let seed = seed.unwrap_or(0) * 10 + place;
        run(&scenario(tilted(tilt, yaw), profile(&turns), truth, noise.clone(), seed))
    };
    vec![at(25.0, 0.0, 1), at(70.0, 120.0, 2)]
}

/// The predicted 1σ of each parameter of a term in addition to the full model, or `None` if it is prior-dominated.
fn foreseen(chosen: &TermInstance, runs: &[Run]) -> Vec<Option<f64>> {
    let imu = fibre();
    let strengths = NoiseParameters::of(&imu);
    let model = Model::full().with(chosen.clone());
    let joint = joint(runs, &model, &imu, &strengths).unwrap();
    let sigmas: Vec<f64> = joint.unknowns.iter().map(|unknown| unknown.sigma).collect();
    let posterior = joint.evidence.posterior(&sigmas, &vec![0.0; sigmas.len()]).unwrap();
    let of_term = |id: &str| chosen.term.parameter_ids().any(|of_term| of_term == id);
    let first = joint.unknowns.iter().enumerate().filter(|(_, unknown)| unknown.run != Some(1));
    first
        .filter(|(_, unknown)| of_term(&unknown.id))
        .map(|(place, unknown)| {
            let sigma = posterior.sigma(place);
            (sigma < 0.3 * unknown.sigma).then_some(sigma)
        })
        .collect()
}

/// The term for the simulation: its event within the run, and at a point where its derivative is not zero.
fn shaped(term: &'static Term) -> TermInstance {
    let imu = fibre();
    let mut chosen = TermInstance::new(term)
        .with_setting(SettingKind::Time, 70.0)
        .with_setting(SettingKind::TimeConstant, 40.0);
    for (role, parameter) in chosen.roles.iter_mut().zip(term.parameters) {
        // A wider prior than usual: an unobservable parameter must not seem observable because of its prior.
        *role = Role::Within(30.0 * parameter.sigma(&imu));
    }
    if term.id == "gyro_dead_zone" {
        // The derivative for a width of zero is zero.
        let start: Vec<f64> = term.parameters.iter().map(|p| p.range(&imu).1).collect();
        chosen = chosen.with_values(&start);
    }
    chosen
}

/// The errors of the estimates of a term with a size of `STRENGTH` sigmas, and the number of tested parameters.
fn faults(term: &'static Term, seed: u64) -> (usize, Vec<String>) {
    let chosen = shaped(term);
    let foreseen = foreseen(&chosen, &runs(&Model::default(), None));
    let mut made = chosen.clone();
    let mut estimated = chosen;
    for (place, sigma) in foreseen.iter().enumerate() {
        match sigma {
            Some(sigma) => {
                // Both signs, except where the first derivative was calculated.
                let sign = if place % 2 == 0 { 1.0 } else { -1.0 };
                made.values[place] += sign * STRENGTH * sigma;
                // Wide enough for the simulated value, and otherwise as in the prediction.
                if let Role::Within(prior) = &mut estimated.roles[place] {
                    *prior = prior.max(5.0 * STRENGTH * sigma);
                }
            }
            None => estimated.roles[place] = Role::Held,
        }
    }
    let imu = fibre();
    let truth = made.values.clone();
    let runs = runs(&Model::default().with(made), Some(seed));
    let model = Model::full().with(estimated.clone());
    let strengths = NoiseParameters::of(&imu);
    let fit = match fit(&runs, &model, &imu, NoiseKnowledge::Given(strengths), |_| ()) {
        Ok(fit) => fit,
        Err(error) => return (1, vec![format!("{}: {error}", term.id)]),
    };
    let mut faults = Vec::new();
    let mut looked_at = 0;
    for estimate in &fit.parameters {
        if estimate.parameter.term + 1 != model.terms.len() {
            continue;
        }
        looked_at += 1;
        let place = estimate.parameter.parameter;
        let off = (estimate.value - truth[place]) / estimate.sigma;
        let strength = (truth[place] - estimated.values[place]) / estimate.sigma;
        // The prediction is for the parameters of the first run.
        let weak = estimate.run != Some(1) && strength.abs() < 0.5 * STRENGTH;
        if off.abs() > WITHIN || weak {
            let id = &estimate.parameter.id;
            faults.push(format!("{id}: {off:.1} sigma off, made {strength:.1} strong"));
        }
    }
    (looked_at, faults)
}

#[test]
fn every_effect_is_found_as_it_was_made() {
    let signals: Vec<&'static Term> = catalogue::CATALOGUE
        .iter()
        .copied()
        .filter(|term| term.is_signal() && !GAUGES.contains(&term.id))
        .filter(|term| !Model::full().terms.iter().any(|chosen| chosen.term.id == term.id))
        .collect();
    assert!(signals.len() > 35, "the catalogue holds {} effects", signals.len());
    let found: Vec<(&str, usize, Vec<String>)> = signals
        .par_iter()
        .enumerate()
        .map(|(seed, term)| {
            let (looked_at, faults) = faults(term, seed as u64 + 1);
            (term.id, looked_at, faults)
        })
        .collect();
    let faults: Vec<&String> = found.iter().flat_map(|(_, _, faults)| faults).collect();
    assert!(faults.is_empty(), "{faults:#?}");
    let unseen: Vec<&str> = found.iter().filter(|f| f.1 == 0).map(|f| f.0).collect();
    assert_eq!(unseen, ["table_rate_ripple"], "effects of which this schedule shows nothing");
}
