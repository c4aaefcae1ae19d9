//! A history, for a machine.

use rins_history::{Cause, Conditions, Forecast, Homogeneity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::text::amount;
use super::{INTERVAL, Predicted, RunComparison, RunHistory, Score};
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

/// The test whether a parameter is the same in all runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HomogeneityResult {
    /// The parameter.
    pub id: String,
    /// Its unit.
    pub unit: String,
    /// The p-value of the test of this parameter, all others being the same in all runs.
    pub p_value: f64,
    /// The p-value if the more significant parameters are not: correlated estimates may make several differ where one does.
    pub p_value_beside_others: f64,
    /// The chi-square statistic.
    pub chi_square: f64,
    /// Its degrees of freedom.
    pub dof: usize,
    /// The estimate from each run; null where the run does not observe it.
    pub per_run: Vec<Option<EstimateResult>>,
}

/// A parameter that varies between runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VariationResult {
    /// The parameter.
    pub id: String,
    /// The variation: `drift`, `drift_since_power_on`, `warm_up`, `temperature_linear`, `temperature_quadratic`, `temperature_cubic`,
    /// `thermal_hysteresis`, `turn_on`, `scatter`, `random_walk`, `change`, `unit` or `run`.
    pub variation: String,
    /// `runs`.
    pub across: String,
    /// The p-value, family-wise over all parameters: a bound by Markov's inequality.
    pub p_value: f64,
    /// The variation in words, with its size.
    pub meaning: String,
    /// The unit of the parameter.
    pub unit: String,
    /// The amplitudes: the change over all runs; of a warm-up the value at power-on; of a polynomial the coefficients of its Legendre
    /// polynomials; of what is random the deviation of each group of runs.
    pub amplitudes: Vec<EstimateResult>,
    /// The credible set of 98 %: what may be there in its place, with posterior probabilities.
    pub alternatives: Vec<AlternativeResult>,
}

/// A member of a credible set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AlternativeResult {
    /// The parameter.
    pub id: String,
    /// The variation.
    pub variation: String,
    /// Its posterior probability.
    pub probability: f64,
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
            date_s: conditions.date.map(|days| days * 86_400.0),
            since_power_on_s: conditions.since_power_on,
            temperature_degc: conditions.temperature,
        }
    }
}

fn interval(forecast: &Forecast) -> IntervalResult {
    let (low, high) = forecast.interval(INTERVAL);
    IntervalResult { low, high }
}

impl HomogeneityResult {
    /// Of all parameters.
    pub(crate) fn all(comparison: &RunComparison) -> Vec<Self> {
        let each = comparison.homogeneity.iter().zip(&comparison.units);
        each.map(|(one, unit)| Self::of(one, unit)).collect()
    }

    fn of(one: &Homogeneity, unit: &str) -> Self {
        let values = one.values.iter();
        Self {
            id: one.id.clone(),
            unit: unit.into(),
            p_value: one.ln_p.exp(),
            p_value_beside_others: one.ln_p_beside.exp(),
            chi_square: one.chi_square,
            dof: one.dof,
            per_run: values
                .map(|value| value.map(|(value, sigma)| EstimateResult { value, sigma }))
                .collect(),
        }
    }
}

impl VariationResult {
    /// Of all causes.
    pub(crate) fn all(comparison: &RunComparison) -> Vec<Self> {
        comparison.causes().iter().map(|cause| Self::of(comparison, cause)).collect()
    }

    fn of(comparison: &RunComparison, cause: &Cause) -> Self {
        let alternative = |one: &rins_history::Alternative| AlternativeResult {
            id: one.id.clone(),
            variation: one.kind.id().into(),
            probability: one.probability,
        };
        Self {
            id: cause.id.clone(),
            variation: cause.variation.kind().id().into(),
            across: "runs".into(),
            p_value: cause.ln_p.exp(),
            meaning: format!("{}: {}", cause.variation.kind().name(), amount(comparison, cause)),
            unit: comparison.unit(&cause.id).into(),
            amplitudes: cause
                .amplitudes
                .iter()
                .map(|&(value, sigma)| EstimateResult { value, sigma })
                .collect(),
            alternatives: cause.alternatives.iter().map(alternative).collect(),
        }
    }
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
        }
    }
}
