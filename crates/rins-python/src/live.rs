//! A calibration while its log is written.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use rins::ModelChoice;
use rins::live::{LiveEnd, LiveOptions, LiveParameterResult};

use crate::call::Call;
use crate::error::{argument, exception};
use crate::outcome::Outcome;

/// The number of bytes after which signals are looked at.
const PORTION: usize = 1 << 14;

/// The id, value, sigma, unit, prior sigma of a parameter, and whether it is identified.
type Parameter = (String, f64, f64, String, f64, bool);

/// The options of a live calibration.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Live {
    model: String,
    duration: Option<f64>,
    start: f64,
    source: Option<PathBuf>,
    checkpoint: Option<PathBuf>,
}

/// `rins calibrate --live`, fed by its caller.
#[pyclass(frozen, module = "rins._rins")]
pub(crate) struct LiveCalibration {
    /// None after its end.
    live: Mutex<Option<rins::live::LiveCalibration>>,
    model: String,
}

impl LiveCalibration {
    fn state(&self) -> MutexGuard<'_, Option<rins::live::LiveCalibration>> {
        self.live.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Does something with the calibration, without the GIL.
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut rins::live::LiveCalibration) -> rins::Result<T> + Send,
    ) -> PyResult<T> {
        let done = py.detach(|| self.state().as_mut().map(work));
        let done = done.ok_or_else(ended)?;
        done.map_err(|error| exception(py, &error, Some(&self.model)))
    }
}

fn ended() -> PyErr {
    PyValueError::new_err("the calibration has ended")
}

#[pymethods]
impl LiveCalibration {
    #[new]
    fn new(py: Python<'_>, rig: PathBuf, options: Live) -> PyResult<Self> {
        let Live { model, duration, start, source, checkpoint } = options;
        for (name, seconds) in [("duration", duration), ("start", Some(start))] {
            if seconds.is_some_and(|seconds| !(1e-3..=1e9).contains(&seconds)) {
                return Err(argument(name, "expected a number of seconds from 0.001 to 1e9"));
            }
        }
        let choice = ModelChoice::parse(&model)
            .map_err(|expected| argument("model", format!("{model:?}, {expected}")))?;
        let options = LiveOptions { model: choice, duration, start };
        let live = py.detach(move || match &checkpoint {
            None => rins::live::LiveCalibration::new(&rig, source.as_deref(), options),
            Some(file) => {
                let source = source.as_deref();
                rins::live::LiveCalibration::resume(&rig, source, options, file)
            }
        });
        let live = live.map_err(|error| exception(py, &error, Some(&model)))?;
        Ok(Self { live: Mutex::new(Some(live)), model })
    }

    /// Takes the next bytes of the log; returns the number of samples that they complete.
    #[expect(clippy::needless_pass_by_value, reason = "a reference is no argument for Python")]
    fn feed(&self, py: Python<'_>, data: PyBackedBytes) -> PyResult<usize> {
        let mut samples = self.with(py, |_| Ok(0))?;
        for portion in data.chunks(PORTION) {
            samples += self.with(py, |live| live.feed(portion))?;
            py.check_signals()?;
        }
        Ok(samples)
    }

    /// The time of the last epoch \[s\], once the samples at the start are there.
    #[getter]
    fn time(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        self.with(py, |live| Ok(live.filter().and_then(rins::estimation::OnlineFilter::time)))
    }

    /// The estimates so far, once the samples at the start are there.
    #[getter]
    fn parameters(&self, py: Python<'_>) -> PyResult<Option<Vec<Parameter>>> {
        let of = |one: LiveParameterResult| {
            (one.id, one.value, one.sigma, one.unit, one.prior_sigma, one.identified)
        };
        self.with(py, |live| Ok(live.parameters().map(|all| all.into_iter().map(of).collect())))
    }

    /// The state in a line.
    fn line(&self, py: Python<'_>) -> PyResult<String> {
        self.with(py, |live| Ok(live.line()))
    }

    /// Writes the state to a file; returns whether there is a state yet.
    fn write_checkpoint(&self, py: Python<'_>, path: PathBuf) -> PyResult<bool> {
        self.with(py, move |live| live.write_checkpoint(&path))
    }

    /// Ends the calibration with the rows that are there.
    fn end(&self, py: Python<'_>) -> PyResult<Outcome> {
        let live = py.detach(|| self.state().take()).ok_or_else(ended)?;
        Outcome::run(py, Call::new(None), Some(&self.model), move |_| {
            Outcome::of(live.end(LiveEnd::Closed)?)
        })
    }
}
