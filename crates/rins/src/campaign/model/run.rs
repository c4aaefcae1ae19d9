//! The result of a run of a campaign of a model: its numbers in the journal, and its rows in the result file.

use std::sync::Arc;

use nalgebra::DMatrix;
use rins_campaign::{Nees, PosteriorRun, RunFailure};
use rins_estimation::Fit;
use rins_io::{JournalRun, ModelRecord, Record, Row, RunRows};
use statrs::distribution::{ContinuousCDF, Normal};

use crate::campaign::execution::Rows;

/// A step of the iteration below this many sigmas is negligible: it increases the mean square error by one percent.
const NEGLIGIBLE: f64 = 0.1;

/// Why a posterior cannot be compared with true values.
const NOT_SOUND: &str = "the covariance is not positive, or a number is not finite";

/// The numbers of a run in the journal other than estimates and covariance.
const OTHERS: usize = 5;

/// An estimated parameter of a campaign.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::campaign) struct CampaignParameter {
    pub(super) id: String,
    pub(super) unit: String,
    /// In that unit.
    pub(super) prior_sigma: f64,
}

/// A run of a campaign of a model, in the units of the parameters.
#[derive(Clone, Debug)]
pub(in crate::campaign) struct ModelRun {
    /// The index of the scenario in the grid.
    pub(super) cell: usize,
    /// The run's number.
    pub(super) number: u64,
    pub(super) parameters: Arc<[CampaignParameter]>,
    pub(super) truth: Vec<f64>,
    pub(super) result: Result<ModelEstimate, RunFailure>,
}

/// The estimate of a run, in the units of the parameters.
#[derive(Clone, Debug)]
pub(super) struct ModelEstimate {
    pub(super) posterior: PosteriorRun,
    pub(super) nis_ratio: f64,
    pub(super) nees: Nees,
    pub(super) iterations: u64,
    pub(super) converged: bool,
}

/// The number of numbers of a run in the journal.
pub(super) const fn numbers(parameters: usize) -> usize {
    parameters + parameters * (parameters + 1) / 2 + OTHERS
}

/// The numbers of an estimate for the journal: values and the lower triangle of their covariance \[SI\], and those of the run.
pub(super) fn to_journal(fit: &Fit, truth: &[f64]) -> anyhow::Result<Vec<f64>> {
    let n = fit.parameters.len();
    let estimate: Vec<f64> = fit.parameters.iter().map(|one| one.value).collect();
    let prior_sigmas: Vec<f64> = fit.parameters.iter().map(|one| one.parameter.sigma).collect();
    let pull = fit.parameters.iter().map(|one| {
        let normalized = (one.value - one.expected) / one.parameter.sigma;
        normalized * normalized
    });
    // The squared innovations of a filter whose states are the parameters: one for each measurement if the model is correct.
    let squares = fit.evidence.square + pull.sum::<f64>();
    let covariance = symmetric(n, |row, column| fit.covariance[(row, column)]);
    let run = PosteriorRun { truth: truth.into(), estimate, prior_sigmas, covariance };
    anyhow::ensure!(run.is_sound(), NOT_SOUND);
    let nees = Nees::of(&run);
    let last = fit.iterations.last().map_or(f64::INFINITY, |iteration| iteration.step);
    let mut numbers = run.estimate;
    numbers.extend(lower(n).map(|place| run.covariance[place]));
    numbers.extend([
        squares / fit.evidence.figures as f64,
        nees.value,
        nees.dof as f64,
        fit.iterations.len() as f64,
        f64::from(u8::from(last < NEGLIGIBLE)),
    ]);
    Ok(numbers)
}

/// The places of the lower triangle of an n × n matrix, row by row.
fn lower(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(|row| (0..=row).map(move |column| (row, column)))
}

/// The symmetric n × n matrix with this lower triangle.
fn symmetric(n: usize, of: impl Fn(usize, usize) -> f64) -> DMatrix<f64> {
    DMatrix::from_fn(n, n, |row, column| of(row.max(column), row.min(column)))
}

/// The whole number in the journal.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a count that was written as a number"
)]
fn count(number: f64) -> u64 {
    number as u64
}

