//! Size limits of campaigns: a campaign that no computer can finish is refused before it starts.

use rins_io::ScenarioGrid;

/// The maximum number of runs of one shard: three days of one processor for the shortest runs, a journal of 20 GB, and 100 MB of
/// memory for the positions of the chunks in the journal.
const MOST_RUNS: u64 = 100_000_000;

/// The maximum number of runs of all shards.
const MOST_IN_ALL: u64 = 10_000_000_000;

/// The maximum number of samples of the scenarios' noise-free runs together, the same as of one run.
const MOST_SAMPLES: f64 = 1e8;

/// Refuses a campaign that is too large: `runs` runs of each scenario, in `of` shards, of which this process runs one.
pub(super) fn refuse_too_large(grid: &ScenarioGrid, runs: u64, of: u64) -> anyhow::Result<()> {
    let cells = grid.cells.len() as u64;
    let all = cells.saturating_mul(runs);
    anyhow::ensure!(
        all <= MOST_IN_ALL,
        "{cells} scenarios of {runs} runs each are more than {MOST_IN_ALL} runs"
    );
    let here = all.div_ceil(of);
    anyhow::ensure!(
        here <= MOST_RUNS,
        "{here} runs are more than the {MOST_RUNS} of one shard; make shards of them, such as --shard 1/{}",
        all.div_ceil(MOST_RUNS)
    );
    let samples: f64 = grid
        .cells
        .iter()
        .map(|cell| &cell.file.scenario)
        .map(|scenario| scenario.profile.duration() / scenario.interval)
        .sum();
    anyhow::ensure!(
        cells == 1 || samples <= MOST_SAMPLES,
        "runs of {cells} scenarios have {samples:.3e} samples, which are more than {MOST_SAMPLES:.0e}; \
         split the grid into several campaigns"
    );
    Ok(())
}
