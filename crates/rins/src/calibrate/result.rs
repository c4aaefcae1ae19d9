//! A calibration, for a machine.

use rins_estimation::{Departure, Reference, correlation};
use rins_frames::units::{ARCSEC, DEG_PER_HOUR, MICRO_G};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::budget::BudgetResult;
use super::certificate::{Certificate, CertifiedRun};
use super::compensation::EQUATION;
use super::conformity::ConformityResult;
use super::departure::quantity;
use super::uncertainty_result::UncertaintyResult;
use crate::basis::BasisResult;
use crate::consistency::ConsistencyResult;
use crate::free_navigation::BeforeAfterResult;
use crate::homogeneity::{HomogeneityResult, RunComparison, VariationResult};
use crate::identifiability::{IdentifiabilityResult, ObservabilityResult, coefficient, meaning};
use crate::log::StaticIntervalResult;
use crate::options::NoiseChoice;
use crate::preparation::across_axis;
use crate::values::{EstimateResult, EulerDegrees};

/// The result of `rins calibrate`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CalibrateResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `calibrate`.
    pub command: String,
    /// The model: `paper12`, `full` or the name of a model file.
    pub model: String,
    /// The rig file of the first run.
    pub rig: String,
    /// The rig files of all runs.
    pub rigs: Vec<String>,
    /// The estimates.
    pub parameters: Vec<ParameterResult>,
    /// Their correlation, n by n.
    pub correlation: Vec<Vec<f64>>,
    /// The attitude of the axis frame of the first run, as estimated \[deg\].
    pub axis_attitude_deg: EulerDegrees,
    /// Free navigation of the first run before and after compensation.
    pub navigation: BeforeAfterResult,
    /// What the innovations of all runs say of the model.
    pub consistency: ConsistencyResult,
    /// What lies more than four sigmas off what was stated beforehand, the furthest first.
    pub prior_consistency: Vec<DepartureResult>,
    /// Whether the errors are within the tolerances that the rig file states.
    #[serde(default)]
    pub conformity: Vec<ConformityResult>,
    /// Of several runs, the test of each parameter of the sensors whether it is the same in all: each run was estimated by itself.
    #[serde(default)]
    pub homogeneity: Vec<HomogeneityResult>,
    /// How parameters vary between the runs, the most significant first.
    #[serde(default)]
    pub variations: Vec<VariationResult>,
    /// The iterations of the estimate; none of the paper's filter.
    pub iterations: Vec<IterationResult>,
    /// The log-likelihood \[nats\]; null of the paper's filter.
    pub log_likelihood: Option<f64>,
    /// The noise; null of the paper's filter, which trusts the data sheet.
    pub noise: Option<NoiseResult>,
    /// What is observable of all parameters together.
    pub identifiability: IdentifiabilityResult,
    /// The error budget of free inertial navigation over the first run.
    pub error_budget: BudgetResult,
    /// How errors are compensated.
    pub compensation: String,
    /// The static intervals of all runs.
    pub static_intervals: Vec<StaticIntervalResult>,
    /// What belongs to one run each; none of the paper's filter.
    pub runs: Vec<RunResult>,
    /// What else is to be known.
    pub notes: Vec<String>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// The estimate of a parameter, in its unit; of one that is observable only in a combination, that of the combination.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ParameterResult {
    /// Its id, along the sensor's own axes.
    pub id: String,
    /// The run to which it belongs, from 1; null if it belongs to all.
    pub run: Option<usize>,
    /// The value.
    pub value: f64,
    /// Its 1σ.
    pub sigma: f64,
    /// The unit.
    pub unit: String,
    /// The uncertainty budget, if the accuracy of a reference is stated; `sigma` is its combined standard uncertainty.
    #[serde(default)]
    pub uncertainty: Option<UncertaintyResult>,
    /// The estimate of the parameter itself, which what was known beforehand bounds.
    pub marginal: Option<EstimateResult>,
    /// The 1σ known beforehand.
    pub prior_sigma: Option<f64>,
    /// The 1σ by the data alone; null if they do not bound it.
    pub data_sigma: Option<f64>,
    /// Its observability.
    #[serde(flatten)]
    pub observability: ObservabilityResult,
    /// The coefficients of the aliases, as in the combination.
    pub alias_coefficients: Vec<f64>,
    /// The observability in words.
    pub meaning: String,
}

/// A quantity that lies further off than was stated beforehand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DepartureResult {
    /// The parameter, or `gyro.noise` or `accel.noise`.
    pub id: String,
    /// What was found.
    pub value: f64,
    /// What was expected.
    pub expected: f64,
    /// The 1σ of the prior; for noise the 1σ of its logarithm times the stated value.
    pub sigma: f64,
    /// The departure in units of its standard deviation from prior and data; for noise, that of the logarithm.
    pub sigmas: f64,
    /// The unit.
    pub unit: String,
}

/// One iteration of the estimate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct IterationResult {
    /// The largest step of a parameter, in its sigmas.
    pub step_sigma: f64,
    /// The log-likelihood \[nats\].
    pub log_likelihood: f64,
}

