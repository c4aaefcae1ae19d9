//! Consistency of the covariances with the errors of the estimates.

use nalgebra::Vector3;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::cell::RunResult;

/// Half the width of a two-sided 95 % interval of the standard normal distribution.
const WITHIN_95: f64 = 1.959963985;

/// The probability that consistent covariances are outside the bounds of [`Statistics::nees_bounds`].
const SIGNIFICANCE: f64 = 0.01;

/// The errors of one parameter's estimates over the runs of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Honesty {
    /// The mean of estimate minus truth.
    pub mean_error: f64,
    /// The standard deviation of the estimates.
    pub spread: f64,
    /// The root mean square of the standard uncertainties.
    pub claimed: f64,
    /// The coverage of the 95 % intervals: the fraction that contains the true value, from 0 to 1.
    pub coverage: f64,
}

/// The statistics of the runs of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistics {
    /// The number of runs with estimates.
    pub runs: usize,
    /// The number of runs without estimates.
    pub failed: usize,
    /// `M_xz`, `M_yz` \[rad\] and `S_z`.
    pub parameters: [Honesty; 3],
    /// The mean NEES of the three parameters: 3 if the covariances are consistent.
    pub nees: f64,
    /// The bounds of the mean NEES with a probability of 99 % if the covariances are consistent.
    pub nees_bounds: [f64; 2],
    /// The mean normalized innovation squared divided by its degrees of freedom.
    pub nis_ratio: f64,
}

/// The accumulated statistics of a cell; only sums over the runs are kept.
///
/// The bits of its [`statistics`](Self::statistics) depend on the runs and their order only.
#[derive(Clone, Debug, PartialEq)]
pub struct Tally {
    truth: Vector3<f64>,
    runs: usize,
    failed: usize,
    parameters: [Sums; 3],
    nees: f64,
    nis_ratio: f64,
}

/// Sums over the errors of one parameter and their variances.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sums {
    mean: f64,
    /// The sum of squared differences from the mean (‹welford1962›).
    squares: f64,
    variances: f64,
    covered: u32,
}

impl Sums {
    /// Adds an error, with number `count`.
    fn add(&mut self, error: f64, variance: f64, count: f64) {
        let from_old_mean = error - self.mean;
        self.mean += from_old_mean / count;
        self.squares += from_old_mean * (error - self.mean);
        self.variances += variance;
        self.covered += u32::from(error * error < WITHIN_95 * WITHIN_95 * variance);
    }

    fn honesty(&self, count: f64) -> Honesty {
        Honesty {
            mean_error: self.mean,
            spread: (self.squares / (count - 1.0)).sqrt(),
            claimed: (self.variances / count).sqrt(),
            coverage: f64::from(self.covered) / count,
        }
    }
}

impl Tally {
    /// The statistics without any run, for these true values.
    pub fn new(truth: Vector3<f64>) -> Self {
        Self {
            truth,
            runs: 0,
            failed: 0,
            parameters: Default::default(),
            nees: 0.0,
            nis_ratio: 0.0,
        }
    }

    /// Adds a run.
    pub fn add(&mut self, run: &RunResult) {
        let Ok(found) = run else {
            self.failed += 1;
            return;
        };
        self.runs += 1;
        let error = found.value - self.truth;
        for (index, sums) in self.parameters.iter_mut().enumerate() {
            sums.add(error[index], found.covariance[(index, index)], self.runs as f64);
        }
        // A covariance that cannot be inverted is too small.
        let root = found.covariance.cholesky();
        self.nees += root.map_or(f64::INFINITY, |root| error.dot(&root.solve(&error)));
        self.nis_ratio += found.nis_ratio;
    }

    /// The number of runs that were added, with and without estimates.
    pub fn runs(&self) -> usize {
        self.runs + self.failed
    }

    /// The statistics; `None` if fewer than two runs have estimates.
    pub fn statistics(&self) -> Option<Statistics> {
        if self.runs < 2 {
            return None;
        }
        let count = self.runs as f64;
        let sum = ChiSquared::new(3.0 * count).ok()?;
        let bound = |probability: f64| sum.inverse_cdf(probability) / count;
        Some(Statistics {
            runs: self.runs,
            failed: self.failed,
            parameters: self.parameters.map(|sums| sums.honesty(count)),
            nees: self.nees / count,
            nees_bounds: [bound(0.5 * SIGNIFICANCE), bound(1.0 - 0.5 * SIGNIFICANCE)],
            nis_ratio: self.nis_ratio / count,
        })
    }
}

impl Statistics {
    /// The statistics of a cell's runs, in their order; `None` if fewer than two have estimates.
    pub fn of(truth: &Vector3<f64>, runs: &[RunResult]) -> Option<Self> {
        let mut tally = Tally::new(*truth);
        for run in runs {
            tally.add(run);
        }
        tally.statistics()
    }

    /// Whether the covariances are consistent, neither too small nor too large.
    pub fn is_honest(&self) -> bool {
        let [least, most] = self.nees_bounds;
        (least..=most).contains(&self.nees)
    }
}
