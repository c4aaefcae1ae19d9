//! The estimates of a live calibration in the units of their parameters.

use rins_estimation::{Estimate, OnlineFilter};
use rins_frames::SignedAxes;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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

/// The estimates of a filter so far, in a run with these axes.
pub(super) fn parameters(filter: &OnlineFilter, axes: &SignedAxes) -> Vec<LiveParameterResult> {
    along_own(filter, axes, filter.estimates())
}

/// Estimates of a filter in the units of their parameters, along the sensor's own axes.
pub(super) fn along_own(
    filter: &OnlineFilter,
    axes: &SignedAxes,
    estimates: Vec<Estimate>,
) -> Vec<LiveParameterResult> {
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
    estimates.into_iter().enumerate().map(of).collect()
}

/// The signs that convert the parameters to the sensor's own axes.
pub(super) fn signs(filter: &OnlineFilter, axes: &SignedAxes) -> Vec<f64> {
    let model = filter.model();
    let sign = |estimate: Estimate| {
        model.terms[estimate.parameter.term].own(estimate.parameter.parameter, axes).1
    };
    filter.estimates().into_iter().map(sign).collect()
}
