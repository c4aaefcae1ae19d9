//! Unobservable parameters keep their prior values, and the covariance of the others is consistent.

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;
use rins_estimation::{Fit, NoiseKnowledge, NoiseParameters, Run, fit};
use rins_imu::ImuError;
use rins_terms::{Model, Owner};

use crate::mountings::{drawn, truth};
use crate::support::{fibre, profile, run, scenario, tilted, white};

/// The number of IMUs, each drawn from its data sheet.
pub(crate) const IMUS: u64 = 200;

/// One of four schedules, on an axis with a tilt of 3 to 60 deg.
pub(crate) fn turned(error: &ImuError, seed: u64) -> Run {
    let rate = 5.0 + (seed % 7) as f64 * 4.0;
    let schedule = match seed % 4 {
        0 => vec![(rate, 60.0)],
        1 => vec![(0.0, 20.0), (rate, 60.0)],
        2 => vec![(rate, 40.0), (-rate, 40.0)],
        _ => vec![(rate, 40.0), (-0.5 * rate, 40.0)],
    };
    let stand = tilted(3.0 + (seed % 20) as f64 * 3.0, (seed % 360) as f64);
    let noise = Some(white(&fibre()));
    run(&scenario(stand, profile(&schedule), (*error, Model::default()), noise, seed))
}

pub(crate) fn fitted(run: &Run) -> Fit {
    let imu = fibre();
    let known = NoiseKnowledge::Given(NoiseParameters::of(&imu));
    fit(std::slice::from_ref(run), &Model::full(), &imu, known, |_| ()).unwrap()
}

/// The sum of squared errors normalized by their covariance, and the number of values.
fn squares(fit: &Fit, error: &ImuError) -> (f64, usize) {
    let of_sensors = |&place: &usize| fit.parameters[place].parameter.owner != Owner::Placement;
    let places: Vec<usize> = (0..fit.parameters.len()).filter(of_sensors).collect();
    let errors: Vec<(usize, f64)> = places
        .into_iter()
        .filter_map(|place| {
            let estimate = &fit.parameters[place];
            Some((place, estimate.value - truth(error, &estimate.parameter.id)?))
        })
        .collect();
    // In units of the priors, so that rounding does not make it indefinite.
    let unit = |row: usize| fit.parameters[errors[row].0].parameter.sigma;
    let covariance = DMatrix::from_fn(errors.len(), errors.len(), |row, column| {
        fit.covariance[(errors[row].0, errors[column].0)] / (unit(row) * unit(column))
    });
    let off = DVector::from_fn(errors.len(), |row, _| errors[row].1 / unit(row));
    let solved = Cholesky::new(covariance).unwrap().solve(&off);
    (off.dot(&solved), errors.len())
}

#[test]
fn what_is_not_observable_keeps_its_expected_value_and_its_prior_sigma() {
    let per_imu: Vec<(f64, usize, usize)> = (0..IMUS)
        .into_par_iter()
        .map(|seed| {
            let error = drawn(seed);
            let fit = fitted(&turned(&error, seed));
            let identifiability = fit.identifiability();
            let unobservable = identifiability.unobservable();
            let kept = fit.clone().with_prior_values_at(&unobservable);
            for &place in &unobservable {
                let estimate = &kept.parameters[place];
                assert_eq!(estimate.value.to_bits(), estimate.expected.to_bits(), "{estimate:?}");
                assert_close(estimate.sigma, estimate.parameter.sigma);
                let here = kept.in_run(estimate, 0).unwrap();
                let in_model = kept.models[0].terms[here.term].values[here.parameter];
                assert_eq!(in_model.to_bits(), estimate.expected.to_bits(), "{estimate:?}");
            }
            for (place, seen) in identifiability.parameters.iter().enumerate() {
                // Observable parameters hardly depend on unobservable ones.
                let (before, after) =
                    (fit.sum(place, &seen.aliases), kept.sum(place, &seen.aliases));
                if seen.identifiable {
                    let moved = (after.0 - before.0).abs() / before.1;
                    assert!(moved < 3.0, "{}: {moved} sigma", identifiability.unknowns[place].id);
                }
            }
            let (squares, figures) = squares(&kept, &error);
            (squares, figures, unobservable.len())
        })
        .collect();
    let squares: f64 = per_imu.iter().map(|(squares, ..)| squares).sum();
    let figures = per_imu.iter().map(|(_, figures, _)| figures).sum::<usize>() as f64;
    assert!(per_imu.iter().all(|(.., unobservable)| *unobservable > 0));
    let off = (squares - figures) / (2.0 * figures).sqrt();
    assert!(off.abs() < 4.0, "{squares} of {figures} figures: {off} sigma");
}

fn assert_close(value: f64, want: f64) {
    assert!((value / want - 1.0).abs() < 1e-12, "{value} is not {want}");
}