impl ModelRun {
    /// A run from the journal; `factors` are the units in SI units.
    pub(super) fn of_journal(
        (cell, number): (usize, u64),
        parameters: &Arc<[CampaignParameter]>,
        factors: &[f64],
        truth: &[f64],
        numbers: JournalRun,
    ) -> Self {
        let n = parameters.len();
        let truth: Vec<f64> = truth.iter().zip(factors).map(|(value, unit)| value / unit).collect();
        let result = numbers.map(|numbers| {
            let (values, numbers) = numbers.split_at(n);
            let (triangle, others) = numbers.split_at(n * (n + 1) / 2);
            let posterior = PosteriorRun {
                truth: truth.clone(),
                estimate: values.iter().zip(factors).map(|(value, unit)| value / unit).collect(),
                prior_sigmas: parameters.iter().map(|one| one.prior_sigma).collect(),
                covariance: symmetric(n, |row, column| {
                    triangle[row * (row + 1) / 2 + column] / factors[row] / factors[column]
                }),
            };
            ModelEstimate {
                posterior,
                nis_ratio: others[0],
                nees: Nees {
                    value: others[1],
                    dof: usize::try_from(count(others[2])).unwrap_or_default(),
                },
                iterations: count(others[3]),
                converged: count(others[4]) != 0,
            }
        });
        Self { cell, number, parameters: parameters.clone(), truth, result }
    }

    fn row(&self, place: usize) -> Row {
        let parameter = &self.parameters[place];
        let (truth, prior_sigma) = (self.truth[place], parameter.prior_sigma);
        let record = match &self.result {
            Ok(found) => {
                let posterior = &found.posterior;
                let estimate = posterior.estimate[place];
                let sigma = posterior.covariance[(place, place)].sqrt();
                Record {
                    truth,
                    estimate,
                    covariances: posterior.covariance.row(place).iter().copied().collect(),
                    nis_ratio: found.nis_ratio,
                    of_model: Some(ModelRecord {
                        prior_sigma,
                        rank: Normal::standard().cdf((truth - estimate) / sigma),
                        nees: found.nees.value,
                        nees_dof: found.nees.dof as u64,
                        iterations: found.iterations,
                        converged: found.converged,
                    }),
                }
            }
            Err(_) => Record {
                truth,
                estimate: f64::NAN,
                covariances: vec![f64::NAN; self.parameters.len()],
                nis_ratio: f64::NAN,
                of_model: Some(ModelRecord {
                    prior_sigma,
                    rank: f64::NAN,
                    nees: f64::NAN,
                    nees_dof: 0,
                    iterations: 0,
                    converged: false,
                }),
            },
        };
        Row {
            cell: self.cell as u64,
            run: self.number,
            place,
            parameter: parameter.id.clone(),
            unit: parameter.unit.clone(),
            record,
            failure: self.result.as_ref().err().map_or_else(String::new, |f| f.reason.clone()),
        }
    }
}

impl Rows for ModelRun {
    fn rows(&self) -> RunRows {
        (0..self.parameters.len()).map(|place| self.row(place)).collect()
    }

    fn read(rows: &RunRows) -> Self {
        let first = &rows[0];
        let none = ModelRecord {
            prior_sigma: f64::NAN,
            rank: f64::NAN,
            nees: f64::NAN,
            nees_dof: 0,
            iterations: 0,
            converged: false,
        };
        let of_model = |row: &Row| row.record.of_model.unwrap_or(none);
        let parameters: Arc<[CampaignParameter]> = rows
            .iter()
            .map(|row| CampaignParameter {
                id: row.parameter.clone(),
                unit: row.unit.clone(),
                prior_sigma: of_model(row).prior_sigma,
            })
            .collect();
        let truth: Vec<f64> = rows.iter().map(|row| row.record.truth).collect();
        let run = of_model(first);
        let posterior = PosteriorRun {
            truth: truth.clone(),
            estimate: rows.iter().map(|row| row.record.estimate).collect(),
            prior_sigmas: parameters.iter().map(|one| one.prior_sigma).collect(),
            covariance: DMatrix::from_fn(rows.len(), rows.len(), |row, column| {
                rows[row].record.covariances[column]
            }),
        };
        let result = if !first.failure.is_empty() {
            Err(RunFailure { reason: first.failure.clone() })
        } else if !posterior.is_sound() {
            // Only a damaged file has such numbers.
            Err(RunFailure { reason: NOT_SOUND.into() })
        } else {
            let dof = usize::try_from(run.nees_dof).unwrap_or_default();
            Ok(ModelEstimate {
                posterior,
                nis_ratio: first.record.nis_ratio,
                nees: Nees { value: run.nees, dof },
                iterations: run.iterations,
                converged: run.converged,
            })
        };
        // An index beyond `usize` cannot belong to a scenario of a grid.
        let cell = usize::try_from(first.cell).unwrap_or(usize::MAX);
        Self { cell, number: first.run, parameters, truth, result }
    }
}
