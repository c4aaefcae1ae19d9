//! `rins merge`: joins the shards of a campaign; the output is byte-identical to that of a single run.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context;
use rins_io::{
    Heading, InputFile, IntermediateFolder, IoError, Overwrite, PartRuns, RunRows,
    ensure_replaceable, shown, write_part,
};

use super::execution::Rows;
use super::model::{ModelRun, deliver_model};
use super::outcome::CampaignOutcome;
use super::page::deliver;
use super::runs::Run;
use crate::basis::BasisResult;
use crate::error::Result;

/// The maximum number of parts that are open at a time.
const MOST_OPEN: usize = 64;

/// Joins the shards of a campaign; the output is byte-identical to that of a campaign that was run without shards.
///
/// Of any number of shards, 64 are open at a time. More are merged in groups, into temporary files beside the output.
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
    // The check comes before the work, and is repeated when the results are written.
    ensure_replaceable(output, overwrite)?;
    // Every part is read twice, because the first run is written only after all parts are known to belong together.
    let heading = joined(paths)?;
    let folder = IntermediateFolder::beside(output)?;
    let few = few(paths.to_vec(), &heading, folder.path())?;
    let runs = InOrder::of(&few)?;
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

/// At most [`MOST_OPEN`] files with the runs of all parts: groups of parts are merged into files in `folder` until they are few.
///
/// Memory and open files do not grow with the number of parts.
fn few(mut parts: Vec<PathBuf>, heading: &Heading, folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut pass = 0;
    while parts.len() > MOST_OPEN {
        let mut merged = Vec::new();
        for (group, of_group) in parts.chunks(MOST_OPEN).enumerate() {
            let path = folder.join(format!("{pass}-{group}.parquet"));
            write_part(&path, Overwrite::Refuse, heading, InOrder::of(of_group)?)?;
            if pass > 0 {
                // The disk holds the runs twice, not once for each pass.
                for read in of_group {
                    fs::remove_file(read).with_context(|| shown(read))?;
                }
            }
            merged.push(path);
        }
        (parts, pass) = (merged, pass + 1);
    }
    Ok(parts)
}

/// The runs of several parts in the order of scenarios and runs.
struct InOrder {
    parts: Vec<PartRuns>,
    /// The next run of each part that has one.
    next: BinaryHeap<Reverse<Next>>,
    /// The error of the last read.
    failed: Option<IoError>,
}

/// The next run of a part.
struct Next {
    part: usize,
    rows: RunRows,
}

impl Next {
    fn place(&self) -> (u64, u64, usize) {
        (self.rows[0].cell, self.rows[0].run, self.part)
    }
}

impl PartialEq for Next {
    fn eq(&self, other: &Self) -> bool {
        self.place() == other.place()
    }
}

impl Eq for Next {}

impl PartialOrd for Next {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Next {
    fn cmp(&self, other: &Self) -> Ordering {
        self.place().cmp(&other.place())
    }
}

impl InOrder {
    fn of(paths: &[PathBuf]) -> Result<Self, IoError> {
        let parts = paths.iter().map(|path| PartRuns::open_one_of(path, paths.len()));
        let parts = parts.collect::<Result<Vec<_>, _>>()?;
        let mut runs = Self { parts, next: BinaryHeap::new(), failed: None };
        (0..paths.len()).for_each(|part| runs.read(part));
        Ok(runs)
    }

    /// Reads the next run of a part.
    fn read(&mut self, part: usize) {
        match self.parts[part].next() {
            Some(Ok(rows)) => self.next.push(Reverse(Next { part, rows })),
            Some(Err(error)) => self.failed = Some(error),
            None => (),
        }
    }
}

impl Iterator for InOrder {
    type Item = Result<RunRows, IoError>;

    fn next(&mut self) -> Option<Self::Item> {
        if let Some(error) = self.failed.take() {
            return Some(Err(error));
        }
        let Reverse(Next { part, rows }) = self.next.pop()?;
        self.read(part);
        Some(Ok(rows))
    }
}

/// The common heading of the parts, if all belong to one campaign and each of their runs can be read.
fn joined(paths: &[PathBuf]) -> anyhow::Result<Heading> {
    let Some(first_path) = paths.first() else { anyhow::bail!("no shards are given") };
    let first = PartRuns::open(first_path)?.heading().clone();
    let identity = first.identity.whole();
    let of = first.identity.shard.1;
    let mut values: Vec<Vec<String>> = Vec::new();
    let mut shards = Vec::with_capacity(paths.len());
    for path in paths {
        let mut runs = PartRuns::open(path)?;
        runs.by_ref().try_for_each(|run| run.map(drop))?;
        let part = runs.heading();
        anyhow::ensure!(
            part.identity.whole() == identity
                && part.identity.shard.1 == of
                && part.keys == first.keys,
            "{}: not of the campaign of {}",
            shown(path),
            shown(first_path)
        );
        shards.push((part.identity.shard.0, path));
        if values.len() < part.values.len() {
            values.resize(part.values.len(), Vec::new());
        }
        for (all, of_part) in values.iter_mut().zip(&part.values) {
            // A part has no data of a scenario of which it contains no runs.
            if !of_part.is_empty() {
                all.clone_from(of_part);
            }
        }
    }
    shards.sort_unstable();
    for (expected, (shard, path)) in (1..).zip(&shards) {
        anyhow::ensure!(
            *shard == expected,
            "{}: shard {shard} of {of}; expected shard {expected}, which is missing or given twice",
            shown(path),
        );
    }
    anyhow::ensure!(
        shards.len() as u64 == of,
        "{} of {of} shards are given; shard {} is missing",
        shards.len(),
        shards.len() + 1
    );
    Ok(Heading { identity, keys: first.keys, values })
}
