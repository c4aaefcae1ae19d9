//! A mission, for a machine.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Mission, Radial, SchemeInService};
use crate::basis::BasisResult;

/// Meters of a nautical mile.
pub(crate) const NAUTICAL_MILE: f64 = 1852.0;

/// The result of `rins mission`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MissionResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `mission`.
    pub command: String,
    /// The mission file.
    pub mission: String,
    /// The schemes, as the file lists them.
    pub schemes: Vec<SchemeResult>,
    /// What else is to be known.
    pub notes: Vec<String>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// The navigation errors under one scheme; a list has a value for each of `hours`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SchemeResult {
    /// Its name.
    pub name: String,
    /// The time since the start \[h\].
    pub hours: Vec<f64>,
    /// The position error east by the stated errors \[nmi\]; null if none are stated.
    pub east_nmi: Option<Vec<f64>>,
    /// The same north.
    pub north_nmi: Option<Vec<f64>>,
    /// The secular part of the error east by the stated errors \[nmi\]; null if none are stated, or a cycle does not close.
    pub law_nmi: Option<Vec<f64>>,
    /// The radius that holds half of the position errors \[nmi\]; null if no uncertainty is stated.
    pub cep50_nmi: Option<Vec<f64>>,
    /// The radius that holds 95 % of them.
    pub cep95_nmi: Option<Vec<f64>>,
    /// The root mean square of the radial position error \[nmi\] (TRMS).
    pub trms_nmi: Option<Vec<f64>>,
    /// The radial position error at the end by each source alone, 1σ; the largest first.
    pub budget: Vec<BudgetResult>,
}

/// The contribution of one source.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BudgetResult {
    /// The id of the parameter, `initial attitude` or `white noise`.
    pub source: String,
    /// The radial position error, 1σ \[nmi\].
    pub radial_nmi: f64,
}

impl From<&Mission> for MissionResult {
    fn from(mission: &Mission) -> Self {
        Self {
            schema: 2,
            command: "mission".into(),
            mission: mission.name.clone(),
            schemes: mission.schemes.iter().map(|scheme| scheme.result(&mission.times)).collect(),
            notes: mission.remarks.clone(),
            basis: mission.basis.clone(),
        }
    }
}

impl SchemeInService {
    fn result(&self, times: &[f64]) -> SchemeResult {
        let along = |axis: usize| {
            let list = self.by_errors.as_ref()?;
            Some(list.iter().map(|position| position[axis] / NAUTICAL_MILE).collect())
        };
        let radial = |of: fn(&Radial) -> f64| {
            let list = self.by_uncertainty.as_ref()?;
            Some(list.iter().map(|radial| of(radial) / NAUTICAL_MILE).collect())
        };
        let law = self.law.map(|law| times.iter().map(|time| law * time / NAUTICAL_MILE).collect());
        let budget = self.budget.iter().map(|(source, radial)| BudgetResult {
            source: source.clone(),
            radial_nmi: radial / NAUTICAL_MILE,
        });
        SchemeResult {
            name: self.name.clone(),
            hours: times.iter().map(|time| time / 3600.0).collect(),
            east_nmi: along(0),
            north_nmi: along(1),
            law_nmi: law,
            cep50_nmi: radial(|radial| radial.half),
            cep95_nmi: radial(|radial| radial.most),
            trms_nmi: radial(|radial| radial.rms),
            budget: budget.collect(),
        }
    }
}
