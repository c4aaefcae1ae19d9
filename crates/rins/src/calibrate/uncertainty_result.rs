//! The uncertainty budget, for a machine.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::certificate::Certificate;

/// The uncertainty of an estimate (JCGM 100:2008), in the unit of the parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct UncertaintyResult {
    /// The standard uncertainty by noise and by what was known beforehand: type A.
    pub type_a: f64,
    /// The contributions of the references: type B.
    pub type_b: Vec<ContributionOfReference>,
    /// The combined standard uncertainty.
    pub combined: f64,
    /// The coverage factor of the expanded uncertainty.
    pub coverage_factor: f64,
    /// The expanded uncertainty: of an interval of 95 %.
    pub expanded: f64,
}

/// What the accuracy of one reference adds to the uncertainty.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ContributionOfReference {
    /// The key of the rig file.
    pub reference: String,
    /// The distribution: `rectangular`.
    pub distribution: String,
    /// The standard uncertainty of the reference, in SI units.
    pub standard_uncertainty_si: f64,
    /// By how much the estimate changes with that, in the unit of the parameter.
    pub contribution: f64,
}

impl UncertaintyResult {
    /// Of a parameter, or of the combination in which it is observable; `None` if the accuracy of no reference is stated.
    pub(super) fn of(certificate: &Certificate, place: usize) -> Option<Self> {
        let uncertainty = certificate.uncertainty(place)?;
        let factor = certificate.fit.parameters[place].parameter.unit.factor;
        let (_, sigma) = certificate.value(place);
        let by_reference = certificate.contributions.iter().zip(&uncertainty.by_reference);
        let type_b = by_reference.map(|(one, (reference, moved))| ContributionOfReference {
            reference: reference.key().into(),
            distribution: "rectangular".into(),
            standard_uncertainty_si: one.standard_uncertainty,
            contribution: moved / factor,
        });
        Some(Self {
            type_a: uncertainty.estimated / factor,
            type_b: type_b.collect(),
            combined: sigma / factor,
            coverage_factor: uncertainty.coverage_factor,
            expanded: uncertainty.coverage_factor * sigma / factor,
        })
    }
}
