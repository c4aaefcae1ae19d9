//! A campaign, for a machine.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use rins_campaign::{PARAMETERS, Statistics};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::model::{CombinationResult, PosteriorResult, RankBandResult};
use super::runs::UNITS;
use crate::basis::BasisResult;

/// The result of `rins monte-carlo` and `rins merge`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CampaignResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `monte-carlo` or `merge`.
    pub command: String,
    /// The scenario file, or the shards.
    pub scenario: String,
    /// How many runs of each scenario.
    pub runs: u64,
    /// The seed.
    pub seed: u64,
    /// The shard, and of how many.
    pub shard: [u64; 2],
    /// The file of the results.
    pub results: String,
    /// The page beside it.
    pub report: String,
    /// The scenarios of the grid.
    pub cells: Vec<CellResult>,
    /// The estimated model: `full` or a model file; absent for the three parameters of the paper's filter.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub model: Option<String>,
    /// The noise parameters of a model's estimation: `likely` (estimated) or `given` (of the data sheet).
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub noise: Option<String>,
    /// The true values of a model's parameters: `prior` (drawn in each run) or `scenario`.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub truth: Option<String>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// What the runs of one scenario say together; of too few runs only `grid` and `runs` are there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CellResult {
    /// What distinguishes it from the others of the grid: keys and values.
    pub grid: BTreeMap<String, String>,
    /// How many runs there are.
    pub runs: usize,
    /// How many have no estimate.
    pub failed: Option<usize>,
    /// The mean normalized estimation error squared.
    pub nees: Option<f64>,
    /// How much it is if the covariances are consistent.
    pub nees_dof: Option<usize>,
    /// Its 99 % bounds then.
    pub nees_bounds_99: Option<[f64; 2]>,
    /// The mean normalized innovation squared over its degrees of freedom.
    pub nis_ratio: Option<f64>,
    /// Whether the NEES is within its bounds.
    pub consistent: Option<bool>,
    /// The parameters.
    pub parameters: Vec<ScatterResult>,
    /// How many runs with an estimate did not converge (their last step is 0.1 sigma or more); of a model only.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub not_converged: Option<usize>,
    /// The mean number of degrees of freedom of `nees` of a run; of a model only.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub nees_dof_mean: Option<f64>,
    /// The well-determined combinations of the parameters; of a model only.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub combinations: Option<Vec<CombinationResult>>,
    /// The simultaneous confidence band of all `ecdf_difference`; of a model only.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub rank_band: Option<RankBandResult>,
}

/// How the estimates of one parameter scatter, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScatterResult {
    /// Its id.
    pub id: String,
    /// Its unit.
    pub unit: String,
    /// The true value; the mean of the true values, if each run has its own.
    pub truth: f64,
    /// The mean error.
    pub mean_error: f64,
    /// The standard deviation of the errors.
    pub error_std: f64,
    /// The root mean square of the reported sigmas.
    pub sigma_rms: f64,
    /// The share of the 95 % intervals that hold the true value.
    pub coverage_95: f64,
    /// The calibration of its posterior; of a model only.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub posterior: Option<PosteriorResult>,
}

impl CellResult {
    pub(super) fn too_few(grid: BTreeMap<String, String>, runs: usize) -> Self {
        Self {
            grid,
            runs,
            failed: None,
            nees: None,
            nees_dof: None,
            nees_bounds_99: None,
            nis_ratio: None,
            consistent: None,
            parameters: Vec::new(),
            not_converged: None,
            nees_dof_mean: None,
            combinations: None,
            rank_band: None,
        }
    }

    pub(super) fn of(
        grid: BTreeMap<String, String>,
        truth: &Vector3<f64>,
        statistics: &Statistics,
    ) -> Self {
        let parameters = PARAMETERS.iter().zip(UNITS).zip(&statistics.parameters).enumerate();
        let parameters = parameters.map(|(row, ((id, (unit, _)), honesty))| ScatterResult {
            id: (*id).into(),
            unit: unit.into(),
            truth: truth[row],
            mean_error: honesty.mean_error,
            error_std: honesty.spread,
            sigma_rms: honesty.claimed,
            coverage_95: honesty.coverage,
            posterior: None,
        });
        Self {
            failed: Some(statistics.failed),
            nees: Some(statistics.nees),
            nees_dof: Some(PARAMETERS.len()),
            nees_bounds_99: Some(statistics.nees_bounds),
            nis_ratio: Some(statistics.nis_ratio),
            consistent: Some(statistics.is_honest()),
            parameters: parameters.collect(),
            ..Self::too_few(grid, statistics.runs)
        }
    }
}
