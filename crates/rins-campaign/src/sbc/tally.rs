//! The runs of one scenario: accumulated posteriors, and what they say together.

use super::combination::{Combinations, Nees};
use super::ecdf::EcdfBand;
use super::interval::mean_square_bounds;
use super::posterior::PosteriorRun;
use super::quantity::{Comparison, QuantityStatistics, QuantityTally};

/// The probability that consistent covariances are outside the bounds of [`PosteriorStatistics::nees_bounds`].
const SIGNIFICANCE: f64 = 0.01;

/// The probability of the simultaneous confidence band.
const BAND: f64 = 0.95;

/// The accumulated posteriors of the runs of one scenario; only sums and counts are kept.
///
/// The combinations are those that the covariance of the first run determines well. The bits of its
/// [`statistics`](Self::statistics) depend on the runs and their order only.
///
/// ```
/// use nalgebra::DMatrix;
/// use rins_campaign::{Nees, PosteriorRun, PosteriorTally};
/// use rins_imu::{Seed, Sensor};
/// let mut stream = Seed::new(1).stream(Sensor::Encoder);
/// let mut tally = PosteriorTally::default();
/// for _ in 0..500 {
///     // One parameter with a prior of 0 ± 1, measured to ± 0.1.
///     let truth = stream.sample();
///     let variance = 1.0 / 101.0;
///     let estimate = 100.0 * variance * (truth + 0.1 * stream.sample());
///     let run = PosteriorRun {
///         truth: vec![truth],
///         estimate: vec![estimate],
///         prior_sigmas: vec![1.0],
///         covariance: DMatrix::from_element(1, 1, variance),
///     };
///     tally.add(&run, Nees::of(&run), 1.0);
/// }
/// let statistics = tally.statistics().unwrap();
/// assert!(statistics.is_consistent());
/// assert!(statistics.parameters[0].p_value > 0.01);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PosteriorTally {
    runs: u64,
    parameters: Vec<QuantityTally>,
    combinations: Option<(Combinations, Vec<QuantityTally>)>,
    nees: f64,
    nees_dof: f64,
    nis_ratio: f64,
}

/// The statistics of the posteriors of the runs of one scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct PosteriorStatistics {
    /// The number of runs.
    pub runs: u64,
    /// The parameters, in their order.
    pub parameters: Vec<QuantityStatistics>,
    /// The well-determined combinations.
    pub combinations: Combinations,
    /// Their statistics, in units of the prior sigmas.
    pub of_combinations: Vec<QuantityStatistics>,
    /// The mean NEES of the well-determined combinations of each run.
    pub nees: f64,
    /// Its expected value: the mean of the degrees of freedom.
    pub nees_dof: f64,
    /// The bounds of the mean NEES with a probability of 99 % if the posteriors are consistent.
    pub nees_bounds: [f64; 2],
    /// The mean normalized innovation squared divided by its degrees of freedom.
    pub nis_ratio: f64,
    /// The simultaneous 95 % band of the ranks.
    pub band: EcdfBand,
}

impl PosteriorTally {
    /// Adds a run with its NEES, and its mean normalized innovation squared divided by its degrees of freedom.
    ///
    /// # Panics
    /// If the run has fewer parameters than the first one.
    pub fn add(&mut self, run: &PosteriorRun, nees: Nees, nis_ratio: f64) {
        let n = run.truth.len();
        if self.parameters.is_empty() {
            self.parameters = vec![QuantityTally::new(); n];
        }
        let (combinations, tallies) = self.combinations.get_or_insert_with(|| {
            let found = Combinations::of(&run.covariance, &run.prior_sigmas);
            let tallies = vec![QuantityTally::new(); found.ratios.len()];
            (found, tallies)
        });
        self.runs += 1;
        for (place, tally) in self.parameters.iter_mut().enumerate() {
            tally.add(&Comparison {
                truth: run.truth[place],
                error: run.estimate[place] - run.truth[place],
                sigma: run.covariance[(place, place)].sqrt(),
                prior_sigma: run.prior_sigmas[place],
            });
        }
        for ((error, sigma), tally) in combinations.errors(run).into_iter().zip(tallies) {
            tally.add(&Comparison { truth: 0.0, error, sigma, prior_sigma: 1.0 });
        }
        self.nees += nees.value;
        self.nees_dof += nees.dof as f64;
        self.nis_ratio += nis_ratio;
    }

    /// The number of runs that were added.
    pub fn runs(&self) -> u64 {
        self.runs
    }

    /// The statistics; `None` if there are fewer than two runs.
    pub fn statistics(&self) -> Option<PosteriorStatistics> {
        let (combinations, tallies) = self.combinations.as_ref()?;
        let all = |tallies: &[QuantityTally]| -> Option<Vec<QuantityStatistics>> {
            tallies.iter().map(QuantityTally::statistics).collect()
        };
        let count = self.runs as f64;
        // Without any well-determined combination, the sum of no squares is zero.
        let bounds = mean_square_bounds(self.nees_dof, SIGNIFICANCE).unwrap_or_default();
        Some(PosteriorStatistics {
            runs: self.runs,
            parameters: all(&self.parameters).filter(|_| self.runs > 1)?,
            of_combinations: all(tallies)?,
            combinations: combinations.clone(),
            nees: self.nees / count,
            nees_dof: self.nees_dof / count,
            nees_bounds: bounds.map(|bound| bound * self.nees_dof / count),
            nis_ratio: self.nis_ratio / count,
            band: EcdfBand::new(self.runs, BAND),
        })
    }
}

impl PosteriorStatistics {
    /// Whether the mean NEES lies within its bounds.
    pub fn is_consistent(&self) -> bool {
        let [least, most] = self.nees_bounds;
        (least..=most).contains(&self.nees)
    }
}
