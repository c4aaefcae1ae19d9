//! The error budget, for a machine.

use nalgebra::Vector3;
use rins_design::{Budget, Drift};
use rins_frames::units::DEG;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What each error is worth in free inertial navigation from rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BudgetResult {
    /// After how long \[s\].
    pub after_s: f64,
    /// Each parameter by itself.
    pub parameters: Vec<WorthResult>,
    /// The 1σ of the drift by all, with their correlations.
    pub total_1_sigma: DriftResult,
}

/// What one error is worth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WorthResult {
    /// The parameter.
    pub id: String,
    /// The drift that its 1σ makes.
    pub by_sigma: DriftResult,
    /// The drift that its value makes where it is not compensated.
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
        let parameters = ids.iter().zip(&budget.worth).map(|(id, worth)| WorthResult {
            id: (*id).to_owned(),
            by_sigma: (&worth.by_sigma).into(),
            by_value: (&worth.by_value).into(),
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
