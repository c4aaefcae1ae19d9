//! The comparison of runs, for a machine.

use rins_history::{Cause, Homogeneity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::comparison::RunComparison;
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
