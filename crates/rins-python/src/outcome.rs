//! The outcome of a command, for Python.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pyo3::prelude::*;
use rins::{Overwrite, Progress};

use crate::call::Call;
use crate::error::exception;

type Write = dyn Fn(&Path, Overwrite) -> rins::Result<Option<PathBuf>> + Send + Sync;
type Page = dyn Fn() -> rins::Result<Option<String>> + Send + Sync;

/// The outcome of a command: its text, its result as JSON, its page and its files.
#[pyclass(frozen, module = "rins._rins")]
pub(crate) struct Outcome {
    text: String,
    json: String,
    failure: Option<String>,
    page: Arc<Page>,
    write: Arc<Write>,
}

impl Outcome {
    /// An outcome that owns its data.
    pub(crate) fn of(outcome: impl rins::Outcome + Send + Sync + 'static) -> rins::Result<Self> {
        let outcome = Arc::new(outcome);
        let again = Arc::clone(&outcome);
        Ok(Self {
            text: outcome.to_string(),
            json: outcome.json()?,
            failure: outcome.failure(),
            page: Arc::new(move || Ok(again.page())),
            write: Arc::new(move |folder, overwrite| outcome.write(folder, overwrite)),
        })
    }

    /// An outcome that borrows a log: for its page and its files, `again` computes it again.
    pub(crate) fn of_log(
        outcome: &impl rins::Outcome,
        page: impl Fn() -> rins::Result<Option<String>> + Send + Sync + 'static,
        write: impl Fn(&Path, Overwrite) -> rins::Result<Option<PathBuf>> + Send + Sync + 'static,
    ) -> rins::Result<Self> {
        let (text, json, failure) = (outcome.to_string(), outcome.json()?, outcome.failure());
        Ok(Self { text, json, failure, page: Arc::new(page), write: Arc::new(write) })
    }

    /// Does a call whose result is an outcome. `model` is the model file, if there is one.
    pub(crate) fn run(
        py: Python<'_>,
        call: Call,
        model: Option<&str>,
        work: impl FnOnce(&Progress) -> rins::Result<Self> + Send + 'static,
    ) -> PyResult<Self> {
        call.run(py, work)?.map_err(|error| exception(py, &error, model))
    }
}

#[pymethods]
impl Outcome {
    /// The text that the command prints.
    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    /// The line that the command prints with `--json`, without its line feed.
    #[getter]
    fn json(&self) -> &str {
        &self.json
    }

    /// The defect of the data, if there is one in spite of the result.
    #[getter]
    fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    /// The report page, if there is one.
    fn page(&self, py: Python<'_>) -> PyResult<Option<String>> {
        let page = Arc::clone(&self.page);
        let page = Call::new(None).run(py, move |_| page())?;
        page.map_err(|error| exception(py, &error, None))
    }

    /// Writes the folder that the command writes with `-o`; returns the path of the page, if there is one.
    fn write(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<Option<PathBuf>> {
        let write = Arc::clone(&self.write);
        let written = Call::new(None).run(py, move |_| write(&folder, overwrite(force)))?;
        written.map_err(|error| exception(py, &error, None))
    }
}

/// What happens to existing results.
pub(crate) fn overwrite(force: bool) -> Overwrite {
    if force { Overwrite::Force } else { Overwrite::Refuse }
}
