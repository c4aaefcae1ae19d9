//! What the runs of a campaign found, and the rows of its results.

use nalgebra::{Matrix3, Vector3};
use rins_calibration::Estimate;
use rins_campaign::{PARAMETERS, RunFailure, RunResult};
use rins_frames::units::{ARCSEC, PPM};
use rins_io::{Record, Row};

/// The parameters' units: their names, and what one is in SI units.
pub(crate) const UNITS: [(&str, f64); 3] = [("arcsec", ARCSEC), ("arcsec", ARCSEC), ("ppm", PPM)];

/// The runs of a scenario of the grid, in their order and in the parameters' units.
#[derive(Debug)]
pub(crate) struct Found {
    /// The scenario's place in the grid.
    pub(crate) cell: usize,
    pub(crate) truth: Vector3<f64>,
    /// The runs' numbers, and what they found.
    pub(crate) numbers: Vec<u64>,
    pub(crate) runs: Vec<RunResult>,
}

impl Found {
    /// A scenario of which no run is known yet, where this is true in SI units.
    pub(crate) fn none(cell: usize, truth: &Vector3<f64>) -> Self {
        let truth =
            truth.zip_map(&Vector3::from(UNITS.map(|unit| unit.1)), |truth, unit| truth / unit);
        Self { cell, truth, numbers: Vec::new(), runs: Vec::new() }
    }

    /// Adds a run of this number that was made in SI units.
    pub(crate) fn add(&mut self, number: u64, run: RunResult) {
        self.numbers.push(number);
        self.runs.push(run.map(|found| Estimate {
            value: Vector3::from_fn(|row, _| found.value[row] / UNITS[row].1),
            covariance: Matrix3::from_fn(|row, column| {
                found.covariance[(row, column)] / UNITS[row].1 / UNITS[column].1
            }),
            nis_ratio: found.nis_ratio,
        }));
    }

    /// The scenarios of rows that are in the order of scenarios and runs.
    pub(crate) fn of_rows(rows: &[Row]) -> anyhow::Result<Vec<Self>> {
        let mut all: Vec<Self> = Vec::new();
        for rows in rows.chunks(PARAMETERS.len()) {
            let whole = rows.len() == PARAMETERS.len()
                && rows.iter().zip(PARAMETERS).all(|(row, id)| row.parameter == id);
            anyhow::ensure!(whole, "run {} does not have its three parameters", rows[0].run);
            let cell = usize::try_from(rows[0].cell)?;
            if all.last().is_none_or(|last| last.cell != cell) {
                let truth = Vector3::from_fn(|row, _| rows[row].record.truth);
                all.push(Self { cell, truth, numbers: Vec::new(), runs: Vec::new() });
            }
            if let Some(found) = all.last_mut() {
                found.numbers.push(rows[0].run);
                found.runs.push(result(rows));
            }
        }
        Ok(all)
    }

    /// A row for each run and parameter.
    pub(crate) fn rows(&self) -> impl Iterator<Item = Row> + '_ {
        let runs = self.numbers.iter().zip(&self.runs);
        runs.flat_map(move |(&run, result)| {
            (0..PARAMETERS.len()).map(move |parameter| self.row(run, result, parameter))
        })
    }

    fn row(&self, run: u64, result: &RunResult, parameter: usize) -> Row {
        let (estimate, covariances, nis_ratio) = match result {
            Ok(found) => (
                found.value[parameter],
                [0, 1, 2].map(|other| found.covariance[(parameter, other)]),
                found.nis_ratio,
            ),
            Err(_) => (f64::NAN, [f64::NAN; 3], f64::NAN),
        };
        Row {
            cell: self.cell as u64,
            run,
            parameter: PARAMETERS[parameter].into(),
            unit: UNITS[parameter].0.into(),
            record: Record { truth: self.truth[parameter], estimate, covariances, nis_ratio },
            failure: result.as_ref().err().map_or_else(String::new, |f| f.reason.clone()),
        }
    }
}

fn result(rows: &[Row]) -> RunResult {
    if !rows[0].failure.is_empty() {
        return Err(RunFailure { reason: rows[0].failure.clone() });
    }
    Ok(Estimate {
        value: Vector3::from_fn(|row, _| rows[row].record.estimate),
        covariance: Matrix3::from_fn(|row, column| rows[row].record.covariances[column]),
        nis_ratio: rows[0].record.nis_ratio,
    })
}
