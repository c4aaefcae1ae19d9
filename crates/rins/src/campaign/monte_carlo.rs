//! A Monte Carlo campaign: many simulated and calibrated runs of a scenario.

use std::path::Path;

use anyhow::Context;
use rins_io::{
    CampaignModel, Heading, Identity, InputFile, ScenarioFile, ScenarioGrid, ensure_replaceable,
    shown,
};

use super::execution::Finished;
use super::model::{ModelRuns, deliver_model};
use super::options::MonteCarloOptions;
use super::outcome::CampaignOutcome;
use super::page::deliver;
use super::paper::PaperRuns;
use super::size::refuse_too_large;
use crate::basis::BasisResult;
use crate::error::Result;
use crate::options::{ModelChoice, NamedModel};

/// Simulates and calibrates a scenario many times: do the errors of the estimates agree with their covariances?
///
/// The output does not depend on the number of threads, byte for byte.
///
/// # Errors
/// If the scenario or the model cannot be read or simulated, if there are no runs, if the results cannot be written, or if the campaign was stopped.
///
/// ```
/// use rins::{MonteCarloOptions, Outcome};
/// let folder = tempfile::tempdir()?;
/// let scenario = folder.path().join("scenario.toml");
/// std::fs::write(&scenario, rins::demo::SCENARIO)?;
/// let options = MonteCarloOptions::new(2, folder.path().join("runs.parquet"));
/// let campaign = rins::monte_carlo(&scenario, &options)?;
/// assert_eq!(campaign.result().cells.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn monte_carlo(scenario: &Path, options: &MonteCarloOptions) -> Result<CampaignOutcome> {
    Ok(campaign(scenario, options)?)
}

fn campaign(scenario: &Path, options: &MonteCarloOptions) -> anyhow::Result<CampaignOutcome> {
    let MonteCarloOptions { runs, seed, output, shard, overwrite, .. } = options;
    anyhow::ensure!(*runs > 0, "a campaign of 0 runs; at least 1 is needed");
    let grid = ScenarioGrid::read(scenario)?;
    let shard = shard.unwrap_or((1, 1));
    refuse_too_large(&grid, *runs, shard.1).with_context(|| shown(scenario))?;
    let seed = seed.unwrap_or_else(|| grid.cells[0].file.scenario.seed.seed);
    // The check comes before the runs, and is repeated when the results are written.
    ensure_replaceable(output, *overwrite)?;
    let identity = Identity { scenario: grid.text.clone(), runs: *runs, seed, shard, model: None };
    let input = InputFile::of(scenario)?;
    if options.model == ModelChoice::Paper12 {
        let prepared = PaperRuns::of(files(scenario, &grid), seed)?;
        let mut finished = Finished::of(&prepared, &identity, options)?;
        let basis = BasisResult::of_files([input]);
        let source = (&*shown(scenario), "monte-carlo", basis);
        let heading = heading(identity, grid);
        let outcome = deliver(&heading, finished.runs(), output, source, *overwrite)?;
        finished.remove()?;
        return Ok(outcome);
    }
    let axes = rins_io::Axes::IDENTITY;
    let named = NamedModel::of(&options.model, &axes)?;
    // Without its folder: the shards of other machines are of the same campaign.
    let (name, text) = match &options.model {
        ModelChoice::File(path) => {
            let text = std::fs::read_to_string(path);
            let name = path.file_name().map_or_else(|| shown(path), |name| shown(name.as_ref()));
            (name, text.with_context(|| format!("cannot read {}", shown(path)))?)
        }
        _ => (named.name.clone(), String::new()),
    };
    let prepared = ModelRuns::of(files(scenario, &grid), &named, seed, options)?;
    let model = CampaignModel {
        name,
        text,
        noise: options.noise.name().into(),
        truth: options.truth.name().into(),
        parameters: prepared.parameters(),
    };
    let identity = Identity { model: Some(model), ..identity };
    let mut finished = Finished::of(&prepared, &identity, options)?;
    let basis = BasisResult::of_files([input].into_iter().chain(named.file));
    let source = (&*shown(scenario), "monte-carlo", basis);
    let heading = heading(identity, grid);
    let outcome = deliver_model(&heading, finished.runs(), output, source, *overwrite)?;
    finished.remove()?;
    Ok(outcome)
}

fn heading(identity: Identity, grid: ScenarioGrid) -> Heading {
    let values = grid.cells.into_iter().map(|cell| cell.values).collect();
    Heading { identity, keys: grid.keys, values }
}

/// The scenarios of a grid, each with its place in a message.
fn files<'g>(
    scenario: &Path,
    grid: &'g ScenarioGrid,
) -> impl Iterator<Item = (&'g ScenarioFile, String)> + Clone {
    let shown = shown(scenario);
    grid.cells.iter().map(move |cell| {
        let pairs = grid.keys.iter().zip(&cell.values);
        let at: Vec<String> = pairs.map(|(key, value)| format!("{key} = {value}")).collect();
        let place =
            if at.is_empty() { shown.clone() } else { format!("{shown}: {}", at.join(", ")) };
        (&cell.file, place)
    })
}
