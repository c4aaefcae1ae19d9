//! Free navigation, for a machine.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Navigation;
use crate::basis::BasisResult;
use crate::free_navigation::NavigationResult;
use crate::log::OutsideRange;
use crate::outcome::Outcome as _;

/// The result of `rins navigate`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NavigateResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `navigate`.
    pub command: String,
    /// The rig file.
    pub rig: String,
    /// The attitude from which navigation starts, in words.
    pub start: String,
    /// How long is navigated \[s\].
    pub duration_s: f64,
    /// What navigation ends with: as recorded, and with what is known compensated.
    pub runs: Vec<NavigatedResult>,
    /// What of the log lies outside of what the calibration covers; null without a calibration.
    pub outside_calibrated_range: Option<OutsideRange>,
    /// The same in sentences.
    pub notes: Vec<String>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// What navigation ends with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NavigatedResult {
    /// `as recorded`, `gyro bias removed` or `compensated`.
    pub name: String,
    /// What it ends with.
    #[serde(flatten)]
    pub navigation: NavigationResult,
}

impl NavigateResult {
    pub(super) fn of(navigation: &Navigation<'_>) -> Self {
        let Navigation { log, start, runs, beyond, .. } = navigation;
        let runs = runs.iter().map(|(name, run)| NavigatedResult {
            name: (*name).to_owned(),
            navigation: run.into(),
        });
        Self {
            schema: crate::SCHEMA,
            command: "navigate".into(),
            rig: log.name.clone(),
            start: start.source.clone(),
            duration_s: start.duration(),
            runs: runs.collect(),
            outside_calibrated_range: beyond.outside.clone(),
            notes: beyond.notes.clone(),
            basis: navigation.basis(),
        }
    }
}
