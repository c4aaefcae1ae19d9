//! A designed schedule, for a machine.

use rins_design::{Motion, OptimalRun};
use rins_estimation::Observable;
use rins_frames::units::{DEG, PPM};
use rins_io::Axes;
use rins_terms::catalogue;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::goal::meaning;
use super::notes::notes;
use super::study::{Compared, DesignStudy};
use crate::basis::BasisResult;
use crate::identifiability::{IdentifiabilityResult, PredictedResult};
use crate::observe::LimitsResult;
use crate::values::EulerDegrees;

/// The result of `rins design`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DesignResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `design`.
    pub command: String,
    /// The model.
    pub model: String,
    /// What `value` is, in words.
    pub goal: String,
    /// The criterion: `variance` (c- and A-optimal), `determinant` (D-optimal) or `distance` (of two effects).
    pub criterion: String,
    /// The unit of `value`; empty for a ratio.
    pub unit: String,
    /// The limits of the table, and the duration of the schedule.
    pub limits: LimitsResult,
    /// The value of the optimal schedule, from the joint information of its runs.
    pub value: f64,
    /// That of the given schedule; null if it leaves it undetermined.
    pub given_value: Option<f64>,
    /// The best value that the equivalence theorem leaves possible in these orientations, in runs without ramps and ends.
    pub bound: f64,
    /// The gap of the approximate design: no other schedule in these orientations gains more than this, relative to the variance, the
    /// geometric mean of the variances, or the squared separation.
    pub gap: f64,
    /// The efficiency of the schedule relative to the bound: the ratio of variances, or of squared separations.
    pub efficiency: f64,
    /// The number of candidates: motions of the table in orientations of its axis.
    pub candidates: usize,
    /// The number of orientations among them.
    pub orientations: usize,
    /// The bound of the standard deviation of gyro.scale.z.
    pub scale_bound: ScaleBoundResult,
    /// The runs, one in each orientation, without switching off in between.
    pub runs: Vec<DesignedRunResult>,
    /// What is observable under the schedule.
    #[serde(flatten)]
    pub identifiability: IdentifiabilityResult,
    /// The given schedule, the usual ones of the same duration, and the optimal one at the end.
    pub schedules: Vec<ComparedResult>,
    /// The scenario files among the files.
    pub files: Vec<String>,
    /// What else is to be known.
    pub notes: Vec<String>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// The smallest standard deviation of gyro.scale.z that white noise of the gyro allows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScaleBoundResult {
    /// `N / (ω √T)` with the noise density, the fastest rate and the duration \[ppm\].
    pub bound_ppm: f64,
    /// The standard deviation under the optimal schedule \[ppm\]; null if the model does not have it.
    pub sigma_ppm: Option<f64>,
}

/// A run of the schedule.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DesignedRunResult {
    /// The axis of the IMU along the spin axis, as `[axis] spin`.
    pub spin: String,
    /// The attitude of the axis frame \[deg\].
    pub attitude_deg: EulerDegrees,
    /// The angle of the axis from the vertical \[deg\].
    pub tilt_deg: f64,
    /// The duration \[s\].
    pub duration_s: f64,
    /// What the table does.
    pub profile: Vec<DesignedSegmentResult>,
    /// The shares of the motions in the whole schedule, before they were rounded.
    pub shares: Vec<MotionResult>,
}

/// A part of a profile.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DesignedSegmentResult {
    /// Its start in the run \[s\].
    pub start_s: f64,
    /// The rate \[deg/s\].
    pub rate_deg_s: f64,
    /// How long it lasts, with the ramp at its start \[s\].
    pub duration_s: f64,
    /// The table angle at its end \[deg\], not wrapped.
    pub end_angle_deg: f64,
}

/// The share of a motion in an approximate design.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MotionResult {
    /// The rate \[deg/s\]; zero for a static interval.
    pub rate_deg_s: f64,
    /// The table angle of a static interval \[deg\]; null for a rotation.
    pub angle_deg: Option<f64>,
    /// The share.
    pub share: f64,
}

