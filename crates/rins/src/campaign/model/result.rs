//! The calibration of posteriors, for a machine.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use rins_campaign::{Combinations, DETERMINED, EcdfBand, PosteriorStatistics, QuantityStatistics};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A parameter counts as a part of the well-determined combinations from this share on.
const TAKES_PART: f64 = 0.1;

/// Parameters with a smaller weight are omitted from a combination in words.
pub(super) const SLIGHT: f64 = 0.1;

/// The largest family-wise p-value at which the ranks are reported as not uniform.
pub(super) const SIGNIFICANCE: f64 = 0.01;

/// How the posterior of one parameter or combination agrees with the true values over the runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PosteriorResult {
    /// The observability: `observable` (posterior sigma below half of the prior sigma), `observable only in a combination`, or
    /// `unobservable` (prior-dominated).
    pub observability: String,
    /// The root mean square of the prior sigmas.
    pub prior_sigma: f64,
    /// The standard error of `mean_error`.
    pub mean_error_sigma: f64,
    /// The root mean square of error over sigma: 1 if the posteriors are calibrated.
    pub rms_ratio: f64,
    /// Its 95 % confidence interval.
    pub rms_ratio_interval_95: [f64; 2],
    /// The coverage of the central 68 %, 95 % and 99.7 % intervals.
    pub coverage: Vec<CoverageResult>,
    /// The empirical distribution function of the ranks of the true values in their posteriors, minus the uniform one, at `points` of
    /// `rank_band`.
    pub ecdf_difference: Vec<f64>,
    /// The p-value of uniform ranks.
    pub p_value: f64,
    /// Whether the ranks are uniform, with 1 % of false alarms over all parameters and combinations of the scenario; absent of a parameter
    /// whose posterior is not calibrated for given true values, because the prior dominates it.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub calibrated: Option<bool>,
}

/// The coverage of a central interval of the posteriors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CoverageResult {
    /// The probability of the interval.
    pub nominal: f64,
    /// The fraction of the intervals that contain the true value.
    pub fraction: f64,
    /// The 95 % Clopper-Pearson interval of the fraction.
    pub interval_95: [f64; 2],
}

/// A well-determined combination: an eigenvector of the posterior covariance of the first run, in units of the prior sigmas.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CombinationResult {
    /// The weight of each parameter, divided by its prior sigma; weights below 0.001 are omitted.
    pub weights: BTreeMap<String, f64>,
    /// The posterior sigma; the prior sigma is 1.
    pub sigma_rms: f64,
    /// The mean error.
    pub mean_error: f64,
    /// The standard deviation of the errors.
    pub error_std: f64,
    /// The calibration of its posterior.
    pub posterior: PosteriorResult,
}

/// The simultaneous 95 % confidence band of the difference between the empirical distribution function of ranks and the uniform one
/// (Säilynoja, Bürkner and Vehtari, 2022).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RankBandResult {
    /// The ranks at which the functions are evaluated.
    pub points: Vec<f64>,
    /// The lower edge.
    pub lower: Vec<f64>,
    /// The upper edge.
    pub upper: Vec<f64>,
}

/// The observability of a parameter over the runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Observability {
    Observable,
    InCombination,
    Unobservable,
}

impl Observability {
    /// The observability of each parameter.
    pub(super) fn of(statistics: &PosteriorStatistics) -> Vec<Self> {
        let shares = statistics.combinations.shares();
        let of = |(quantity, share): (&QuantityStatistics, f64)| {
            if quantity.sigma_rms < DETERMINED * quantity.prior_sigma_rms {
                Self::Observable
            } else if share >= TAKES_PART {
                Self::InCombination
            } else {
                Self::Unobservable
            }
        };
        statistics.parameters.iter().zip(shares).map(of).collect()
    }

    pub(super) const fn words(self) -> &'static str {
        match self {
            Self::Observable => "observable",
            Self::InCombination => "observable only in a combination",
            Self::Unobservable => "unobservable",
        }
    }
}

