//! A scenario of a campaign of a model with the statistics of its runs.

use std::collections::BTreeMap;
use std::sync::Arc;

use rins_campaign::{PosteriorStatistics, PosteriorTally};
use rins_io::Heading;

use super::result::{CombinationResult, PosteriorResult, RankBandResult, Verdicts};
use super::run::{CampaignParameter, ModelRun};
use crate::campaign::result::{CellResult, ScatterResult};

/// A scenario of the grid with the statistics of its runs.
pub(super) struct Scored<'a> {
    pub(super) values: &'a [String],
    cell: usize,
    pub(super) parameters: Arc<[CampaignParameter]>,
    tally: PosteriorTally,
    /// The number of runs with and without estimates.
    pub(super) runs: usize,
    pub(super) failed: usize,
    pub(super) not_converged: usize,
    /// The reason of the first failure.
    pub(super) failure: Option<String>,
    pub(super) statistics: Option<(PosteriorStatistics, Verdicts)>,
}

impl<'a> Scored<'a> {
    /// Adds a run to its scenario, which is the last one or a new one.
    pub(super) fn add(all: &mut Vec<Self>, heading: &'a Heading, run: &ModelRun) {
        if all.last().is_none_or(|last| last.cell != run.cell) {
            all.push(Self {
                values: &heading.values[run.cell],
                cell: run.cell,
                parameters: run.parameters.clone(),
                tally: PosteriorTally::default(),
                runs: 0,
                failed: 0,
                not_converged: 0,
                failure: None,
                statistics: None,
            });
        }
        let Some(cell) = all.last_mut() else { return };
        cell.runs += 1;
        match &run.result {
            Ok(found) => {
                cell.tally.add(&found.posterior, found.nees, found.nis_ratio);
                cell.not_converged += usize::from(!found.converged);
            }
            Err(failure) => {
                cell.failed += 1;
                cell.failure.get_or_insert_with(|| failure.reason.clone());
            }
        }
    }

    /// Calculates the statistics, once all runs are added; `drawn` if the true values were drawn from the prior.
    pub(super) fn judge(&mut self, drawn: bool) {
        self.statistics = self.tally.statistics().map(|statistics| {
            let verdicts = Verdicts::of(&statistics, drawn);
            (statistics, verdicts)
        });
    }

    /// The ids of the parameters.
    pub(super) fn ids(&self) -> Vec<String> {
        self.parameters.iter().map(|one| one.id.clone()).collect()
    }

    /// The result for a machine.
    pub(super) fn result(&self, keys: &[String]) -> CellResult {
        let grid: BTreeMap<String, String> =
            keys.iter().cloned().zip(self.values.iter().cloned()).collect();
        let Some((statistics, verdicts)) = &self.statistics else {
            return CellResult {
                failed: Some(self.failed),
                ..CellResult::too_few(grid, self.runs)
            };
        };
        let parameters = self.parameters.iter().zip(&statistics.parameters).enumerate();
        let parameters = parameters.map(|(place, (parameter, quantity))| ScatterResult {
            id: parameter.id.clone(),
            unit: parameter.unit.clone(),
            truth: quantity.mean_truth,
            mean_error: quantity.mean_error,
            error_std: quantity.error_std,
            sigma_rms: quantity.sigma_rms,
            coverage_95: quantity.coverage[1].fraction,
            posterior: Some(PosteriorResult::of(
                quantity,
                verdicts.observability[place],
                verdicts.parameters[place],
            )),
        });
        CellResult {
            failed: Some(self.failed),
            nees: Some(statistics.nees),
            nees_dof: Some(statistics.of_combinations.len()),
            nees_bounds_99: Some(statistics.nees_bounds),
            nis_ratio: Some(statistics.nis_ratio),
            consistent: Some(statistics.is_consistent()),
            parameters: parameters.collect(),
            not_converged: Some(self.not_converged),
            nees_dof_mean: Some(statistics.nees_dof),
            combinations: Some(CombinationResult::all(&self.ids(), statistics, verdicts)),
            rank_band: Some(RankBandResult::of(&statistics.band)),
            ..CellResult::too_few(grid, self.runs - self.failed)
        }
    }
}
