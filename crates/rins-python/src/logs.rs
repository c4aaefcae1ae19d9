//! Functions of logs.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use rins::{
    CalibrateOptions, DiagnoseOptions, ModelChoice, NavigateOptions, NoiseChoice, Outcome as _,
};

use crate::call::Call;
use crate::error::argument;
use crate::log::Log;
use crate::outcome::Outcome;

pub(crate) fn noise_choice(name: &str) -> PyResult<NoiseChoice> {
    match name {
        "likely" => Ok(NoiseChoice::Likely),
        "given" => Ok(NoiseChoice::Given),
        _ => Err(argument("noise", format!("{name:?}, expected \"likely\" or \"given\""))),
    }
}

fn owned(logs: Vec<Py<Log>>) -> Vec<rins::Log> {
    logs.into_iter().map(|log| (*log.get().log()).clone()).collect()
}

/// `rins check`.
#[pyfunction]
pub(crate) fn check(py: Python<'_>, log: &Log) -> PyResult<Outcome> {
    let log = log.log();
    Outcome::run(py, Call::new(None), None, move |_| {
        let (page, write) = (Arc::clone(&log), Arc::clone(&log));
        Outcome::of_log(
            &rins::check(&log),
            move || Ok(rins::check(&page).page()),
            move |folder, overwrite| rins::check(&write).write(folder, overwrite),
        )
    })
}

/// `rins allan`.
#[pyfunction]
pub(crate) fn allan(py: Python<'_>, log: &Log) -> PyResult<Outcome> {
    let log = log.log();
    Outcome::run(py, Call::new(None), None, move |_| {
        let (page, write) = (Arc::clone(&log), Arc::clone(&log));
        Outcome::of_log(
            &rins::allan(&log)?,
            move || Ok(rins::allan(&page)?.page()),
            move |folder, overwrite| rins::allan(&write)?.write(folder, overwrite),
        )
    })
}

/// `rins align`.
#[pyfunction]
pub(crate) fn align(py: Python<'_>, log: &Log) -> PyResult<Outcome> {
    let log = log.log();
    Outcome::run(py, Call::new(None), None, move |_| {
        let (page, write) = (Arc::clone(&log), Arc::clone(&log));
        Outcome::of_log(
            &rins::align(&log)?,
            move || Ok(rins::align(&page)?.page()),
            move |folder, overwrite| rins::align(&write)?.write(folder, overwrite),
        )
    })
}

/// `rins navigate`.
#[pyfunction]
pub(crate) fn navigate(
    py: Python<'_>,
    log: &Log,
    calibration: Option<PathBuf>,
    extrapolate: bool,
) -> PyResult<Outcome> {
    let log = log.log();
    let options = NavigateOptions { calibration, extrapolate };
    Outcome::run(py, Call::new(None), None, move |_| {
        let (page, write) = (Arc::clone(&log), Arc::clone(&log));
        let (for_page, for_write) = (options.clone(), options.clone());
        Outcome::of_log(
            &rins::navigate(&log, &options)?,
            move || Ok(rins::navigate(&page, &for_page)?.page()),
            move |folder, overwrite| rins::navigate(&write, &for_write)?.write(folder, overwrite),
        )
    })
}

/// `rins calibrate`.
#[pyfunction]
pub(crate) fn calibrate(
    py: Python<'_>,
    logs: Vec<Py<Log>>,
    model: Option<&str>,
    noise: &str,
    progress: Option<Py<PyAny>>,
) -> PyResult<Outcome> {
    let choice = model.map(ModelChoice::parse).transpose();
    let choice = choice.map_err(|expected| argument("model", expected))?;
    let noise = noise_choice(noise)?;
    let logs = owned(logs);
    Outcome::run(py, Call::new(progress), model, move |progress| {
        let options = CalibrateOptions { model: choice, noise, progress: progress.clone() };
        Outcome::of(rins::calibrate(logs, &options)?)
    })
}

/// The options of a diagnosis.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Diagnose {
    model: String,
    held_out: Option<Py<Log>>,
    transfer: bool,
    hypothesis: Option<PathBuf>,
    noise: String,
    bootstrap: Option<u32>,
}

/// `rins diagnose`.
#[pyfunction]
pub(crate) fn diagnose(
    py: Python<'_>,
    logs: Vec<Py<Log>>,
    options: Diagnose,
    progress: Option<Py<PyAny>>,
) -> PyResult<Outcome> {
    let Diagnose { model, held_out, transfer, hypothesis, noise, bootstrap } = options;
    let choice = ModelChoice::parse_estimated(&model);
    let choice = choice.map_err(|expected| argument("model", expected))?;
    let noise = noise_choice(&noise)?;
    if bootstrap.is_some_and(|draws| !(1..=100_000).contains(&draws)) {
        return Err(argument("bootstrap", "expected 1 to 100000"));
    }
    let logs = owned(logs);
    let held_out = held_out.map(|log| (*log.get().log()).clone());
    let file = hypothesis.as_ref().map(|file| file.to_string_lossy().into_owned());
    Outcome::run(py, Call::new(progress), file.as_deref().or(Some(&model)), move |progress| {
        let options = DiagnoseOptions {
            model: choice,
            held_out,
            transfer,
            hypothesis,
            noise,
            bootstrap,
            progress: progress.clone(),
        };
        Outcome::of(rins::diagnose(logs, options)?)
    })
}

/// `rins demo`.
#[pyfunction]
pub(crate) fn demo(py: Python<'_>, progress: Option<Py<PyAny>>) -> PyResult<Outcome> {
    Outcome::run(py, Call::new(progress), None, |progress| Outcome::of(rins::demo::demo(progress)?))
}