/// The verdicts on the ranks of a scenario.
#[derive(Clone, Debug)]
pub(super) struct Verdicts {
    pub(super) observability: Vec<Observability>,
    /// Of each parameter whether its ranks are uniform; `None` if they need not be.
    pub(super) parameters: Vec<Option<bool>>,
    /// The same of each combination.
    pub(super) combinations: Vec<bool>,
    /// The number of parameters and combinations that are tested.
    pub(super) tested: usize,
}

impl Verdicts {
    /// The verdicts; `drawn` if the true values were drawn from the prior.
    pub(super) fn of(statistics: &PosteriorStatistics, drawn: bool) -> Self {
        let observability = Observability::of(statistics);
        let is_tested = |of: &Observability| drawn || *of == Observability::Observable;
        let parameters = observability.iter().filter(|of| is_tested(of)).count();
        let tested = parameters + statistics.of_combinations.len();
        let uniform =
            |quantity: &QuantityStatistics| quantity.p_value * tested as f64 >= SIGNIFICANCE;
        let both = statistics.parameters.iter().zip(&observability);
        Self {
            parameters: both.map(|(one, of)| is_tested(of).then(|| uniform(one))).collect(),
            combinations: statistics.of_combinations.iter().map(uniform).collect(),
            observability,
            tested,
        }
    }

    /// The number of parameters and combinations whose ranks are not uniform.
    pub(super) fn failed(&self) -> usize {
        let parameters = self.parameters.iter().filter(|uniform| **uniform == Some(false));
        parameters.count() + self.combinations.iter().filter(|uniform| !**uniform).count()
    }
}

impl PosteriorResult {
    pub(super) fn of(
        quantity: &QuantityStatistics,
        observability: Observability,
        calibrated: Option<bool>,
    ) -> Self {
        let coverage = quantity.coverage.iter().map(|one| CoverageResult {
            nominal: one.nominal,
            fraction: one.fraction,
            interval_95: one.interval_95,
        });
        Self {
            observability: observability.words().into(),
            prior_sigma: quantity.prior_sigma_rms,
            mean_error_sigma: quantity.mean_error_sigma,
            rms_ratio: quantity.rms_ratio,
            rms_ratio_interval_95: quantity.rms_ratio_interval_95,
            coverage: coverage.collect(),
            ecdf_difference: quantity.ecdf_difference.clone(),
            p_value: quantity.p_value,
            calibrated,
        }
    }
}

impl CombinationResult {
    pub(super) fn all(
        ids: &[String],
        statistics: &PosteriorStatistics,
        verdicts: &Verdicts,
    ) -> Vec<Self> {
        let of = |(place, quantity): (usize, &QuantityStatistics)| Self {
            weights: ids
                .iter()
                .zip(statistics.combinations.weights.column(place).iter())
                .filter(|(_, weight)| weight.abs() >= 0.001)
                .map(|(id, weight)| (id.clone(), *weight))
                .collect(),
            sigma_rms: quantity.sigma_rms,
            mean_error: quantity.mean_error,
            error_std: quantity.error_std,
            posterior: PosteriorResult::of(
                quantity,
                Observability::Observable,
                Some(verdicts.combinations[place]),
            ),
        };
        statistics.of_combinations.iter().enumerate().map(of).collect()
    }
}

impl RankBandResult {
    pub(super) fn of(band: &EcdfBand) -> Self {
        let [lower, upper] = band.differences();
        Self { points: EcdfBand::points().collect(), lower, upper }
    }
}

/// A combination in words, such as `0.71 gyro.bias.x + 0.70 gyro.scale.z`.
pub(super) fn in_words(combinations: &Combinations, place: usize, ids: &[String]) -> String {
    let weights = combinations.weights.column(place);
    let mut parts: Vec<(f64, &String)> =
        weights.iter().copied().zip(ids).filter(|(weight, _)| weight.abs() >= SLIGHT).collect();
    parts.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let mut words = String::new();
    for (weight, id) in parts {
        let sign = match (words.is_empty(), weight < 0.0) {
            (true, false) => "",
            (true, true) => "−",
            (false, false) => " + ",
            (false, true) => " − ",
        };
        // Writing to a string cannot fail.
        let _ = write!(words, "{sign}{:.2} {id}", weight.abs());
    }
    words
}