/// The noise of the sensors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NoiseResult {
    /// Whether it was estimated, or is the data sheet's.
    pub estimated: bool,
    /// The gyros.
    pub gyro: GyroNoiseResult,
    /// The accelerometers.
    pub accel: AccelNoiseResult,
}

/// The noise of the gyros.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GyroNoiseResult {
    /// White noise \[deg/h/√Hz\].
    pub white_deg_h_sqrt_hz: f64,
    /// Bias instability \[deg/h\].
    pub bias_instability_deg_h: f64,
    /// Rate random walk \[deg/h/√h\].
    pub random_walk_deg_h_sqrt_h: f64,
}

/// The noise of the accelerometers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AccelNoiseResult {
    /// White noise \[µg/√Hz\].
    pub white_ug_sqrt_hz: f64,
    /// Bias instability \[µg\].
    pub bias_instability_ug: f64,
    /// Acceleration random walk \[µg/√h\].
    pub random_walk_ug_sqrt_h: f64,
}

/// What belongs to one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RunResult {
    /// The rig file.
    pub rig: String,
    /// What shows the table's angle: `table_angle`, `table_rate`, `gravity` or `static`.
    pub reference: String,
    /// How many samples were used.
    pub samples: usize,
    /// The static intervals.
    pub static_intervals: Vec<StaticIntervalResult>,
    /// How many static intervals were used; null if the log was used as a whole.
    pub static_intervals_used: Option<usize>,
    /// The attitude of the axis frame, as estimated \[deg\].
    pub axis_attitude_deg: EulerDegrees,
    /// How much of gravity turns in the plane of rotation \[m/s²\].
    pub gravity_across_axis_m_s2: f64,
    /// The wobble of the axis \[arcsec\].
    pub wobble_arcsec: f64,
    /// The noise of the encoder \[arcsec\].
    pub encoder_noise_arcsec: Option<f64>,
    /// The jitter of the times at which it is read \[µs\].
    pub encoder_jitter_us: Option<f64>,
    /// The velocity noise of the base \[m/s\].
    pub base_velocity_m_s: f64,
    /// The sway of the base about x, y and z \[arcsec/√s\].
    pub base_sway_arcsec_sqrt_s: [f64; 3],
    /// Free navigation before and after compensation.
    pub navigation: BeforeAfterResult,
    /// What the innovations say of the model.
    pub consistency: ConsistencyResult,
    /// The error budget of free inertial navigation over the first run.
    pub error_budget: BudgetResult,
}

impl CalibrateResult {
    /// The whole of a calibration with any model.
    pub(super) fn of(certificate: &Certificate) -> Self {
        let fit = &certificate.fit;
        let first = &certificate.runs[0];
        let names: Vec<String> =
            certificate.runs.iter().map(|run| run.prepared.name.clone()).collect();
        let runs = certificate.runs.iter().enumerate();
        let runs: Vec<RunResult> =
            runs.map(|(place, run)| RunResult::of(certificate, place, run)).collect();
        let iterations = fit.iterations.iter().map(|iteration| IterationResult {
            step_sigma: iteration.step,
            log_likelihood: iteration.log_likelihood,
        });
        let correlation = correlation(&fit.covariance);
        Self {
            schema: crate::SCHEMA,
            command: "calibrate".into(),
            model: certificate.model.clone(),
            rig: names[0].clone(),
            rigs: names,
            parameters: (0..fit.parameters.len())
                .map(|place| ParameterResult::of(certificate, place))
                .collect(),
            correlation: correlation.row_iter().map(|row| row.iter().copied().collect()).collect(),
            axis_attitude_deg: first.nav_from_table.euler_angles().into(),
            navigation: BeforeAfterResult::of(&first.before, &first.after),
            consistency: (&certificate.consistency).into(),
            prior_consistency: departures(certificate),
            conformity: ConformityResult::all(certificate),
            homogeneity: of_comparison(certificate, HomogeneityResult::all),
            variations: of_comparison(certificate, VariationResult::all),
            iterations: iterations.collect(),
            log_likelihood: Some(fit.log_likelihood),
            noise: Some(certificate.into()),
            identifiability: IdentifiabilityResult::of(&certificate.identifiability),
            error_budget: BudgetResult::of(&ids(certificate, first), &first.budget),
            compensation: EQUATION.into(),
            static_intervals: statics(&runs),
            runs,
            notes: certificate.remarks.clone(),
            basis: certificate.basis(),
        }
    }
}

/// What the comparison of the runs says, if there are several.
fn of_comparison<T>(certificate: &Certificate, of: fn(&RunComparison) -> Vec<T>) -> Vec<T> {
    certificate.comparison.as_ref().map(of).unwrap_or_default()
}

/// The static intervals of all runs, each with the run that it is in.
fn statics(runs: &[RunResult]) -> Vec<StaticIntervalResult> {
    let of_run = |(place, run): (usize, &RunResult)| {
        let intervals = run.static_intervals.clone().into_iter();
        intervals.map(move |interval| StaticIntervalResult { run: Some(place + 1), ..interval })
    };
    runs.iter().enumerate().flat_map(of_run).collect()
}

