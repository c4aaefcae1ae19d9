//! A Monte Carlo campaign: many simulated and calibrated runs of a scenario.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

use anyhow::Context;
use rayon::prelude::*;
use rins_campaign::{Campaign, Cell, Chunk, Prepared};
use rins_imu::Seed;
use rins_io::{
    Heading, Identity, InputFile, IoError, Journal, Overwrite, Rig, ScenarioGrid,
    ensure_replaceable, shown,
};
use rins_simulation::{Scenario, simulate};

use super::page::{CampaignOutcome, deliver};
use super::runs::Run;
use super::size::refuse_too_large;
use crate::basis::BasisResult;
use crate::error::Result;
use crate::log::setup_at;
use crate::progress::Progress;

/// The interval between synchronizations of the journal with the disk.
const SYNCHRONISED_EVERY: Duration = Duration::from_secs(1);

/// The maximum number of finished chunks in the queue of the journal.
const WAITING: usize = 64;

/// The options of [`monte_carlo`].
#[derive(Clone, Debug)]
pub struct MonteCarloOptions {
    /// The number of runs of each scenario.
    pub runs: u64,
    /// The seed; by default the scenario's.
    pub seed: Option<u64>,
    /// The Parquet file of the results; the report page is written beside it, with the extension `.html`.
    pub output: PathBuf,
    /// Whether an interrupted campaign is resumed.
    pub resume: bool,
    /// The shard to be run, such as (2, 5) for the second of five; by default the whole campaign.
    pub shard: Option<(u64, u64)>,
    /// The number of threads; by default one per core.
    pub threads: Option<u16>,
    /// Whether existing results may be replaced.
    pub overwrite: Overwrite,
    /// The stop flag: once it is set, the campaign stops after the chunks in progress, and can be resumed.
    pub stopped: Arc<AtomicBool>,
    /// The listener for progress reports.
    pub progress: Progress,
}

impl MonteCarloOptions {
    /// Options for `runs` runs of each scenario, with the results in the file `output`.
    pub fn new(runs: u64, output: impl Into<PathBuf>) -> Self {
        Self {
            runs,
            seed: None,
            output: output.into(),
            resume: false,
            shard: None,
            threads: None,
            overwrite: Overwrite::Refuse,
            stopped: Arc::default(),
            progress: Progress::default(),
        }
    }
}

/// Simulates and calibrates a scenario many times: do the errors of the estimates agree with their covariances?
///
/// The output does not depend on the number of threads, byte for byte.
///
/// # Errors
/// If the scenario cannot be read or simulated, if the results cannot be written, or if the campaign was stopped.
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
    let grid = ScenarioGrid::read(scenario)?;
    let shard = shard.unwrap_or((1, 1));
    refuse_too_large(&grid, *runs, shard.1).with_context(|| shown(scenario))?;
    let seed = seed.unwrap_or_else(|| grid.cells[0].file.scenario.seed.seed);
    let cells: Vec<Cell> = grid
        .cells
        .iter()
        .map(|one| cell(&one.file, seed).with_context(|| place(scenario, &grid, &one.values)))
        .collect::<anyhow::Result<_>>()?;
    let campaign = Campaign { cells, runs: *runs };
    let prepared: Vec<Prepared> = campaign
        .cells
        .iter()
        .zip(&grid.cells)
        .map(|(cell, one)| cell.prepare().with_context(|| place(scenario, &grid, &one.values)))
        .collect::<anyhow::Result<_>>()?;
    let identity = Identity { scenario: grid.text.clone(), runs: *runs, seed, shard };
    // The check comes before the runs, and is repeated when the results are written.
    ensure_replaceable(output, *overwrite)?;
    let mut journal = open(options, &identity)?;
    let chunks: Vec<Chunk> =
        campaign.chunks().filter(|chunk| chunk.index % shard.1 == shard.0 - 1).collect();
    finish(&chunks, &prepared, &mut journal, options)?;
    drop(prepared);
    journal.synchronise()?;
    let done = chunks.iter().filter(|chunk| is_done(&journal, chunk)).count();
    anyhow::ensure!(
        done == chunks.len(),
        "stopped after {done} of {} portions; continue with --resume",
        chunks.len()
    );
    let heading = Heading {
        identity,
        keys: grid.keys,
        values: grid.cells.into_iter().map(|cell| cell.values).collect(),
    };
    let runs = chunks.iter().flat_map(|chunk| of_chunk(&campaign, chunk, &mut journal));
    let basis = BasisResult::of_files([InputFile::of(scenario)?]);
    let source = (&*shown(scenario), "monte-carlo", basis);
    let outcome = deliver(&heading, runs, output, source, *overwrite)?;
    journal.remove()?;
    Ok(outcome)
}

