//! Whether estimates scatter as their covariances claim.

use nalgebra::Vector3;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::cell::RunResult;

/// Half the width of a two-sided 95 % interval of a normal deviate.
const WITHIN_95: f64 = 1.959963985;

/// The probability that honest covariances lie outside the bounds of [`Statistics::nees_bounds`].
const SIGNIFICANCE: f64 = 0.01;

/// How one parameter's estimates scatter over the runs of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Honesty {
    /// The mean of estimate minus truth.
    pub mean_error: f64,
    /// The standard deviation of the estimates.
    pub spread: f64,
    /// The root mean square of the 1σ claimed.
    pub claimed: f64,
    /// How many of the 95 % intervals claimed hold the truth, from 0 to 1.
    pub coverage: f64,
}

/// What the runs of a cell say together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistics {
    /// How many runs have estimates.
    pub runs: usize,
    /// How many have none.
    pub failed: usize,
    /// `M_xz`, `M_yz` \[rad\] and `S_z`.
    pub parameters: [Honesty; 3],
    /// The mean squared error of the three normalised by their covariance: 3 if that is honest.
    pub nees: f64,
    /// Between which the mean lies with a probability of 99 % if it is honest.
    pub nees_bounds: [f64; 2],
    /// The mean normalised innovation squared over its degrees of freedom.
    pub nis_ratio: f64,
}

impl Statistics {
    /// The statistics of a cell's runs, in their order; `None` if fewer than two have estimates.
    pub fn of(truth: &Vector3<f64>, runs: &[RunResult]) -> Option<Self> {
        let found: Vec<_> = runs.iter().filter_map(|run| run.as_ref().ok()).collect();
        if found.len() < 2 {
            return None;
        }
        let count = found.len() as f64;
        let parameter = |index: usize| {
            let mean_of = |of: &dyn Fn(f64, f64) -> f64| {
                let sum: f64 = found
                    .iter()
                    .map(|run| of(run.value[index] - truth[index], run.covariance[(index, index)]))
                    .sum();
                sum / count
            };
            let mean_error = mean_of(&|error, _| error);
            let square = mean_of(&|error, _| (error - mean_error) * (error - mean_error));
            Honesty {
                mean_error,
                spread: (square * count / (count - 1.0)).sqrt(),
                claimed: mean_of(&|_, variance| variance).sqrt(),
                coverage: mean_of(&|error, variance| {
                    f64::from(u8::from(error * error < WITHIN_95 * WITHIN_95 * variance))
                }),
            }
        };
        let nees = found.iter().map(|run| {
            let error = run.value - truth;
            // A covariance that cannot be inverted claims too much.
            run.covariance.cholesky().map_or(f64::INFINITY, |root| error.dot(&root.solve(&error)))
        });
        let nees = nees.sum::<f64>() / count;
        let sum = ChiSquared::new(3.0 * count).ok()?;
        let bound = |probability: f64| sum.inverse_cdf(probability) / count;
        Some(Self {
            runs: found.len(),
            failed: runs.len() - found.len(),
            parameters: [parameter(0), parameter(1), parameter(2)],
            nees,
            nees_bounds: [bound(0.5 * SIGNIFICANCE), bound(1.0 - 0.5 * SIGNIFICANCE)],
            nis_ratio: found.iter().map(|run| run.nis_ratio).sum::<f64>() / count,
        })
    }

    /// Whether the covariances claimed are neither too small nor too large.
    pub fn is_honest(&self) -> bool {
        let [least, most] = self.nees_bounds;
        (least..=most).contains(&self.nees)
    }
}
