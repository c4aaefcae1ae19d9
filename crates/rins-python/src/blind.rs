//! Blind trials of the diagnosis.

use std::path::PathBuf;

use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use rins_trials::{Analyser, Plan, Population, Trouble};

use crate::call::Call;
use crate::error::argument;

/// Which trials are run, and how.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct BlindOptions {
    program: PathBuf,
    population: String,
    seed: u64,
    trials: usize,
    shard: (u64, u64),
    threads: usize,
    journal: PathBuf,
}

fn population(name: &str) -> PyResult<Population> {
    match name {
        "blind" => Ok(Population::Blind),
        "null" => Ok(Population::Null),
        _ => Err(argument("population", format!("{name:?}, expected \"blind\" or \"null\""))),
    }
}

fn failed(error: &Trouble) -> PyErr {
    PyOSError::new_err(error.with_causes())
}

/// Runs the trials of a shard that its journal lacks, one after the other.
#[pyfunction]
pub(crate) fn blind_trials(py: Python<'_>, options: BlindOptions) -> PyResult<()> {
    let BlindOptions { program, population, seed, trials, shard, threads, journal } = options;
    let population = self::population(&population)?;
    let plan = Plan { population, seed, trials, threads: 1, shard };
    let done = Call::new(None).run(py, move |_| {
        rins_trials::run(&plan, &Analyser::new(program, threads), &journal, |_| ())
    })?;
    done.map_err(|error| failed(&error))
}

/// Joins the journals of all shards; returns the page with the figures.
#[pyfunction]
pub(crate) fn blind_page(
    py: Python<'_>,
    journals: Vec<PathBuf>,
    merged: PathBuf,
    population: &str,
) -> PyResult<String> {
    let population = self::population(population)?;
    let page = py.detach(move || {
        let journals: Vec<_> = journals.iter().map(PathBuf::as_path).collect();
        rins_trials::merge(&journals, &merged)?;
        let records = rins_trials::records(&merged)?;
        Ok(match population {
            Population::Blind => rins_trials::card(&records),
            Population::Null => rins_trials::null_page(&records, env!("CARGO_PKG_VERSION")),
        })
    });
    page.map_err(|error| failed(&error))
}
