//! What the causes gain on held-out data.

use rins_diagnosis::{Drift, Gain, GainError, GainVerdict};
use rins_estimation::Fit;
use rins_frames::units::DEG;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::finite::finite;
use crate::preparation::{EstimationProblem, Prepared};

/// On what a gain is measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum On {
    /// The last part of every stretch of the runs that were diagnosed.
    Ends,
    /// All their stretches at the fastest rate.
    Fastest,
    /// Another run, of this name.
    Run(String),
}

/// A gain, or why there is none to be told.
#[derive(Debug)]
pub(crate) struct Measured {
    pub(crate) on: On,
    pub(crate) gain: Result<Gain, GainError>,
}

impl Measured {
    /// What `after` gains over `before` on a part of the runs of a case, or on another run.
    pub(crate) fn of(
        case: &EstimationProblem,
        held_out: Option<&Prepared>,
        fits: (&Fit, &Fit),
    ) -> Self {
        let (imu, knowledge) = (case.imu(), case.knowledge());
        let runs = case.given();
        match held_out {
            None => Self { on: On::Ends, gain: Gain::within(&runs, fits, imu, knowledge) },
            Some(other) => Self {
                on: On::Run(other.name.clone()),
                gain: Gain::on(std::slice::from_ref(&other.run), &runs, fits, imu, knowledge),
            },
        }
    }

    /// What `after` gains where the table turns fastest, both estimated at the slower rates.
    pub(crate) fn at_the_fastest_rate(case: &EstimationProblem, fits: (&Fit, &Fit)) -> Self {
        let gain = Gain::at_the_fastest_rate(&case.given(), fits, case.imu(), case.knowledge());
        Self { on: On::Fastest, gain }
    }
}

/// What the causes gain on held-out data; of a gain that is not measurable only `held_out`, `verdict` and `why` are there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GainResult {
    /// What was held out.
    pub held_out: String,
    /// `improved`, `no_improvement` or `not_measurable`.
    pub verdict: String,
    /// Why it is not measurable.
    pub why: Option<String>,
    /// The other run on which it was measured, if it was.
    pub rig: Option<String>,
    /// How many samples were held out.
    pub samples: Option<usize>,
    /// In how many blocks: revolutions, or pieces of a static interval.
    pub blocks: Option<usize>,
    /// The predictive log score of a sample \[nats\].
    pub log_score_per_sample: Option<PairResult>,
    /// By how much the log score rises \[nats\].
    pub log_score_rise: Option<f64>,
    /// Its 95 % interval \[nats\].
    pub log_score_rise_95: Option<[Option<f64>; 2]>,
    /// The mean normalized innovation squared.
    pub nis_mean: Option<PairResult>,
    /// Its expected value for a correct model.
    pub nis_dof: Option<usize>,
    /// Whether the innovations of each model are as large as predicted.
    pub consistent: Option<ConsistentResult>,
    /// The velocity error of the longest free navigation \[m/s\].
    pub velocity_drift_m_s: Option<PairResult>,
    /// Its attitude error \[deg\].
    pub attitude_drift_deg: Option<PairResult>,
    /// How long it is \[s\].
    pub drift_after_s: Option<f64>,
    /// Free navigation over windows of several lengths.
    pub drifts: Vec<DriftPairResult>,
}

/// Whether held-out data are predicted within the stated uncertainty, without and with the causes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ConsistentResult {
    /// Without.
    pub before: bool,
    /// With.
    pub after: bool,
}

/// A figure without and with the causes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PairResult {
    /// Without.
    pub before: f64,
    /// With.
    pub after: f64,
}

/// Free navigation over windows of one length, root mean square.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DriftPairResult {
    /// The length \[s\].
    pub after_s: f64,
    /// How many windows there are.
    pub windows: usize,
    /// The velocity error \[m/s\].
    pub velocity_m_s: PairResult,
    /// The attitude error \[deg\].
    pub attitude_deg: PairResult,
}

impl From<&Measured> for GainResult {
    fn from(measured: &Measured) -> Self {
        let (held_out, rig) = match &measured.on {
            On::Ends => ("last 30 % of each segment".to_owned(), None),
            On::Fastest => ("all at the fastest rate".to_owned(), None),
            On::Run(rig) => (format!("last 30 % of each segment of {rig}"), Some(rig.clone())),
        };
        let none = Self {
            held_out,
            verdict: "not_measurable".into(),
            why: None,
            rig,
            samples: None,
            blocks: None,
            log_score_per_sample: None,
            log_score_rise: None,
            log_score_rise_95: None,
            nis_mean: None,
            nis_dof: None,
            consistent: None,
            velocity_drift_m_s: None,
            attitude_drift_deg: None,
            drift_after_s: None,
            drifts: Vec::new(),
        };
        let gain = match &measured.gain {
            Ok(gain) => gain,
            Err(error) => return Self { why: Some(error.to_string()), ..none },
        };
        let verdict = match gain.verdict {
            GainVerdict::Improved => "improved",
            GainVerdict::NoImprovement => "no_improvement",
        };
        let pair = |before: f64, after: f64| Some(PairResult { before, after });
        let per_sample = |score: f64| score / gain.samples as f64;
        let drifts: Vec<DriftPairResult> = gain.drifts.iter().map(DriftPairResult::from).collect();
        let longest = drifts.last();
        Self {
            verdict: verdict.into(),
            samples: Some(gain.samples),
            blocks: Some(gain.blocks),
            log_score_per_sample: pair(
                per_sample(gain.before.log_score),
                per_sample(gain.after.log_score),
            ),
            log_score_rise: finite(gain.rise()),
            log_score_rise_95: Some([finite(gain.interval.0), finite(gain.interval.1)]),
            nis_mean: pair(gain.before.nis_mean, gain.after.nis_mean),
            nis_dof: Some(gain.before.nis_dof),
            consistent: Some(ConsistentResult {
                before: gain.before.is_consistent(),
                after: gain.after.is_consistent(),
            }),
            velocity_drift_m_s: longest.map(|drift| drift.velocity_m_s),
            attitude_drift_deg: longest.map(|drift| drift.attitude_deg),
            drift_after_s: longest.map(|drift| drift.after_s),
            drifts,
            ..none
        }
    }
}

impl From<&Drift> for DriftPairResult {
    fn from(drift: &Drift) -> Self {
        let [before, after] = drift.velocity;
        let [attitude_before, attitude_after] = drift.attitude.map(|angle| angle / DEG);
        Self {
            after_s: drift.after,
            windows: drift.windows,
            velocity_m_s: PairResult { before, after },
            attitude_deg: PairResult { before: attitude_before, after: attitude_after },
        }
    }
}
