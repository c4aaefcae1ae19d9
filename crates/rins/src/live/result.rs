//! A live calibration, for a machine.

use rins_estimation::{Estimate, OnlineFilter, correlation};
use rins_frames::SignedAxes;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{LiveEnd, LiveOutcome};
use crate::basis::BasisResult;

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

/// The estimate of a parameter by the samples so far, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LiveParameterResult {
    /// Its id, along the sensor's own axes.
    pub id: String,
    /// The value.
    pub value: f64,
    /// Its 1σ.
    pub sigma: f64,
    /// The unit.
    pub unit: String,
    /// The 1σ known beforehand.
    pub prior_sigma: f64,
    /// Whether the samples determine it: its 1σ is less than half of the one known beforehand. Only identified parameters
    /// are compensated.
    pub identified: bool,
}

/// The estimates of a filter in a run with these axes.
pub(super) fn parameters(filter: &OnlineFilter, axes: &SignedAxes) -> Vec<LiveParameterResult> {
    let model = filter.model();
    let of = |(place, estimate): (usize, Estimate)| {
        let Estimate { parameter, value, sigma, .. } = estimate;
        let (_, sign) = model.terms[parameter.term].own(parameter.parameter, axes);
        LiveParameterResult {
            id: model.own_id(parameter.term, parameter.parameter, axes),
            value: sign * value / parameter.unit.factor,
            sigma: sigma / parameter.unit.factor,
            unit: parameter.unit.symbol.into(),
            prior_sigma: parameter.sigma / parameter.unit.factor,
            identified: filter.is_identified(place),
        }
    };
    filter.estimates().into_iter().enumerate().map(of).collect()
}

/// The signs that convert the parameters to the sensor's own axes.
fn signs(filter: &OnlineFilter, axes: &SignedAxes) -> Vec<f64> {
    let model = filter.model();
    let sign = |estimate: Estimate| {
        model.terms[estimate.parameter.term].own(estimate.parameter.parameter, axes).1
    };
    filter.estimates().into_iter().map(sign).collect()
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
        let LiveOutcome { name, model, filter, axes, end, notes, basis } = outcome;
        let (samples, epochs) = filter.counts();
        let (signs, plain) = (signs(filter, axes), correlation(&filter.covariance()));
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
            parameters: parameters(filter, axes),
            correlation: (0..signs.len()).map(row).collect(),
            notes: notes.clone(),
            basis: basis.clone(),
        }
    }
}
