//! `rins merge`: joins the shards of a campaign; the output is byte-identical to that of a single run.

use std::iter::Peekable;
use std::path::{Path, PathBuf};

use rins_io::{Heading, InputFile, IoError, Overwrite, PartRuns, RunRows, shown};

use super::execution::Rows;
use super::model::{ModelRun, deliver_model};
use super::outcome::CampaignOutcome;
use super::page::deliver;
use super::runs::Run;
use crate::basis::BasisResult;
use crate::error::Result;

/// Joins the shards of a campaign; the output is byte-identical to that of a campaign that was run without shards.
///
/// # Errors
/// If a shard cannot be read, belongs to another campaign, is missing or is given twice, or if the results cannot be written.
///
/// ```
/// use rins::{MonteCarloOptions, Outcome, Overwrite};
/// let folder = tempfile::tempdir()?;
/// let scenario = folder.path().join("scenario.toml");
/// std::fs::write(&scenario, rins::demo::SCENARIO)?;
/// let mut shards = Vec::new();
/// for shard in 1..=2 {
///     let output = folder.path().join(format!("{shard}.parquet"));
///     let options = MonteCarloOptions { shard: Some((shard, 2)), ..MonteCarloOptions::new(2, &output) };
///     rins::monte_carlo(&scenario, &options)?;
///     shards.push(output);
/// }
/// let whole = rins::merge(&shards, &folder.path().join("all.parquet"), Overwrite::Refuse)?;
/// assert_eq!(whole.result().shard, [1, 1]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn merge(parts: &[PathBuf], output: &Path, overwrite: Overwrite) -> Result<CampaignOutcome> {
    Ok(merged(parts, output, overwrite)?)
}

fn merged(
    paths: &[PathBuf],
    output: &Path,
    overwrite: Overwrite,
) -> anyhow::Result<CampaignOutcome> {
    // Every part is read twice, because the first run is written only after all parts are known to belong together.
    let parts = paths
        .iter()
        .map(|path| Ok((path.clone(), checked(path)?)))
        .collect::<Result<Vec<_>, IoError>>()?;
    let heading = joined(parts)?;
    let parts = paths
        .iter()
        .map(|path| Ok(PartRuns::open(path)?.peekable()))
        .collect::<Result<_, IoError>>()?;
    let runs = InOrder { parts };
    let names: Vec<String> = paths.iter().map(|path| shown(path)).collect();
    let files = InputFile::of_each(paths.iter().map(PathBuf::as_path))?;
    let source = (&*names.join(", "), "merge", BasisResult::of_files(files));
    if heading.identity.model.is_some() {
        let runs = runs.map(|rows| rows.map(|rows| ModelRun::read(&rows)));
        return deliver_model(&heading, runs, output, source, overwrite);
    }
    let runs = runs.map(|rows| rows.map(|rows| Run::read(&rows)));
    deliver(&heading, runs, output, source, overwrite)
}

/// The heading of a part, after a check that each of its runs can be read.
fn checked(path: &Path) -> Result<Heading, IoError> {
    let mut runs = PartRuns::open(path)?;
    runs.by_ref().try_for_each(|run| run.map(drop))?;
    Ok(runs.heading().clone())
}

/// The runs of all parts in the order of scenarios and runs.
struct InOrder {
    parts: Vec<Peekable<PartRuns>>,
}

impl Iterator for InOrder {
    type Item = Result<RunRows, IoError>;

    fn next(&mut self) -> Option<Self::Item> {
        let place = |run: &Self::Item| match run {
            Ok(rows) => (rows[0].cell, rows[0].run),
            // A read error comes first.
            Err(_) => (0, 0),
        };
        let peeked = self.parts.iter_mut().map(|part| part.peek().map(place));
        let (next, _) = peeked
            .enumerate()
            .filter_map(|(part, place)| Some((part, place?)))
            .min_by_key(|(_, place)| *place)?;
        self.parts[next].next()
    }
}

/// The common heading of the parts, if all belong to one campaign.
fn joined(mut parts: Vec<(PathBuf, Heading)>) -> anyhow::Result<Heading> {
    parts.sort_by_key(|(_, part)| part.identity.shard);
    let (first_path, first) = &parts[0];
    let identity = first.identity.whole();
    let of = first.identity.shard.1;
    for (expected, (path, part)) in (1..).zip(&parts) {
        anyhow::ensure!(
            part.identity.whole() == identity
                && part.identity.shard.1 == of
                && part.keys == first.keys,
            "{}: not of the campaign of {}",
            shown(path),
            shown(first_path)
        );
        anyhow::ensure!(
            part.identity.shard.0 == expected,
            "{}: shard {} of {of}; expected shard {expected}, which is missing or given twice",
            shown(path),
            part.identity.shard.0
        );
    }
    anyhow::ensure!(
        parts.len() as u64 == of,
        "{} of {of} shards are given; shard {} is missing",
        parts.len(),
        parts.len() + 1
    );
    let keys = first.keys.clone();
    let n_cells = parts.iter().map(|(_, part)| part.values.len()).max().unwrap_or_default();
    let mut values = vec![Vec::new(); n_cells];
    for (_, part) in parts {
        for (all, of_part) in values.iter_mut().zip(part.values) {
            // A part has no data of a scenario of which it contains no runs.
            if !of_part.is_empty() {
                *all = of_part;
            }
        }
    }
    Ok(Heading { identity, keys, values })
}
