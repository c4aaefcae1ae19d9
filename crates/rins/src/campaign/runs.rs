//! The results of the runs of a campaign, and the rows of its result file.

use nalgebra::{Matrix3, Vector3};
use rins_calibration::Estimate;
use rins_campaign::{PARAMETERS, RunFailure, RunResult};
use rins_frames::units::{ARCSEC, PPM};
use rins_io::{JournalRun, Record, Row, RunRows};

use super::execution::Rows;

/// The units of the parameters: their names and their values in SI units.
pub(super) const UNITS: [(&str, f64); 3] = [("arcsec", ARCSEC), ("arcsec", ARCSEC), ("ppm", PPM)];

/// The result of a run, in the units of the parameters.
#[derive(Debug)]
pub(super) struct Run {
    /// The index of the scenario in the grid.
    pub(super) cell: usize,
    /// The run's number.
    pub(super) number: u64,
    pub(super) truth: Vector3<f64>,
    pub(super) result: RunResult,
}

impl Run {
    /// A run from its result and the true values of its scenario, both in SI units.
    pub(super) fn made(cell: usize, number: u64, truth: &Vector3<f64>, result: RunResult) -> Self {
        let truth =
            truth.zip_map(&Vector3::from(UNITS.map(|unit| unit.1)), |truth, unit| truth / unit);
        let result = result.map(|found| Estimate {
            value: Vector3::from_fn(|row, _| found.value[row] / UNITS[row].1),
            covariance: Matrix3::from_fn(|row, column| {
                found.covariance[(row, column)] / UNITS[row].1 / UNITS[column].1
            }),
            nis_ratio: found.nis_ratio,
        });
        Self { cell, number, truth, result }
    }
}

impl Rows for Run {
    fn read(rows: &RunRows) -> Self {
        let first = &rows[0];
        // An index beyond `usize` cannot belong to a scenario of a grid.
        let cell = usize::try_from(first.cell).unwrap_or(usize::MAX);
        let truth = Vector3::from_fn(|row, _| rows[row].record.truth);
        Self { cell, number: first.run, truth, result: result(rows) }
    }

    fn rows(&self) -> RunRows {
        (0..PARAMETERS.len()).map(|parameter| self.row(parameter)).collect()
    }
}

impl Run {
    fn row(&self, parameter: usize) -> Row {
        let (estimate, covariances, nis_ratio) = match &self.result {
            Ok(found) => (
                found.value[parameter],
                [0, 1, 2].map(|other| found.covariance[(parameter, other)]),
                found.nis_ratio,
            ),
            Err(_) => (f64::NAN, [f64::NAN; 3], f64::NAN),
        };
        Row {
            cell: self.cell as u64,
            run: self.number,
            place: parameter,
            parameter: PARAMETERS[parameter].into(),
            unit: UNITS[parameter].0.into(),
            record: Record {
                truth: self.truth[parameter],
                estimate,
                covariances: covariances.into(),
                nis_ratio,
                of_model: None,
            },
            failure: self.result.as_ref().err().map_or_else(String::new, |f| f.reason.clone()),
        }
    }
}

/// The numbers of a run in the journal: three estimates, their covariance, and the NIS.
pub(super) const NUMBERS: usize = 13;

/// The numbers of a run for the journal, in SI units.
pub(super) fn to_journal(run: &RunResult) -> JournalRun {
    let numbers = |found: &Estimate| {
        let numbers = found.value.iter().chain(found.covariance.iter());
        numbers.copied().chain([found.nis_ratio]).collect()
    };
    run.as_ref().map(numbers).map_err(Clone::clone)
}

/// The result of a run from the journal, in SI units.
pub(super) fn from_journal(run: JournalRun) -> RunResult {
    run.map(|numbers| Estimate {
        value: Vector3::from_column_slice(&numbers[..3]),
        covariance: Matrix3::from_column_slice(&numbers[3..12]),
        nis_ratio: numbers[12],
    })
}

fn result(rows: &RunRows) -> RunResult {
    if !rows[0].failure.is_empty() {
        return Err(RunFailure { reason: rows[0].failure.clone() });
    }
    Ok(Estimate {
        value: Vector3::from_fn(|row, _| rows[row].record.estimate),
        covariance: Matrix3::from_fn(|row, column| rows[row].record.covariances[column]),
        nis_ratio: rows[0].record.nis_ratio,
    })
}
