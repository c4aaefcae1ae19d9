//! A check, for a machine.

use rins_frames::units::DEG_PER_HOUR;
use rins_io::Axes;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Check;
use super::mends::Mend;
use super::verdicts::Verdict;
use super::words::suspicion_in_words;
use crate::basis::BasisResult;
use crate::log::{StaticIntervalResult, statics_result};
use crate::outcome::Outcome as _;

/// The result of `rins check`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CheckResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `check`.
    pub command: String,
    /// The rig file.
    pub rig: String,
    /// How many samples there are.
    pub samples: usize,
    /// How many samples a second \[Hz\].
    pub rate_hz: f64,
    /// The root mean square jitter of the time stamps \[s\].
    pub jitter_rms_s: f64,
    /// The gaps.
    pub gaps: Vec<GapResult>,
    /// The static intervals of a second or more, with what they show.
    pub static_means: Vec<StaticMeanResult>,
    /// All static intervals, stated or found, and why one is not used.
    pub static_intervals: Vec<StaticIntervalResult>,
    /// How often the IMU turns about its axis of rotation, either way.
    pub turns: f64,
    /// What the gyro about the axis of rotation counts of the table's rotation; null without a table.
    pub spin_ratio: Option<f64>,
    /// By how much the table angle is older than the sample beside it \[s\]; null if the log does not show it.
    pub table_latency_s: Option<f64>,
    /// The 1σ of that \[s\].
    pub table_latency_sigma_s: Option<f64>,
    /// Whether the gyros are quiet enough for the Earth's rate to show.
    pub earth_rate_visible: bool,
    /// Gravity at the site \[m/s²\].
    pub expected_gravity_m_s2: f64,
    /// Likely mistakes of units, signs and axes, each in a sentence.
    pub suspicions: Vec<String>,
    /// Changes of the rig file of which one would put these right.
    pub corrections: Vec<CorrectionResult>,
    /// What is odd, each in a sentence; mistakes first.
    pub remarks: Vec<String>,
    /// A verdict on each thing that can be wrong with a log.
    pub verdicts: Vec<VerdictResult>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// A gap.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GapResult {
    /// The time of the sample after it \[s\].
    pub at_s: f64,
    /// How long it is \[s\].
    pub length_s: f64,
}

/// A static interval, with what it shows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StaticMeanResult {
    /// The time of its first sample \[s\].
    pub from_s: f64,
    /// The time of its last sample \[s\].
    pub to_s: f64,
    /// The magnitude of the mean specific force \[m/s²\].
    pub gravity_m_s2: f64,
    /// The magnitude of the mean angular rate \[deg/h\].
    pub rate_deg_h: f64,
}

/// A change of the rig file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CorrectionResult {
    /// `axes` under `[log] gyro`, if it is to change.
    pub gyro_axes: Option<[String; 3]>,
    /// `axes` under `[log] accel`, if it is to change.
    pub accel_axes: Option<[String; 3]>,
    /// The direction of rotation in which the table's angle is counted, if it is to change.
    pub table_direction: Option<String>,
}

/// A verdict on one thing that can be wrong with a log.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VerdictResult {
    /// What was checked.
    pub check: String,
    /// `good`, `fact`, `odd` or `bad`.
    pub verdict: String,
    /// What was found, in a sentence.
    pub finding: String,
}

impl From<&Verdict> for VerdictResult {
    fn from(verdict: &Verdict) -> Self {
        let (check, word) = (verdict.item.into(), verdict.word().into());
        Self { check, verdict: word, finding: verdict.says.clone() }
    }
}

impl From<&Mend> for CorrectionResult {
    fn from(mend: &Mend) -> Self {
        let names = |axes: &Option<Axes>| axes.map(|axes| axes.names());
        Self {
            gyro_axes: names(&mend.gyro),
            accel_axes: names(&mend.accel),
            table_direction: mend.table.map(|sense| sense.name().to_owned()),
        }
    }
}

impl CheckResult {
    pub(super) fn of(check: &Check<'_>) -> Self {
        let Check { log, inspection, oddities, mends, verdicts } = check;
        let times = &log.loaded.recording.times;
        let rests = inspection.rests.iter().map(|rest| StaticMeanResult {
            from_s: times[rest.span.start],
            to_s: times[rest.span.end - 1],
            gravity_m_s2: rest.mean.rates.specific_force.norm(),
            rate_deg_h: rest.mean.rates.angular_rate.norm() / DEG_PER_HOUR,
        });
        let gaps = inspection.timing.gaps.iter();
        let lag = inspection.table_lag;
        Self {
            schema: crate::SCHEMA,
            command: "check".into(),
            rig: log.name.clone(),
            samples: log.loaded.recording.len(),
            rate_hz: 1.0 / inspection.timing.interval,
            jitter_rms_s: inspection.timing.jitter,
            gaps: gaps
                .map(|(index, length)| GapResult { at_s: times[*index], length_s: *length })
                .collect(),
            static_means: rests.collect(),
            static_intervals: statics_result(&inspection.static_intervals, |_| None),
            turns: inspection.turns,
            spin_ratio: inspection.spin_ratio,
            table_latency_s: lag.map(|lag| lag.latency),
            table_latency_sigma_s: lag.map(|lag| lag.sigma),
            earth_rate_visible: inspection.earth_rate_visible,
            expected_gravity_m_s2: log.loaded.station.gravity,
            suspicions: inspection.suspicions.iter().map(suspicion_in_words).collect(),
            corrections: mends.iter().map(CorrectionResult::from).collect(),
            remarks: oddities.clone(),
            verdicts: verdicts.iter().map(VerdictResult::from).collect(),
            basis: check.basis(),
        }
    }
}
