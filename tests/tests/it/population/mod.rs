//! Calibrations of a population of simulated runs: are they answered, and are the errors those that the sigmas state?
//!
//! The simulation shares no code with `rins`: quaternions on the rotating Earth, normal gravity, five grades of IMUs with
//! biases, scale errors, misalignments, noise, drift and rounding, all axis orders, and 20 Hz to 1 kHz.
//!
//! The sigmas of combinations include terms of second order, half the square of a misalignment. These errors have the distribution of
//! the square of a normal variable: their root mean square is larger than most of them, and so are the sigmas.

mod files;
mod imu;
mod judge;
mod motion;
mod random;
mod run;
mod schedule;

use std::fmt::Write as _;
use std::ops::Range;

use imu::{Drift, Population};
use judge::Known;
use schedule::Kind;
use serde_json::Value;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::support::rins_in;

/// The population of the study.
const FULL: Population = Population {
    misalignment: 1.0,
    drifts: [
        &[Drift::None, Drift::Flicker, Drift::Walk],
        &[Drift::None, Drift::Flicker, Drift::Walk],
    ],
    length: 1.0,
    samples: 60_000.0,
};

/// The same with shorter runs.
const SHORT: Population = Population { length: 0.15, samples: 8_000.0, ..FULL };

/// The coverage factor of a 95 % interval.
const FACTOR: f64 = 1.959964;

/// The largest error in sigmas: one of 3000 independent errors exceeds it with a probability of 6e-6.
const LARGEST: f64 = 6.0;

/// The factor by which errors of second order reduce the sum of squares: it is 0.8 over the population.
const SMALLER: f64 = 0.8;

/// What a study found.
#[derive(Default)]
struct Study {
    /// The known values, each with its kind and a description of its run.
    known: Vec<(Kind, String, Known)>,
    /// Runs without a result, and the reasons.
    refused: String,
}

impl Study {
    fn of(population: Population, seeds: Range<u64>) -> Self {
        let mut study = Self::default();
        for (seed, kind) in seeds.zip(Kind::ALL.into_iter().cycle()) {
            let folder = tempfile::tempdir().unwrap();
            let truths = run::simulate(folder.path(), population, kind, seed);
            let arguments = format!("{} --json", run::arguments(kind));
            let finished = rins_in(folder.path(), &arguments);
            let run = format!("seed {seed}, {kind:?}, {truths}");
            if (finished.code, finished.err.as_str()) != (Some(0), "") {
                writeln!(study.refused, "{run}: {}", finished.err).unwrap();
            }
            if let Ok(result) = serde_json::from_str::<Value>(&finished.out) {
                let known = judge::known(&result, &truths);
                study.known.extend(known.into_iter().map(|known| (kind, run.clone(), known)));
            }
        }
        study
    }

    /// The fraction of 95 % intervals that contain the true value.
    fn coverage(&self, kind: Option<Kind>) -> f64 {
        let of_kind = |of: Kind| kind.is_none_or(|kind| kind == of);
        let all = self.known.iter().filter(|(of, ..)| of_kind(*of));
        let inside = all.clone().filter(|(.., known)| known.sigmas.abs() < FACTOR);
        inside.count() as f64 / all.count() as f64
    }

    /// The sum of squared errors in units of sigma, and their number.
    fn chi_square(&self) -> (f64, f64) {
        let squares = self.known.iter().map(|(.., known)| known.sigmas.powi(2));
        (squares.sum(), self.known.len() as f64)
    }

    /// Asserts that all runs have results, and that their errors are those of the sigmas: the sum of squares, and the largest.
    ///
    /// Errors of one run are correlated: in 200 runs, the variance of the sum of squares is 1.6 times that of independent errors.
    /// The bounds allow a factor of two, and errors of second order a smaller sum by [`SMALLER`].
    fn assert_consistent(&self) {
        assert!(self.refused.is_empty(), "{}", self.refused);
        let (square, count) = self.chi_square();
        let half = ChiSquared::new(0.5 * count).unwrap();
        let [low, high] = [1e-6, 1.0 - 1e-6].map(|p| 2.0 * half.inverse_cdf(p));
        let bounds = [SMALLER * low, high];
        let is_within = (bounds[0]..bounds[1]).contains(&square);
        let worst = self.worst();
        assert!(is_within, "{square} of {count} values is not within {bounds:?}\n{worst}");
        assert!(self.known.iter().all(|(.., known)| known.sigmas.abs() < LARGEST), "{worst}");
    }

    /// The largest errors, one in a line.
    fn worst(&self) -> String {
        let mut known: Vec<_> = self.known.iter().collect();
        known.sort_by(|a, b| b.2.sigmas.abs().total_cmp(&a.2.sigmas.abs()));
        known.iter().take(20).fold(String::new(), |mut text, (_, run, known)| {
            writeln!(text, "{run}: {known}").unwrap();
            text
        })
    }
}

#[test]
fn population_is_answered_and_its_errors_are_those_of_the_sigmas() {
    let study = Study::of(SHORT, 0..8);
    assert!(study.known.len() > 60, "{} known values", study.known.len());
    study.assert_consistent();
}

/// The coverage alone would not show a few errors of many sigmas.
#[test]
#[ignore = "takes ten minutes"]
fn intervals_of_a_population_have_their_coverage() {
    let study = Study::of(FULL, 0..200);
    let all = study.coverage(None);
    let kinds = Kind::ALL.map(|kind| (kind, study.coverage(Some(kind))));
    let (square, count) = study.chi_square();
    println!("coverage {all:.3} of {count} values, {kinds:?}, mean square {:.3}", square / count);
    println!("{}", study.worst());
    study.assert_consistent();
    assert!((0.93..=0.97).contains(&all), "{all:.3}, {kinds:?}");
}
