//! The runs of a campaign of the paper's filter.

use anyhow::Context;
use rins_campaign::{Campaign, Cell, Chunk, Prepared};
use rins_imu::Seed;
use rins_io::{JournalRun, Rig, ScenarioFile};
use rins_simulation::{Scenario, simulate};

use super::execution::Runs;
use super::runs::{NUMBERS, Run, from_journal, to_journal};
use crate::log::setup_at;

/// The scenarios of a campaign of the paper's filter.
pub(super) struct PaperRuns {
    cells: Vec<Cell>,
    prepared: Vec<Prepared>,
}

impl PaperRuns {
    /// Prepares the scenarios of a grid, each with its place in a message.
    pub(super) fn of<'f>(
        files: impl Iterator<Item = (&'f ScenarioFile, String)> + Clone,
        seed: u64,
    ) -> anyhow::Result<Self> {
        let cells: Vec<Cell> = files
            .clone()
            .map(|(file, place)| cell(file, seed).context(place))
            .collect::<anyhow::Result<_>>()?;
        let prepared = cells
            .iter()
            .zip(files)
            .map(|(cell, (_, place))| cell.prepare().context(place))
            .collect::<anyhow::Result<_>>()?;
        Ok(Self { cells, prepared })
    }
}

/// A scenario with the data that the filter receives: those that the rig file of a user would contain.
fn cell(file: &ScenarioFile, seed: u64) -> anyhow::Result<Cell> {
    let scenario = Scenario { seed: Seed::new(seed), ..file.scenario.clone() };
    let noiseless = simulate(&Scenario { noise: None, ..scenario.clone() })?;
    let rig = Rig::parse(&file.rig_toml(&noiseless.recording), &file.path)?;
    let setup = setup_at(&rig, scenario.station)?;
    Ok(Cell { scenario, setup })
}

impl Runs for PaperRuns {
    type Run = Run;

    const CHUNK: u64 = Campaign::CHUNK;

    fn cells(&self) -> usize {
        self.cells.len()
    }

    fn numbers(&self) -> usize {
        NUMBERS
    }

    fn run(&self, chunk: &Chunk) -> Vec<JournalRun> {
        self.prepared[chunk.cell].run(chunk.runs.clone()).iter().map(to_journal).collect()
    }

    fn of_journal(&self, cell: usize, number: u64, numbers: JournalRun) -> Run {
        Run::made(cell, number, &self.cells[cell].truth(), from_journal(numbers))
    }
}
