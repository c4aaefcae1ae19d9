//! The error budget, for a machine.

use nalgebra::Vector3;
use rins_design::{Budget, Drift};
use rins_frames::units::DEG;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The error budget of free inertial navigation from rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BudgetResult {
    /// The duration of free inertial navigation \[s\].
    pub after_s: f64,
    /// The contribution of each parameter.
    pub parameters: Vec<ContributionResult>,
    /// The 1σ of the drift due to all parameters, with their correlations.
    pub total_1_sigma: DriftResult,
}

/// The contribution of one parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ContributionResult {
    /// The id of the parameter.
    pub id: String,
    /// The drift due to its 1σ.
    pub by_sigma: DriftResult,
    /// The drift due to its value if it is not compensated.
    pub by_value: DriftResult,
}

/// A drift of free inertial navigation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DriftResult {
    /// Of the velocity, east, north and up \[m/s\].
    pub velocity_m_s: [f64; 3],
    /// Of the attitude, about east, north and up \[deg\].
    pub attitude_deg: [f64; 3],
}

impl BudgetResult {
    /// An error budget of parameters with these ids.
    pub(super) fn of(ids: &[&str], budget: &Budget) -> Self {
        let parameters =
            ids.iter().zip(&budget.contributions).map(|(id, one)| ContributionResult {
                id: (*id).to_owned(),
                by_sigma: (&one.by_sigma).into(),
                by_value: (&one.by_value).into(),
            });
        Self {
            after_s: budget.after,
            parameters: parameters.collect(),
            total_1_sigma: (&budget.total).into(),
        }
    }
}

impl From<&Drift> for DriftResult {
    fn from(drift: &Drift) -> Self {
        let attitude: Vector3<f64> = drift.attitude / DEG;
        Self { velocity_m_s: drift.velocity.into(), attitude_deg: attitude.into() }
    }
}
