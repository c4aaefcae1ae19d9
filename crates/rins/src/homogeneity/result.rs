//! The comparison of runs, for a machine.

use rins_history::{Cause, Homogeneity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::comparison::RunComparison;
use super::held_out::{Forecasted, HeldOutComparison, HeldOutParameter};
use super::words::amount;
use crate::values::EstimateResult;

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

/// A held-out run, estimated by itself, beside the estimate from the other runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeldOutResult {
    /// The rig file of the held-out run.
    pub rig: String,
    /// Whether no parameter differs significantly: 1 %, family-wise.
    pub consistent: bool,
    /// Each parameter of the sensors that both determine, the most significant difference first.
    pub parameters: Vec<HeldOutParameterResult>,
}

/// A parameter of a held-out run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeldOutParameterResult {
    /// The parameter.
    pub id: String,
    /// The unit of all values.
    pub unit: String,
    /// The estimate from the other runs.
    pub other_runs: EstimateResult,
    /// The estimate from the held-out run.
    pub held_out: EstimateResult,
    /// The difference over its 1σ.
    pub sigmas: f64,
    /// The p-value of the test of equality, all other parameters being the same.
    pub p_value: f64,
    /// The p-value if the more significant parameters are not.
    pub p_value_beside_others: f64,
    /// Of several other runs, the forecast from the differences between them.
    pub forecast: Option<ForecastedResult>,
}

/// A forecast of the estimate from a held-out run, and the estimate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ForecastedResult {
    /// The 95 % interval.
    pub interval_95: [f64; 2],
    /// The estimate with the given model.
    pub found: EstimateResult,
    /// Whether the interval contains it.
    pub holds: bool,
}

impl From<&HeldOutComparison> for HeldOutResult {
    fn from(comparison: &HeldOutComparison) -> Self {
        Self {
            rig: comparison.name.clone(),
            consistent: comparison.contradicting().next().is_none(),
            parameters: comparison.parameters.iter().map(HeldOutParameterResult::from).collect(),
        }
    }
}

impl From<&HeldOutParameter> for HeldOutParameterResult {
    fn from(one: &HeldOutParameter) -> Self {
        let value = |(value, sigma): (f64, f64)| EstimateResult { value, sigma };
        let forecast = |of: Forecasted| ForecastedResult {
            interval_95: of.interval.into(),
            found: value(of.found),
            holds: of.holds(),
        };
        Self {
            id: one.test.id.clone(),
            unit: one.unit.into(),
            other_runs: value(one.expected),
            held_out: value(one.found),
            sigmas: one.sigmas(),
            p_value: one.test.ln_p.exp(),
            p_value_beside_others: one.test.ln_p_beside.exp(),
            forecast: one.forecast.map(forecast),
        }
    }
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
    pub alternatives: Vec<VariantResult>,
}

/// A member of a credible set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VariantResult {
    /// The parameter.
    pub id: String,
    /// The variation.
    pub variation: String,
    /// Its posterior probability.
    pub probability: f64,
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
        let alternative = |one: &rins_history::Alternative| VariantResult {
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
