//! The results of a campaign of a model: written, and judged.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use rins_campaign::{PosteriorStatistics, PosteriorTally};
use rins_io::{Heading, IoError, Overwrite};

use super::page::report;
use super::result::{CombinationResult, PosteriorResult, RankBandResult, Verdicts};
use super::run::{CampaignParameter, ModelRun};
use super::text::text;
use crate::campaign::execution::Rows;
use crate::campaign::outcome::{CampaignOutcome, Files, Source};
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
    fn add(all: &mut Vec<Self>, heading: &'a Heading, run: &ModelRun) {
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

    /// The ids of the parameters.
    pub(super) fn ids(&self) -> Vec<String> {
        self.parameters.iter().map(|one| one.id.clone()).collect()
    }

    fn result(&self, keys: &[String]) -> CellResult {
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

/// Writes the results and their report, and returns the outcome.
///
/// The runs come in the order of scenarios and runs and are written one by one; only the data that the report needs are kept.
pub(in crate::campaign) fn deliver_model(
    heading: &Heading,
    runs: impl Iterator<Item = Result<ModelRun, IoError>>,
    output: &Path,
    source: Source<'_>,
    overwrite: Overwrite,
) -> anyhow::Result<CampaignOutcome> {
    let title = format!("Campaign of {}", source.0);
    let files = Files::of(output)?;
    let drawn = heading.identity.model.as_ref().is_some_and(|model| model.truth == "prior");
    let scored = RefCell::new(Vec::new());
    let rows = runs.map(|run| {
        run.map(|run| {
            Scored::add(&mut scored.borrow_mut(), heading, &run);
            run.rows()
        })
    });
    files.write(overwrite, heading, rows, || {
        let mut scored = scored.borrow_mut();
        for cell in scored.iter_mut() {
            cell.statistics = cell.tally.statistics().map(|statistics| {
                let verdicts = Verdicts::of(&statistics, drawn);
                (statistics, verdicts)
            });
        }
        report(heading, &scored, &title)
    })?;
    let scored = scored.into_inner();
    let cells = scored.iter().map(|cell| cell.result(&heading.keys)).collect();
    Ok(files.outcome(heading, source, cells, text(heading, &scored, &title)))
}