/// The ids of what was estimated of a run and of the IMU, in the order of the run's budget.
fn ids<'c>(certificate: &'c Certificate, run: &CertifiedRun) -> Vec<&'c str> {
    let id = |&place: &usize| certificate.fit.parameters[place].parameter.id.as_str();
    run.places.iter().map(id).collect()
}

/// What lies more than four sigmas off what was stated beforehand, the furthest first.
pub(crate) fn departures(certificate: &Certificate) -> Vec<DepartureResult> {
    let departed = certificate.departed().into_iter();
    departed.map(|of| DepartureResult::of(certificate, of)).collect()
}

impl DepartureResult {
    fn of(certificate: &Certificate, departure: &Departure) -> Self {
        let (id, unit) = quantity(certificate, departure.of);
        Self {
            id,
            value: departure.value / unit.factor,
            expected: departure.expected / unit.factor,
            sigma: departure.sigma / unit.factor,
            sigmas: departure.sigmas,
            unit: unit.symbol.into(),
        }
    }
}

impl ParameterResult {
    fn of(certificate: &Certificate, place: usize) -> Self {
        let Certificate { fit, identifiability, .. } = certificate;
        let estimate = &fit.parameters[place];
        let (unknown, seen) =
            (&identifiability.unknowns[place], &identifiability.parameters[place]);
        let factor = estimate.parameter.unit.factor;
        let (value, sigma) = certificate.value(place);
        Self {
            id: unknown.id.clone(),
            run: unknown.run.map(|run| run + 1),
            value: value / factor,
            sigma: sigma / factor,
            unit: unknown.unit.symbol.into(),
            uncertainty: UncertaintyResult::of(certificate, place),
            marginal: Some(EstimateResult {
                value: estimate.value / factor,
                sigma: estimate.sigma / factor,
            }),
            prior_sigma: Some(unknown.sigma / unknown.unit.factor),
            data_sigma: seen
                .data_sigma
                .is_finite()
                .then_some(seen.data_sigma / unknown.unit.factor),
            observability: ObservabilityResult::of(identifiability, place),
            alias_coefficients: seen
                .aliases
                .iter()
                .map(|alias| coefficient(identifiability, place, alias))
                .collect(),
            meaning: meaning(identifiability, place),
        }
    }
}

impl From<&Certificate> for NoiseResult {
    fn from(certificate: &Certificate) -> Self {
        let imu = certificate.fit.noise[0].imu;
        Self {
            estimated: certificate.noise == NoiseChoice::Likely,
            gyro: GyroNoiseResult {
                white_deg_h_sqrt_hz: imu.gyro.white / DEG_PER_HOUR,
                bias_instability_deg_h: imu.gyro.flicker / DEG_PER_HOUR,
                random_walk_deg_h_sqrt_h: imu.gyro.walk * 60.0 / DEG_PER_HOUR,
            },
            accel: AccelNoiseResult {
                white_ug_sqrt_hz: imu.accel.white / MICRO_G,
                bias_instability_ug: imu.accel.flicker / MICRO_G,
                random_walk_ug_sqrt_h: imu.accel.walk * 60.0 / MICRO_G,
            },
        }
    }
}

impl RunResult {
    fn of(certificate: &Certificate, place: usize, run: &CertifiedRun) -> Self {
        let noise = &certificate.fit.noise[place];
        let reference = run.prepared.run.rig.reference;
        let encoder = matches!(reference, Reference::Encoder { .. });
        let name = match reference {
            Reference::Encoder { .. } => "table_angle",
            Reference::Command { .. } => "table_rate",
            Reference::Gravity => "gravity",
            Reference::Rest => "static",
        };
        let others = &run.prepared.others;
        Self {
            rig: run.prepared.name.clone(),
            reference: name.into(),
            samples: run.prepared.samples(),
            static_intervals: run.prepared.static_intervals.clone(),
            static_intervals_used: (!others.is_empty())
                .then_some(others.len() + usize::from(reference == Reference::Rest)),
            axis_attitude_deg: run.nav_from_table.euler_angles().into(),
            gravity_across_axis_m_s2: across_axis(
                run.prepared.loaded.station.gravity,
                &run.nav_from_table,
            ),
            wobble_arcsec: noise.wobble / ARCSEC,
            encoder_noise_arcsec: encoder.then_some(noise.encoder / ARCSEC),
            encoder_jitter_us: encoder.then_some(noise.imu.jitter * 1e6),
            base_velocity_m_s: noise.velocity,
            base_sway_arcsec_sqrt_s: noise.sway.map(|sway| sway / ARCSEC),
            navigation: BeforeAfterResult::of(&run.before, &run.after),
            consistency: (&run.consistency).into(),
            error_budget: BudgetResult::of(&ids(certificate, run), &run.budget),
        }
    }
}