/// A schedule beside the others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ComparedResult {
    /// Its name.
    pub name: String,
    /// How long it takes \[s\].
    pub duration_s: f64,
    /// The value of the criterion; null if the schedule leaves it undetermined.
    pub value: Option<f64>,
    /// The number of parameters that are observable by themselves.
    pub observable: usize,
    /// The parameters.
    pub parameters: Vec<PredictedResult>,
}

/// The names of the scenario files.
pub(super) fn file_names(count: usize) -> Vec<String> {
    if count == 1 {
        return vec!["next.toml".into()];
    }
    (1..=count).map(|place| format!("next-{place}.toml")).collect()
}

impl DesignResult {
    pub(super) fn of(study: &DesignStudy) -> Self {
        let optimal = &study.optimal;
        let (value, unit) = study.figure(optimal.value);
        let identifiability = optimal.joint.identifiability();
        let sigma_ppm = identifiability
            .find(&format!("{}.z", catalogue::GYRO_SCALE.id))
            .map(|place| identifiability.parameters[place].sigma / PPM);
        let limits = &study.limits;
        Self {
            schema: crate::SCHEMA,
            command: "design".into(),
            model: study.model.clone(),
            goal: meaning(&study.goal, &study.service),
            criterion: study.criterion.into(),
            unit: unit.into(),
            limits: LimitsResult {
                rate_deg_s: limits.rate / DEG,
                acceleration_deg_s2: limits.acceleration / DEG,
                duration_s: limits.duration,
                directions: limits.directions,
            },
            value,
            given_value: study.compared[0].value.map(|value| study.figure(value).0),
            bound: study.figure(study.bound).0,
            gap: optimal.gap,
            efficiency: study.efficiency,
            candidates: optimal.candidates.0,
            orientations: optimal.candidates.1,
            scale_bound: ScaleBoundResult { bound_ppm: study.scale_bound() / PPM, sigma_ppm },
            runs: optimal.runs.iter().map(DesignedRunResult::of).collect(),
            identifiability: IdentifiabilityResult::of(&identifiability),
            schedules: study.compared.iter().map(|one| ComparedResult::of(one, study)).collect(),
            files: file_names(optimal.runs.len()),
            notes: notes(study),
            basis: study.basis.clone(),
        }
    }
}

impl DesignedRunResult {
    pub(super) fn of(run: &OptimalRun) -> Self {
        let attitude = run.planned.nav_from_table();
        let (mut start_s, mut angles) = (0.0, run.planned.angles(&run.segments).into_iter());
        let profile = run.segments.iter().map(|segment| {
            let part = DesignedSegmentResult {
                start_s,
                rate_deg_s: segment.rate / DEG,
                duration_s: segment.duration,
                end_angle_deg: angles.next().unwrap_or_default() / DEG,
            };
            start_s += segment.duration;
            part
        });
        let shares = run.shares.iter().map(|&(motion, share)| match motion {
            Motion::Rotation(rate) => {
                MotionResult { rate_deg_s: rate / DEG, angle_deg: None, share }
            }
            Motion::Dwell(angle) => {
                MotionResult { rate_deg_s: 0.0, angle_deg: Some(angle / DEG), share }
            }
        });
        Self {
            spin: Axes::from(run.planned.axes()).spin_name(),
            profile: profile.collect(),
            shares: shares.collect(),
            attitude_deg: attitude.euler_angles().into(),
            tilt_deg: attitude.matrix()[(2, 2)].clamp(-1.0, 1.0).acos() / DEG,
            duration_s: run.planned.duration(),
        }
    }
}

impl ComparedResult {
    fn of(compared: &Compared, study: &DesignStudy) -> Self {
        let identifiability = &compared.identifiability;
        let alone = identifiability
            .parameters
            .iter()
            .filter(|seen| seen.identifiable && seen.shown == Observable::Alone);
        Self {
            name: compared.name.clone(),
            duration_s: compared.duration,
            value: compared.value.map(|value| study.figure(value).0),
            observable: alone.count(),
            parameters: (0..identifiability.unknowns.len())
                .map(|place| PredictedResult::of(identifiability, place))
                .collect(),
        }
    }
}
