//! A history, for a machine.

use rins_history::{Conditions, Forecast};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Predicted, RunHistory, Score};
use crate::basis::BasisResult;
use crate::homogeneity::{HomogeneityResult, INTERVAL, VariationResult};
use crate::log::DAY;
use crate::values::EstimateResult;

/// The result of `rins history`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HistoryResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `history`.
    pub command: String,
    /// The runs, in order of their dates, or as they were given.
    pub runs: Vec<RunConditionsResult>,
    /// The test of each parameter whether it is the same in all runs.
    pub homogeneity: Vec<HomogeneityResult>,
    /// How parameters vary between runs, the most significant first.
    pub causes: Vec<VariationResult>,
    /// Each parameter in the run that is predicted.
    pub forecast: Vec<ForecastResult>,
    /// The conditions of that run.
    pub forecast_conditions: RunConditionsResult,
    /// How well runs are predicted from the runs before them.
    pub prediction: Vec<PredictionResult>,
    /// What else is to be known.
    pub notes: Vec<String>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// The conditions of a run; null where they are not known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RunConditionsResult {
    /// The path of its file; null of the run that is predicted.
    pub file: Option<String>,
    /// The unit, numbered from zero.
    pub unit: usize,
    /// The power-on: runs of one power-on have the same number.
    pub power_on: usize,
    /// The date, since 1970 \[s\].
    pub date_s: Option<f64>,
    /// The time since power-on \[s\].
    pub since_power_on_s: Option<f64>,
    /// The mean temperature \[°C\].
    pub temperature_degc: Option<f64>,
}

/// The forecast of a parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ForecastResult {
    /// The parameter.
    pub id: String,
    /// Its unit.
    pub unit: String,
    /// The mean and the standard deviation of the predictive distribution; null if there is none.
    pub value: Option<EstimateResult>,
    /// The 95 % interval.
    pub interval_95: Option<IntervalResult>,
    /// Why there is none.
    pub why: Option<String>,
}

/// An interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct IntervalResult {
    /// Its lower end.
    pub low: f64,
    /// Its upper end.
    pub high: f64,
}

/// How well a parameter is predicted in each run from the runs before it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PredictionResult {
    /// The parameter.
    pub id: String,
    /// Its unit.
    pub unit: String,
    /// The runs that were predicted.
    pub runs: Vec<RunValueResult>,
    /// The mean continuous ranked probability scores: the smaller the better, in the unit of the parameter.
    pub crps: Option<ScoreResult>,
}

/// A run against its forecast.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RunValueResult {
    /// The run, from zero.
    pub run: usize,
    /// Its estimate.
    pub estimate: EstimateResult,
    /// The 95 % interval in which the estimate was predicted.
    pub interval_95: IntervalResult,
    /// Whether it is inside.
    pub inside: bool,
}

/// The scores of forecasts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScoreResult {
    /// Of the average over all hypotheses.
    pub forecast: f64,
    /// Of the last value.
    pub last_value: f64,
    /// Of the mean.
    pub mean: f64,
    /// Of the line over the date.
    pub line: f64,
}

impl RunConditionsResult {
    fn of(file: Option<String>, conditions: &Conditions) -> Self {
        Self {
            file,
            unit: conditions.unit,
            power_on: conditions.power_on,
            date_s: conditions.date.map(|days| days * DAY),
            since_power_on_s: conditions.since_power_on,
            temperature_degc: conditions.temperature,
        }
    }
}

fn interval(forecast: &Forecast) -> IntervalResult {
    let (low, high) = forecast.interval(INTERVAL);
    IntervalResult { low, high }
}

impl PredictionResult {
    fn of(id: &str, unit: &str, score: &Score) -> Self {
        let run = |(run, forecast, value, sigma): &(usize, Forecast, f64, f64)| {
            let interval_95 = interval(forecast);
            RunValueResult {
                run: *run,
                estimate: EstimateResult { value: *value, sigma: *sigma },
                inside: interval_95.low <= *value && *value <= interval_95.high,
                interval_95,
            }
        };
        Self {
            id: id.into(),
            unit: unit.into(),
            runs: score.runs.iter().map(run).collect(),
            crps: score.crps.map(|[forecast, last_value, mean, line]| ScoreResult {
                forecast,
                last_value,
                mean,
                line,
            }),
        }
    }
}

impl From<&RunHistory> for HistoryResult {
    fn from(of: &RunHistory) -> Self {
        let comparison = &of.comparison;
        let runs = comparison.names.iter().zip(comparison.history.runs());
        let parameters = || comparison.history.quantities().iter().zip(&comparison.units);
        let forecast = |((one, unit), forecast): ((&rins_history::Quantity, &&str), &Predicted)| {
            let (found, why) = match forecast {
                Predicted::Forecast(forecast) => (Some(forecast), None),
                Predicted::Lacks(why) => (None, Some(why.clone())),
            };
            ForecastResult {
                id: one.id.clone(),
                unit: (*unit).into(),
                value: found.map(|one| EstimateResult { value: one.mean(), sigma: one.sigma() }),
                interval_95: found.map(interval),
                why,
            }
        };
        Self {
            schema: crate::SCHEMA,
            command: "history".into(),
            runs: runs
                .map(|(name, run)| RunConditionsResult::of(Some(name.clone()), &run.conditions))
                .collect(),
            homogeneity: HomogeneityResult::all(comparison),
            causes: VariationResult::all(comparison),
            forecast: parameters().zip(&of.forecasts).map(forecast).collect(),
            forecast_conditions: RunConditionsResult::of(None, &of.next),
            prediction: parameters()
                .zip(&of.scores)
                .map(|((one, unit), score)| PredictionResult::of(&one.id, unit, score))
                .collect(),
            notes: of.remarks.clone(),
            basis: of.basis.clone(),
        }
    }
}
