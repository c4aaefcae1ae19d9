//! A log with its rig, for Python.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use arrow_buffer::{Buffer, ScalarBuffer};
use arrow_schema::ArrowError;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3_arrow::PyTable;
use pyo3_arrow::buffer::PyArrowBuffer;
use rins::io::Rig;

use crate::call::Call;
use crate::columns::{log_columns, log_columns_of_stream};
use crate::error::exception;

/// A log with its rig.
#[pyclass(frozen, module = "rins._rins")]
pub(crate) struct Log {
    log: Arc<rins::Log>,
    signals: OnceLock<Vec<Signal>>,
}

/// A signal of a recording, of one component or three, one after the other in memory.
struct Signal {
    name: &'static str,
    components: usize,
    values: Buffer,
}

impl Log {
    fn of(log: rins::Log) -> Self {
        Self { log: Arc::new(log), signals: OnceLock::new() }
    }

    /// The log of the library.
    pub(crate) fn log(&self) -> Arc<rins::Log> {
        Arc::clone(&self.log)
    }

    /// The signals of the recording, which are computed once and never copied.
    fn signals(&self) -> &[Signal] {
        self.signals.get_or_init(|| {
            let recording = &self.log.loaded.recording;
            let of = |name, values: &Option<Vec<f64>>| {
                let values = Buffer::from_vec(values.clone()?);
                Some(Signal { name, components: 1, values })
            };
            let triad = |name, component: fn(&rins::frames::Increments, usize) -> f64| {
                let mut values = Vec::with_capacity(3 * recording.len());
                for axis in 0..3 {
                    let rate = |sample| component(sample, axis) / sample.interval;
                    values.extend(recording.increments.iter().map(rate));
                }
                Signal { name, components: 3, values: Buffer::from_vec(values) }
            };
            let time = Buffer::from_vec(recording.times.clone());
            let mut signals = vec![
                Signal { name: "t", components: 1, values: time },
                triad("gyro", |sample, axis| sample.angle.components()[axis]),
                triad("accel", |sample, axis| sample.velocity.components()[axis]),
            ];
            signals.extend(of("table_angle", &recording.table_angle));
            signals.extend(of("table_rate", &recording.table_rate));
            signals.extend(of("temperature", &recording.temperature));
            signals
        })
    }

    fn batch(&self) -> Result<RecordBatch, ArrowError> {
        let mut columns: Vec<(String, ArrayRef)> = Vec::new();
        let rows = self.log.loaded.recording.len();
        for Signal { name, components, values } in self.signals() {
            for component in 0..*components {
                let suffix = if *components == 1 { "" } else { ["_x", "_y", "_z"][component] };
                let part = ScalarBuffer::<f64>::new(values.clone(), component * rows, rows);
                columns.push((format!("{name}{suffix}"), Arc::new(Float64Array::new(part, None))));
            }
        }
        RecordBatch::try_from_iter(columns)
    }
}

#[pymethods]
impl Log {
    /// Reads a rig file and its log; with `partial`, a log that may lack sensors.
    #[staticmethod]
    fn open(py: Python<'_>, path: PathBuf, partial: bool) -> PyResult<Self> {
        let open = if partial { rins::Log::open_partial } else { rins::Log::open };
        let log = Call::new(None).run(py, move |_| open(path))?;
        log.map(Self::of).map_err(|error| exception(py, &error, None))
    }

    /// The rig in `text` with columns in memory: pairs of a name and an array.
    #[staticmethod]
    fn of_arrays(
        py: Python<'_>,
        rig: (String, PathBuf),
        name: &str,
        arrays: Vec<(String, Bound<'_, PyAny>)>,
    ) -> PyResult<Self> {
        let columns = log_columns(name, arrays)?;
        Self::of_columns(py, rig, columns)
    }

    /// The rig in `text` with the columns of an object with `__arrow_c_stream__`.
    #[staticmethod]
    fn of_stream(
        py: Python<'_>,
        rig: (String, PathBuf),
        name: &str,
        data: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let columns = log_columns_of_stream(py, name, data)?;
        Self::of_columns(py, rig, columns)
    }

    /// The name: the path of the rig file.
    #[getter]
    fn name(&self) -> &str {
        &self.log.name
    }

    /// The inputs: paths and SHA-256.
    #[getter]
    fn inputs(&self) -> Vec<(String, String)> {
        let of = |file: &rins::io::InputFile| {
            (file.path.to_string_lossy().into_owned(), file.sha256.clone())
        };
        self.log.inputs.iter().map(of).collect()
    }

    /// The repairs made while reading, one sentence each.
    #[getter]
    fn repairs(&self) -> Vec<String> {
        self.log.repairs()
    }

    /// The log compensated with a calibration file, and the remarks on it.
    fn compensated(
        &self,
        py: Python<'_>,
        calibration: PathBuf,
        extrapolate: bool,
    ) -> PyResult<(Self, Vec<String>)> {
        let log = self.log();
        let compensate = move |_: &_| log.compensated(&calibration, extrapolate);
        let done = Call::new(None).run(py, compensate)?;
        let (log, notes) = done.map_err(|error| exception(py, &error, None))?;
        Ok((Self::of(log), notes))
    }

    /// The signals: name, number of components and memory, the components one after the other.
    fn memory(&self) -> Vec<(&'static str, usize, PyArrowBuffer)> {
        let signals = self.signals().iter();
        let shared =
            |one: &Signal| (one.name, one.components, PyArrowBuffer::new(one.values.clone()));
        signals.map(shared).collect()
    }

    /// The signals as an Arrow table that shares their memory.
    fn table(&self) -> PyResult<PyTable> {
        let failed = |error: ArrowError| PyRuntimeError::new_err(error.to_string());
        let batch = self.batch().map_err(failed)?;
        let schema = batch.schema();
        PyTable::try_new(vec![batch], schema)
    }

    fn __len__(&self) -> usize {
        self.log.loaded.recording.len()
    }
}

impl Log {
    fn of_columns(
        py: Python<'_>,
        (text, path): (String, PathBuf),
        columns: rins::io::LogColumns,
    ) -> PyResult<Self> {
        let read = move |_: &_| rins::Log::of_columns(&text, path, columns);
        let log = Call::new(None).run(py, read)?;
        log.map(Self::of).map_err(|error| exception(py, &error, None))
    }
}

/// Checks the content of a rig file.
#[pyfunction]
pub(crate) fn check_rig(py: Python<'_>, text: &str, path: &str) -> PyResult<()> {
    match Rig::parse(text, path.as_ref()) {
        Ok(_) => Ok(()),
        Err(error) => Err(exception(py, &error.into(), None)),
    }
}
