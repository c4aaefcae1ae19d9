//! Functions of files.

use std::path::PathBuf;

use pyo3::prelude::*;
use rins::io::quantity::kinds;
use rins::io::{LogFile, Quantity, date_seconds};
use rins::mission::WantedFigure;
use rins::observe::Want;
use rins::{ApplyOptions, ConvertOptions, HistoryOptions, MissionOptions, ObserveOptions};

use crate::call::Call;
use crate::error::argument;
use crate::outcome::{Outcome, overwrite};
use crate::quantity::{positive, quantity};

/// `rins init`; the rig file is not written.
#[pyfunction]
pub(crate) fn init(py: Python<'_>, log: PathBuf, output: Option<PathBuf>) -> PyResult<Outcome> {
    Outcome::run(py, Call::new(None), None, move |_| {
        Outcome::of(rins::init(&log, output.as_deref())?)
    })
}

/// `rins simulate`.
#[pyfunction]
pub(crate) fn simulate(py: Python<'_>, scenario: PathBuf, seed: Option<u64>) -> PyResult<Outcome> {
    Outcome::run(py, Call::new(None), None, move |_| Outcome::of(rins::simulate(&scenario, seed)?))
}

/// A format of a log that is written, as the command names it.
fn format(name: Option<&str>) -> PyResult<Option<LogFile>> {
    Ok(Some(match name {
        None => return Ok(None),
        Some("csv") => LogFile::Csv,
        Some("parquet") => LogFile::Parquet,
        Some("mat") => LogFile::Mat,
        Some("psins") => LogFile::Psins,
        Some("psins-bin") => LogFile::PsinsBinary,
        Some("kf-gins") => LogFile::KfGins,
        Some("euroc") => LogFile::Euroc,
        Some(other) => {
            let known = "csv, parquet, mat, psins, psins-bin, kf-gins or euroc";
            return Err(argument("format", format!("{other:?}, expected {known}")));
        }
    }))
}

/// `rins convert`.
#[pyfunction]
pub(crate) fn convert(
    py: Python<'_>,
    rig: PathBuf,
    output: PathBuf,
    format: Option<&str>,
    force: bool,
) -> PyResult<Outcome> {
    let format = self::format(format)?;
    let options = ConvertOptions { output, format, overwrite: overwrite(force) };
    Outcome::run(py, Call::new(None), None, move |_| Outcome::of(rins::convert(&rig, options)?))
}

/// The options of a compensation.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Apply {
    calibration: PathBuf,
    output: PathBuf,
    format: Option<String>,
    extrapolate: bool,
    force: bool,
}

/// `rins apply`.
#[pyfunction]
pub(crate) fn apply(py: Python<'_>, rig: PathBuf, options: Apply) -> PyResult<Outcome> {
    let Apply { calibration, output, format, extrapolate, force } = options;
    let format = self::format(format.as_deref())?;
    let overwrite = overwrite(force);
    let options = ApplyOptions { calibration, output, format, extrapolate, overwrite };
    Outcome::run(py, Call::new(None), None, move |_| Outcome::of(rins::apply(&rig, options)?))
}

/// `rins compare`.
#[pyfunction]
pub(crate) fn compare(py: Python<'_>, before: PathBuf, after: PathBuf) -> PyResult<Outcome> {
    Outcome::run(py, Call::new(None), None, move |_| Outcome::of(rins::compare(&before, &after)?))
}

/// The conditions of the run to be predicted.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Conditions {
    date: Option<String>,
    temperature: Option<f64>,
    minutes_since_power_on: Option<f64>,
}

/// `rins history`.
#[pyfunction]
pub(crate) fn history(
    py: Python<'_>,
    runs: Vec<PathBuf>,
    conditions: Conditions,
    progress: Option<Py<PyAny>>,
) -> PyResult<Outcome> {
    let Conditions { date, temperature, minutes_since_power_on } = conditions;
    let seconds = |text: String| {
        date_seconds(&text).ok_or_else(|| {
            let expected =
                "expected a date and time with its offset from UTC, such as 2027-01-31T00:00:00Z";
            argument("date", expected)
        })
    };
    let date = date.map(seconds).transpose()?;
    for (name, number) in
        [("temperature", temperature), ("minutes_since_power_on", minutes_since_power_on)]
    {
        if number.is_some_and(|number| !number.is_finite()) {
            return Err(argument(name, "expected a finite number"));
        }
    }
    let since_power_on = minutes_since_power_on.map(|minutes| 60.0 * minutes);
    Outcome::run(py, Call::new(progress), None, move |progress| {
        let progress = progress.clone();
        let options = HistoryOptions { date, temperature, since_power_on, progress };
        Outcome::of(rins::history(&runs, &options)?)
    })
}

/// The options of a mission.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Mission {
    calibration: Option<PathBuf>,
    runs: Option<u32>,
    seed: u64,
    want: Option<String>,
}

/// `rins mission`.
#[pyfunction]
pub(crate) fn mission(
    py: Python<'_>,
    file: PathBuf,
    options: Mission,
    progress: Option<Py<PyAny>>,
) -> PyResult<Outcome> {
    let Mission { calibration, runs, seed, want } = options;
    let want = want.as_deref().map(WantedFigure::parse).transpose();
    let want = want.map_err(|expected| argument("want", expected))?;
    Outcome::run(py, Call::new(progress), None, move |progress| {
        let progress = progress.clone();
        let options = MissionOptions { calibration, runs, seed, want, progress };
        Outcome::of(rins::mission(&file, &options)?)
    })
}

/// The options of a study of observability.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Observe {
    model: Option<String>,
    compare: bool,
    separate: Option<[String; 2]>,
    want: Option<(String, String)>,
    max_rate: Option<String>,
    max_acceleration: Option<String>,
    max_duration: String,
    directions: usize,
}

impl Observe {
    fn options(self) -> PyResult<ObserveOptions> {
        if self.separate.is_some() && self.want.is_some() {
            return Err(argument("want", "separate and want exclude each other"));
        }
        if !(1..=3).contains(&self.directions) {
            return Err(argument("directions", "expected 1, 2 or 3"));
        }
        let want = |(id, typed): (String, String)| {
            let sigma = Quantity::parse(&typed).map_err(|error| argument("want", error))?;
            positive("want", sigma.value)?;
            PyResult::Ok(Want { id, sigma, typed })
        };
        let max_rate = self
            .max_rate
            .map(|text| positive("max_rate", quantity("max_rate", &kinds::TABLE_RATE, &text)?));
        let max_acceleration = self
            .max_acceleration
            .map(|text| quantity("max_acceleration", &kinds::TABLE_ACCELERATION, &text));
        Ok(ObserveOptions {
            model: self.model,
            compare: self.compare,
            separate: self.separate,
            want: self.want.map(want).transpose()?,
            max_rate: max_rate.transpose()?,
            max_acceleration: max_acceleration.transpose()?,
            max_duration: quantity("max_duration", &kinds::DURATION, &self.max_duration)?,
            directions: self.directions,
            ..ObserveOptions::default()
        })
    }
}

/// `rins observe`.
#[pyfunction]
pub(crate) fn observe(
    py: Python<'_>,
    scenarios: Vec<PathBuf>,
    options: Observe,
    progress: Option<Py<PyAny>>,
) -> PyResult<Outcome> {
    let model = options.model.clone();
    let options = options.options()?;
    Outcome::run(py, Call::new(progress), model.as_deref(), move |progress| {
        let options = ObserveOptions { progress: progress.clone(), ..options };
        Outcome::of(rins::observe(&scenarios, &options)?)
    })
}
