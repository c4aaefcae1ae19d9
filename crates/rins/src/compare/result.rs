//! A comparison, for a machine.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Comparison;
use crate::basis::BasisResult;
use crate::values::EstimateResult;

/// The result of `rins compare`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CompareResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `compare`.
    pub command: String,
    /// The calibration before.
    pub before: String,
    /// The calibration after.
    pub after: String,
    /// What both have estimated.
    pub parameters: Vec<ChangeResult>,
    /// All differences together; null if their covariance is singular.
    pub together: Option<TogetherResult>,
    /// The ids of what only the first has estimated.
    pub only_before: Vec<String>,
    /// Those of what only the second has estimated.
    pub only_after: Vec<String>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// The change of one parameter, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ChangeResult {
    /// Its id.
    pub id: String,
    /// Its unit.
    pub unit: String,
    /// The estimate before.
    pub before: EstimateResult,
    /// The estimate after.
    pub after: EstimateResult,
    /// After less before.
    pub difference: f64,
    /// The 1σ of the difference.
    pub sigma: f64,
    /// The difference in sigmas.
    pub sigmas: f64,
}

/// All differences together, with both covariances.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TogetherResult {
    /// The chi-squared of all differences.
    pub chi_square: f64,
    /// Its degrees of freedom.
    pub dof: usize,
    /// The p-value of that much, if nothing has changed.
    pub p: f64,
}

impl From<&Comparison> for CompareResult {
    fn from(comparison: &Comparison) -> Self {
        let parameters = comparison.moved.iter().map(|moved| {
            let estimate =
                |of: usize| EstimateResult { value: moved.values[of], sigma: moved.sigmas[of] };
            ChangeResult {
                id: moved.id.clone(),
                unit: moved.unit.into(),
                before: estimate(0),
                after: estimate(1),
                difference: moved.difference(),
                sigma: moved.sigma,
                sigmas: moved.sigmas_moved(),
            }
        });
        Self {
            schema: crate::SCHEMA,
            command: "compare".into(),
            before: comparison.names[0].clone(),
            after: comparison.names[1].clone(),
            parameters: parameters.collect(),
            together: comparison.together.map(|together| TogetherResult {
                chi_square: together.chi_square,
                dof: together.dof,
                p: together.p,
            }),
            only_before: comparison.only[0].clone(),
            only_after: comparison.only[1].clone(),
            basis: comparison.basis.clone(),
        }
    }
}
