//! Consistency of estimates with their priors: no departures for sensors that agree with the data sheet, and departures for
//! others.

use rayon::prelude::*;
use rins_estimation::{Departure, NoiseParameters, Quantity};
use rins_imu::ImuError;

use crate::mountings::drawn;
use crate::support::fibre;
use crate::unobservable::{IMUS, fitted, turned};

fn departures(error: &ImuError, seed: u64) -> Vec<(String, Departure)> {
    let fit = fitted(&turned(error, seed));
    let identifiability = fit.identifiability();
    let named = |departure: Departure| match departure.of {
        Quantity::Parameter(place) => (identifiability.unknowns[place].id.clone(), departure),
        of => (format!("{of:?}"), departure),
    };
    fit.prior_departures(&identifiability, &NoiseParameters::of(&fibre()))
        .into_iter()
        .map(named)
        .collect()
}

#[test]
fn sensors_as_their_sheet_says_depart_as_often_as_chance_has_it() {
    let all: Vec<f64> = (0..IMUS)
        .into_par_iter()
        .flat_map_iter(|seed| departures(&drawn(seed), seed))
        .filter(|(_, departure)| matches!(departure.of, Quantity::Parameter(_)))
        .map(|(_, departure)| departure.sigmas)
        .collect();
    let mean = all.iter().map(|sigmas| sigmas * sigmas).sum::<f64>() / all.len() as f64;
    // Combinations have common parts, so that not all are independent: a fifth of them is assumed to be.
    let scatter = (2.0 / (0.2 * all.len() as f64)).sqrt();
    assert!((mean - 1.0).abs() < 4.0 * scatter, "mean square {mean} of {}", all.len());
    // Of fifteen thousand normal values one exceeds four; here there are some thousand.
    let far = all.iter().filter(|sigmas| sigmas.abs() > 4.0).count();
    assert!(far <= 3 && all.len() > 2000, "{far} of {}", all.len());
}

/// An error of eight stated sigmas is detected if the schedule makes it observable, alone or in a combination.
#[test]
fn errors_far_beyond_the_sheet_are_found() {
    let found: Vec<bool> = (0..IMUS)
        .into_par_iter()
        .map(|seed| {
            let mut error = drawn(seed);
            let (sheet, sign) = (fibre(), if seed % 2 == 0 { 8.0 } else { -8.0 });
            let wrong = match seed % 5 {
                0 => {
                    error.gyro.matrix[(2, 2)] = sign * sheet.gyro.scale_sigma;
                    "gyro.scale.z"
                }
                1 => {
                    error.gyro.matrix[(0, 2)] = sign * sheet.gyro.misalignment_sigma;
                    "gyro.misalignment.xz"
                }
                2 => {
                    error.gyro.matrix[(1, 2)] = sign * sheet.gyro.misalignment_sigma;
                    "gyro.misalignment.yz"
                }
                3 => {
                    error.accel.matrix[(2, 2)] = 3.0 * sign * sheet.accel.scale_sigma;
                    "accel."
                }
                _ => {
                    error.accel.bias[0] = 3.0 * sign * sheet.accel.bias_sigma;
                    "accel."
                }
            };
            let departed = |(id, departure): &(String, Departure)| {
                id.starts_with(wrong) && departure.sigmas.abs() > 4.0
            };
            departures(&error, seed).iter().any(departed)
        })
        .collect();
    let missed = found.iter().filter(|found| !**found).count();
    assert_eq!(missed, 0, "of {IMUS}");
}
