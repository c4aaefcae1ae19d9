//! Monte Carlo campaigns.

use std::path::PathBuf;

use pyo3::prelude::*;
use rins::{ModelChoice, MonteCarloOptions, TruthChoice};

use crate::call::Call;
use crate::error::argument;
use crate::logs::noise_choice;
use crate::outcome::{Outcome, overwrite};

/// The options of a campaign.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Campaign {
    runs: u64,
    seed: Option<u64>,
    model: String,
    noise: String,
    truth: String,
    output: PathBuf,
    resume: bool,
    shard: Option<(u64, u64)>,
    threads: Option<u16>,
    force: bool,
}

/// `rins monte-carlo`.
#[pyfunction]
pub(crate) fn monte_carlo(
    py: Python<'_>,
    scenario: PathBuf,
    options: Campaign,
    progress: Option<Py<PyAny>>,
) -> PyResult<Outcome> {
    let Campaign { runs, seed, model, noise, truth, output, resume, shard, threads, force } =
        options;
    if !(1..=10_000_000_000).contains(&runs) {
        return Err(argument("runs", "expected 1 to 10000000000"));
    }
    if shard.is_some_and(|(shard, of)| !(1..=of).contains(&shard)) {
        return Err(argument("shard", "expected a shard of so many, such as (2, 5)"));
    }
    if threads.is_some_and(|threads| !(1..=1024).contains(&threads)) {
        return Err(argument("threads", "expected 1 to 1024"));
    }
    let name = model;
    let model = ModelChoice::parse(&name)
        .map_err(|expected| argument("model", format!("{name:?}, {expected}")))?;
    let noise = noise_choice(&noise)?;
    let truth = match &*truth {
        "prior" => TruthChoice::Prior,
        "scenario" => TruthChoice::Scenario,
        _ => {
            let expected = format!("{truth:?}, expected \"prior\" or \"scenario\"");
            return Err(argument("truth", expected));
        }
    };
    let (call, stopped) = Call::with_flag(progress);
    Outcome::run(py, call, Some(&name), move |progress| {
        let options = MonteCarloOptions {
            seed,
            model,
            noise,
            truth,
            resume,
            shard,
            threads,
            overwrite: overwrite(force),
            stopped,
            progress: progress.clone(),
            ..MonteCarloOptions::new(runs, output)
        };
        Outcome::of(rins::monte_carlo(&scenario, &options)?)
    })
}

/// `rins merge`.
#[pyfunction]
pub(crate) fn merge(
    py: Python<'_>,
    parts: Vec<PathBuf>,
    output: PathBuf,
    force: bool,
) -> PyResult<Outcome> {
    Outcome::run(py, Call::new(None), None, move |_| {
        Outcome::of(rins::merge(&parts, &output, overwrite(force))?)
    })
}
