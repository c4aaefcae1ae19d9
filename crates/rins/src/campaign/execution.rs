//! The runs of a campaign on all threads, with their journal.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::mpsc;
use std::time::{Duration, Instant};

use anyhow::Context;
use rayon::prelude::*;
use rins_campaign::{Chunk, chunks};
use rins_io::{Identity, IoError, Journal, JournalRun, Overwrite, RunRows, shown};

use super::options::MonteCarloOptions;

/// The interval between synchronizations of the journal with the disk.
const SYNCHRONISED_EVERY: Duration = Duration::from_secs(1);

/// The maximum number of finished chunks in the queue of the journal.
const WAITING: usize = 64;

/// The runs of a campaign: how they are simulated and estimated.
pub(super) trait Runs: Sync {
    /// A run with its results, in the units of its parameters.
    type Run;

    /// The maximum number of runs of a chunk.
    const CHUNK: u64;

    /// The number of scenarios.
    fn cells(&self) -> usize;

    /// The number of numbers of a run in the journal.
    fn numbers(&self) -> usize;

    /// Simulates and estimates the runs of a chunk; the result does not depend on other chunks.
    fn run(&self, chunk: &Chunk) -> Vec<JournalRun>;

    /// A run of a scenario from the journal.
    fn of_journal(&self, cell: usize, number: u64, numbers: JournalRun) -> Self::Run;
}

/// The result of a run as rows of a result file.
pub(super) trait Rows: Sized {
    /// A row for each parameter.
    fn rows(&self) -> RunRows;

    /// A run from the rows of a result file.
    fn read(rows: &RunRows) -> Self;
}

/// A campaign whose runs are all in the journal.
pub(super) struct Finished<'a, R> {
    runs: &'a R,
    chunks: Vec<Chunk>,
    journal: Journal,
}

impl<'a, R: Runs> Finished<'a, R> {
    /// Runs those that are not yet in the journal beside the results.
    pub(super) fn of(
        runs: &'a R,
        identity: &Identity,
        options: &MonteCarloOptions,
    ) -> anyhow::Result<Self> {
        let (shard, of) = identity.shard;
        let mut journal = open(options, identity, runs.numbers())?;
        let chunks: Vec<Chunk> = chunks(runs.cells(), identity.runs, R::CHUNK)
            .filter(|chunk| chunk.index % of == shard - 1)
            .collect();
        finish(&chunks, runs, &mut journal, options)?;
        journal.synchronise()?;
        let done = chunks.iter().filter(|chunk| is_done(&journal, chunk)).count();
        anyhow::ensure!(
            done == chunks.len(),
            "stopped after {done} of {} portions; continue with --resume",
            chunks.len()
        );
        Ok(Self { runs, chunks, journal })
    }

    /// The runs, in the order of scenarios and runs.
    pub(super) fn runs(&mut self) -> impl Iterator<Item = Result<R::Run, IoError>> {
        let Self { runs, chunks, journal } = self;
        chunks.iter().flat_map(|chunk| of_chunk(*runs, chunk, journal))
    }

    /// Removes the journal, once the results are written.
    pub(super) fn remove(self) -> Result<(), IoError> {
        self.journal.remove()
    }
}

/// Whether a chunk is finished; a chunk that the journal has with other runs is repeated.
fn is_done(journal: &Journal, chunk: &Chunk) -> bool {
    journal.len_of(chunk.index) == Some(chunk.runs.end - chunk.runs.start)
}

/// The results of the runs of a finished chunk.
fn of_chunk<R: Runs>(
    runs: &R,
    chunk: &Chunk,
    journal: &mut Journal,
) -> Vec<Result<R::Run, IoError>> {
    let made = |(number, numbers)| Ok(runs.of_journal(chunk.cell, number, numbers));
    match journal.runs(chunk.index) {
        Ok(results) => chunk.runs.clone().zip(results).map(made).collect(),
        Err(error) => vec![Err(error)],
    }
}

/// The journal beside the results.
fn open(
    options: &MonteCarloOptions,
    identity: &Identity,
    numbers: usize,
) -> anyhow::Result<Journal> {
    let path = journal_path(&options.output);
    let there = path.exists();
    if there && options.resume {
        return Journal::resume(&path, identity, numbers)?.with_context(|| {
            format!("{}: another campaign's; remove it, or choose another name", shown(&path))
        });
    }
    anyhow::ensure!(
        !there || options.overwrite == Overwrite::Force,
        "{}: an unfinished campaign; continue it with --resume, or --force to begin anew",
        shown(&path)
    );
    Ok(Journal::create(&path, identity, numbers, options.overwrite)?)
}

fn journal_path(output: &Path) -> PathBuf {
    let mut name = output.as_os_str().to_owned();
    name.push(".part");
    name.into()
}

/// Runs the unfinished chunks on all threads; an interrupt stops it after the chunks in progress.
fn finish(
    chunks: &[Chunk],
    runs: &impl Runs,
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
                        let results = runs.run(chunk);
                        // The receiver is gone if the journal could not be written.
                        if sender.send((chunk.index, results)).is_err() {
                            stopped.store(true, Ordering::Relaxed);
                        }
                    }
                });
            });
        });
        let mut synchronised = Instant::now();
        for (index, results) in receiver {
            journal.add(index, &results)?;
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
