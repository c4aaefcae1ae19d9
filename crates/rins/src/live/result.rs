//! A live calibration, for a machine.

use rins_estimation::{Estimate, OnlineFilter, correlation};
use rins_terms::Role;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parameter::{LiveParameterResult, along_own, signs};
use super::{LiveEnd, LiveOutcome};
use crate::basis::BasisResult;
use crate::calibrate;

/// The result of `rins calibrate --live`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LiveResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `calibrate --live`.
    pub command: String,
    /// The model: `full` or the name of a model file.
    pub model: String,
    /// The rig file.
    pub rig: String,
    /// Why the log ended: `closed`, `idle` or `interrupted`.
    pub end: String,
    /// The time of the last sample \[s\].
    pub time_s: f64,
    /// How many samples were processed.
    pub samples: usize,
    /// In how many epochs.
    pub epochs: usize,
    /// The duration of an epoch \[s\].
    pub epoch_s: f64,
    /// The mean squared whitened innovation at the estimate: 1 if model and noise describe the run.
    pub innovation_variance: Option<f64>,
    /// The estimates.
    pub parameters: Vec<LiveParameterResult>,
    /// Their correlation, n by n.
    pub correlation: Vec<Vec<f64>>,
    /// What else is to be known.
    pub notes: Vec<String>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

impl From<LiveEnd> for &'static str {
    fn from(end: LiveEnd) -> Self {
        match end {
            LiveEnd::Closed => "closed",
            LiveEnd::Idle => "idle",
            LiveEnd::Interrupted => "interrupted",
        }
    }
}

impl From<&LiveOutcome> for LiveResult {
    fn from(outcome: &LiveOutcome) -> Self {
        let LiveOutcome { name, model, filter, axes, stated, end, notes, basis } = outcome;
        let (samples, epochs) = filter.counts();
        let (estimates, covariance) = filter.with_prior_values_at(&held(filter, stated));
        let (signs, plain) = (signs(filter, axes), correlation(&covariance));
        let row = |row: usize| {
            (0..signs.len())
                .map(|column| signs[row] * signs[column] * plain[(row, column)])
                .collect()
        };
        let setup = filter.setup();
        Self {
            schema: crate::SCHEMA,
            command: "calibrate --live".into(),
            model: model.clone(),
            rig: name.clone(),
            end: <&str>::from(*end).into(),
            time_s: filter.time().unwrap_or_default(),
            samples,
            epochs,
            epoch_s: setup.epoch as f64 * setup.interval,
            innovation_variance: filter.innovation_variance(),
            parameters: along_own(filter, axes, estimates),
            correlation: (0..signs.len()).map(row).collect(),
            notes: notes.clone(),
            basis: basis.clone(),
        }
    }
}

/// The parameters that keep the means of their priors at the end, as in the calibration of a finished log.
fn held(filter: &OnlineFilter, stated: &[String]) -> Vec<usize> {
    let estimates = filter.estimates();
    calibrate::held(&filter.identifiability(), |place| {
        let Estimate { parameter, .. } = &estimates[place];
        let id = filter.model().id(parameter.term, parameter.parameter);
        let role = filter.model().terms[parameter.term].roles[parameter.parameter];
        Some(if stated.contains(&id) { role } else { Role::Free })
    })
}