/// The location of a scenario of the grid, for an error message.
fn place(scenario: &Path, grid: &ScenarioGrid, values: &[String]) -> String {
    let at: Vec<String> =
        grid.keys.iter().zip(values).map(|(key, value)| format!("{key} = {value}")).collect();
    if at.is_empty() { shown(scenario) } else { format!("{}: {}", shown(scenario), at.join(", ")) }
}

/// A scenario with the data that the filter receives: those that the rig file of a user would contain.
fn cell(file: &rins_io::ScenarioFile, seed: u64) -> anyhow::Result<Cell> {
    let scenario = Scenario { seed: Seed::new(seed), ..file.scenario.clone() };
    let noiseless = simulate(&Scenario { noise: None, ..scenario.clone() })?;
    let rig = Rig::parse(&file.rig_toml(&noiseless.recording), &file.path)?;
    let setup = setup_at(&rig, scenario.station)?;
    Ok(Cell { scenario, setup })
}

/// Whether a chunk is finished; a chunk that the journal has with other runs is repeated.
fn is_done(journal: &Journal, chunk: &Chunk) -> bool {
    journal.len_of(chunk.index) == Some(chunk.runs.end - chunk.runs.start)
}

/// The results of the runs of a finished chunk.
fn of_chunk(
    campaign: &Campaign,
    chunk: &Chunk,
    journal: &mut Journal,
) -> Vec<Result<Run, IoError>> {
    let truth = campaign.cells[chunk.cell].truth();
    let made = |(number, result)| Ok(Run::made(chunk.cell, number, &truth, result));
    match journal.runs(chunk.index) {
        Ok(results) => chunk.runs.clone().zip(results).map(made).collect(),
        Err(error) => vec![Err(error)],
    }
}

/// The journal beside the results.
fn open(options: &MonteCarloOptions, identity: &Identity) -> anyhow::Result<Journal> {
    let path = journal_path(&options.output);
    let there = path.exists();
    if there && options.resume {
        return Journal::resume(&path, identity)?.with_context(|| {
            format!("{}: another campaign's; remove it, or choose another name", shown(&path))
        });
    }
    anyhow::ensure!(
        !there || options.overwrite == Overwrite::Force,
        "{}: an unfinished campaign; continue it with --resume, or --force to begin anew",
        shown(&path)
    );
    Ok(Journal::create(&path, identity, options.overwrite)?)
}

fn journal_path(output: &Path) -> PathBuf {
    let mut name = output.as_os_str().to_owned();
    name.push(".part");
    name.into()
}

/// Runs the unfinished chunks on all threads; an interrupt stops it after the chunks in progress.
fn finish(
    chunks: &[Chunk],
    prepared: &[Prepared],
    journal: &mut Journal,
    options: &MonteCarloOptions,
) -> anyhow::Result<()> {
    let stopped = &options.stopped;
    let threads = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads.map_or(0, usize::from))
        .build()
        .context("cannot start threads")?;
    let open: Vec<&Chunk> = chunks.iter().filter(|chunk| !is_done(journal, chunk)).collect();
    let mut done = chunks.len() - open.len();
    let stage = options.progress.begin("running", Some(chunks.len()));
    stage.done(done);
    // The queue is bounded: if the disk is slow, the threads wait.
    let (sender, receiver) = mpsc::sync_channel(WAITING);
    std::thread::scope(|scope| {
        scope.spawn(move || {
            threads.install(|| {
                // In order, so that no thread finishes chunks far ahead of the others.
                open.par_iter().with_max_len(1).for_each_with(sender, |sender, chunk| {
                    if !stopped.load(Ordering::Relaxed) {
                        let runs = prepared[chunk.cell].run(chunk.runs.clone());
                        // The receiver is gone if the journal could not be written.
                        if sender.send((chunk.index, runs)).is_err() {
                            stopped.store(true, Ordering::Relaxed);
                        }
                    }
                });
            });
        });
        let mut synchronised = Instant::now();
        for (index, runs) in receiver {
            journal.add(index, &runs)?;
            if synchronised.elapsed() > SYNCHRONISED_EVERY {
                journal.synchronise()?;
                synchronised = Instant::now();
            }
            done += 1;
            stage.done(done);
        }
        anyhow::Ok(())
    })
}
