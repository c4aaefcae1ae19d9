//! Design of a rotation schedule.

use std::path::PathBuf;

use pyo3::prelude::*;
use rins::io::Axes;
use rins::io::quantity::kinds;
use rins::{DesignGoal, DesignOptions};

use crate::call::Call;
use crate::error::argument;
use crate::outcome::Outcome;
use crate::quantity::{positive, quantity};

/// The options of a design.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Design {
    goal: String,
    model: Option<String>,
    duration: Option<String>,
    max_rate: Option<String>,
    max_acceleration: Option<String>,
    directions: usize,
    tilts: Option<Vec<String>>,
    mountings: Vec<String>,
    service: Option<PathBuf>,
}

impl Design {
    fn options(self) -> PyResult<DesignOptions> {
        if !(1..=6).contains(&self.directions) {
            return Err(argument("directions", "expected 1 to 6"));
        }
        let goal = DesignGoal::parse(&self.goal).map_err(|expected| argument("goal", expected))?;
        let limit = |name, kind, text: Option<String>| {
            text.map(|text| positive(name, quantity(name, kind, &text)?)).transpose()
        };
        let tilt = |text: String| quantity("tilts", &kinds::TURN, &text);
        let tilts = self.tilts.map(|tilts| tilts.into_iter().map(tilt).collect()).transpose()?;
        let mounting = |name: String| {
            Axes::spin(&name).ok_or_else(|| argument("mountings", "expected x, y, z, -x, -y or -z"))
        };
        Ok(DesignOptions {
            model: self.model,
            duration: limit("duration", &kinds::DURATION, self.duration)?,
            max_rate: limit("max_rate", &kinds::TABLE_RATE, self.max_rate)?,
            max_acceleration: limit(
                "max_acceleration",
                &kinds::TABLE_ACCELERATION,
                self.max_acceleration,
            )?,
            directions: self.directions,
            tilts,
            mountings: self.mountings.into_iter().map(mounting).collect::<PyResult<_>>()?,
            service: self.service,
            ..DesignOptions::new(goal)
        })
    }
}

/// `rins design`.
#[pyfunction]
pub(crate) fn design(
    py: Python<'_>,
    scenarios: Vec<PathBuf>,
    options: Design,
    progress: Option<Py<PyAny>>,
) -> PyResult<Outcome> {
    let model = options.model.clone();
    let options = options.options()?;
    Outcome::run(py, Call::new(progress), model.as_deref(), move |progress| {
        let options = DesignOptions { progress: progress.clone(), ..options };
        Outcome::of(rins::design(&scenarios, &options)?)
    })
}
