//! `rins monte-carlo`: a scenario simulated and calibrated many times over.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::mpsc;
use std::time::{Duration, Instant};

use anyhow::Context;
use rayon::prelude::*;
use rins_campaign::{Campaign, Cell, Chunk, Prepared, RunResult};
use rins_imu::Seed;
use rins_io::{Heading, Identity, Journal, Overwrite, Rig, ScenarioGrid};
use rins_simulation::{Scenario, simulate};

use crate::args::MonteCarlo;
use crate::commands::campaign_runs::Found;
use crate::commands::campaign_size::refuse_too_large;
use crate::commands::setup::{setup_at, shown};
use crate::interrupt;
use crate::outcome::Outcome;
use crate::progress;
use crate::view::campaign::deliver;

/// How often the journal is made sure of.
const SYNCHRONISED_EVERY: Duration = Duration::from_secs(1);

pub(crate) fn run(arguments: &MonteCarlo, overwrite: Overwrite) -> anyhow::Result<Outcome> {
    let MonteCarlo { scenario, runs, seed, output, shard, .. } = arguments;
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
    anyhow::ensure!(
        overwrite == Overwrite::Force || !output.exists(),
        "{}: exists already; choose another name, or --force to replace it",
        output.display()
    );
    let (mut journal, mut done) = open(arguments, &identity)?;
    let chunks: Vec<Chunk> =
        campaign.chunks().filter(|chunk| chunk.index % shard.1 == shard.0 - 1).collect();
    keep_whole(&mut done, &chunks);
    let done = finish(&chunks, &prepared, done, &mut journal, arguments.threads)?;
    journal.synchronise()?;
    anyhow::ensure!(
        done.len() == chunks.len(),
        "stopped after {} of {} portions; continue with --resume",
        done.len(),
        chunks.len()
    );
    let heading = Heading {
        identity,
        keys: grid.keys,
        values: grid.cells.into_iter().map(|cell| cell.values).collect(),
    };
    let found = found(&campaign, &chunks, done);
    let source = (&*shown(scenario), "monte-carlo");
    let outcome = deliver((&heading, &found), output, source, overwrite)?;
    journal.remove()?;
    Ok(outcome)
}

/// Names a scenario of the grid in an error.
fn place(scenario: &Path, grid: &ScenarioGrid, values: &[String]) -> String {
    let at: Vec<String> =
        grid.keys.iter().zip(values).map(|(key, value)| format!("{key} = {value}")).collect();
    if at.is_empty() { shown(scenario) } else { format!("{}: {}", shown(scenario), at.join(", ")) }
}

/// A scenario with what the filter is told: what a user's rig file of its run would say.
fn cell(file: &rins_io::ScenarioFile, seed: u64) -> anyhow::Result<Cell> {
    let scenario = Scenario { seed: Seed::new(seed), ..file.scenario.clone() };
    let noiseless = simulate(&Scenario { noise: None, ..scenario.clone() })?;
    let rig = Rig::parse(&file.rig_toml(&noiseless.recording), &file.path)?;
    let setup = setup_at(&rig, scenario.station)?;
    Ok(Cell { scenario, setup })
}

/// The finished chunks by their index.
type Done = BTreeMap<u64, Vec<RunResult>>;

/// Forgets what a journal says of chunks that are not these, or have other runs: they are made again.
fn keep_whole(done: &mut Done, chunks: &[Chunk]) {
    let mut found = std::mem::take(done);
    done.extend(chunks.iter().filter_map(|chunk| {
        let runs = found.remove(&chunk.index)?;
        let whole = runs.len() as u64 == chunk.runs.end - chunk.runs.start;
        whole.then_some((chunk.index, runs))
    }));
}

/// The journal beside the results, and what it holds.
fn open(arguments: &MonteCarlo, identity: &Identity) -> anyhow::Result<(Journal, Done)> {
    let path = journal_path(&arguments.output);
    let there = path.exists();
    if there && arguments.resume {
        let (journal, done) = Journal::resume(&path, identity)?.with_context(|| {
            format!("{}: another campaign's; remove it, or choose another name", path.display())
        })?;
        return Ok((journal, done.into_iter().collect()));
    }
    anyhow::ensure!(
        !there,
        "{}: an unfinished campaign; continue it with --resume, or remove it",
        path.display()
    );
    Ok((Journal::create(&path, identity)?, Done::new()))
}

fn journal_path(output: &Path) -> PathBuf {
    let mut name = output.as_os_str().to_owned();
    name.push(".part");
    name.into()
}

/// Runs what is not done yet, on all threads; an interrupt stops it after the chunks in hand.
fn finish(
    chunks: &[Chunk],
    prepared: &[Prepared],
    mut done: Done,
    journal: &mut Journal,
    threads: Option<u16>,
) -> anyhow::Result<Done> {
    let stopped = interrupt::stopped();
    let threads = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.map_or(0, usize::from))
        .build()
        .context("cannot start threads")?;
    let open: Vec<&Chunk> =
        chunks.iter().filter(|chunk| !done.contains_key(&chunk.index)).collect();
    let bar = progress::bar(chunks.len(), "running");
    bar.set_position(done.len() as u64);
    bar.reset_eta();
    let (sender, receiver) = mpsc::channel();
    let written = std::thread::scope(|scope| {
        let stopped = &stopped;
        scope.spawn(move || {
            threads.install(|| {
                // In order, so that what one thread finishes is not far ahead of the others.
                open.par_iter().with_max_len(1).for_each_with(sender, |sender, chunk| {
                    if !stopped.load(Ordering::Relaxed) {
                        let runs = prepared[chunk.cell].run(chunk.runs.clone());
                        // Nobody listens any more where the journal could not be written.
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
            done.insert(index, runs);
            bar.set_position(done.len() as u64);
        }
        anyhow::Ok(())
    });
    bar.finish_and_clear();
    written.map(|()| done)
}

/// What the runs of finished chunks found, in the order of scenarios.
fn found(campaign: &Campaign, chunks: &[Chunk], mut done: Done) -> Vec<Found> {
    let mut all: Vec<Found> = Vec::new();
    for chunk in chunks {
        let Some(results) = done.remove(&chunk.index) else { continue };
        if all.last().is_none_or(|last| last.cell != chunk.cell) {
            all.push(Found::none(chunk.cell, &campaign.cells[chunk.cell].truth()));
        }
        if let Some(of_cell) = all.last_mut() {
            for (run, result) in chunk.runs.clone().zip(results) {
                of_cell.add(run, result);
            }
        }
    }
    all
}
