//! What schedules show, for a machine.

use rins_design::{ENOUGH, Pair, Proposal};
use rins_estimation::Separation;
use rins_frames::units::DEG;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::found::{ObservabilityStudy, Observed};
use crate::basis::BasisResult;
use crate::finite::finite;
use crate::identifiability::{IdentifiabilityResult, PredictedResult};
use crate::values::EulerDegrees;

/// The result of `rins observe`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ObserveResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `observe`.
    pub command: String,
    /// The model.
    pub model: String,
    /// The schedules.
    pub schedules: Vec<ScheduleResult>,
    /// The limits of the table within which the next schedule is sought.
    pub limits: LimitsResult,
    /// The schedule to run next; null if the given one does, or nothing was asked.
    pub proposal: Option<ProposalResult>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// One schedule: one scenario, or several as runs of one IMU.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ScheduleResult {
    /// What it is called: the file names.
    pub name: String,
    /// The scenario files.
    pub scenarios: Vec<String>,
    /// How long it takes \[s\].
    pub duration_s: f64,
    /// What is observable of all parameters together.
    #[serde(flatten)]
    pub identifiability: IdentifiabilityResult,
    /// The parameters.
    pub parameters: Vec<PredictedResult>,
    /// How well it separates the two effects that were asked for.
    pub separation: Option<SeparationsResult>,
}

/// How well a schedule separates two effects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SeparationsResult {
    /// By how many sigmas the two must differ.
    pub required_sigma: f64,
    /// Whether they do, each of its typical size.
    pub separated: bool,
    /// The first effect against the second, and the second against the first.
    pub each: [SeparationResult; 2],
}

/// How well a schedule separates one effect from another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SeparationResult {
    /// The effect.
    pub effect: Option<String>,
    /// The other.
    pub from: Option<String>,
    /// By what the other effect increases its 1σ in its worst direction; null if it is not separated at all.
    pub kappa: Option<f64>,
    /// By how many sigmas it differs from the other in its worst direction.
    pub separation_sigma: f64,
    /// Its directions that have a counterpart in the other, the most alike first.
    pub directions: Vec<DirectionResult>,
    /// How many of its directions the model absorbs.
    pub absorbed: usize,
}

/// A direction of an effect's parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DirectionResult {
    /// By what the other effect increases its 1σ; null if it is not separated at all.
    pub kappa: Option<f64>,
    /// By how many sigmas it is seen without the other.
    pub detection_sigma: f64,
    /// By how many it differs from the other.
    pub separation_sigma: f64,
    /// The direction, in units of the priors.
    pub along: Vec<f64>,
}

/// The limits of a table.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LimitsResult {
    /// Its fastest rate \[deg/s\].
    pub rate_deg_s: f64,
    /// Its acceleration \[deg/s²\].
    pub acceleration_deg_s2: f64,
    /// The longest that all runs may take together \[s\].
    pub duration_s: f64,
    /// Into how many directions its axis may be brought.
    pub directions: usize,
}

/// A schedule to run next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ProposalResult {
    /// What it is, in words.
    pub schedule: String,
    /// How long it takes in all \[s\].
    pub duration_s: f64,
    /// What the table does in each direction of its axis.
    pub profile: Vec<SegmentResult>,
    /// The attitude of the axis frame in each run \[deg\].
    pub attitude_deg: Vec<EulerDegrees>,
    /// Whether it reaches what was asked for.
    pub sufficient: bool,
    /// By how many sigmas the two effects differ.
    pub separation_sigma: Option<f64>,
    /// The 1σ of the parameter that was asked for, in its unit.
    pub sigma: Option<f64>,
    /// How well it separates the two effects.
    pub separation: Option<SeparationsResult>,
    /// The scenario files among the files.
    pub files: Vec<String>,
}

/// A part of a profile.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SegmentResult {
    /// The rate \[deg/s\].
    pub rate_deg_s: f64,
    /// How long it lasts \[s\].
    pub duration_s: f64,
}

impl ObserveResult {
    pub(super) fn of(found: &ObservabilityStudy) -> Self {
        let limits = &found.limits;
        Self {
            schema: crate::SCHEMA,
            command: "observe".into(),
            model: found.model.clone(),
            schedules: found
                .observed
                .iter()
                .map(|observed| ScheduleResult::of(observed, found))
                .collect(),
            limits: LimitsResult {
                rate_deg_s: limits.rate / DEG,
                acceleration_deg_s2: limits.acceleration / DEG,
                duration_s: limits.duration,
                directions: limits.directions,
            },
            proposal: found.proposal.as_ref().map(|proposal| ProposalResult::of(proposal, found)),
            basis: found.basis.clone(),
        }
    }
}

impl ScheduleResult {
    fn of(
        Observed { schedule, identifiability, pair }: &Observed,
        found: &ObservabilityStudy,
    ) -> Self {
        let paths = schedule.paths.iter().map(|path| path.display().to_string());
        Self {
            name: schedule.name.clone(),
            scenarios: paths.collect(),
            duration_s: schedule.duration(),
            identifiability: IdentifiabilityResult::of(identifiability),
            parameters: (0..identifiability.unknowns.len())
                .map(|place| PredictedResult::of(identifiability, place))
                .collect(),
            separation: pair.as_ref().map(|pair| SeparationsResult::of(pair, found)),
        }
    }
}

impl SeparationsResult {
    fn of(pair: &Pair, found: &ObservabilityStudy) -> Self {
        let name = |place: usize| found.effects.as_ref().map(|effects| effects[place].name.clone());
        let of = |place: usize| {
            let separation: &Separation = &pair.separations[place];
            let directions = separation.directions.iter().map(|direction| DirectionResult {
                kappa: finite(direction.kappa),
                detection_sigma: direction.detection,
                separation_sigma: direction.separation,
                along: direction.along.as_slice().to_vec(),
            });
            SeparationResult {
                effect: name(place),
                from: name(1 - place),
                kappa: finite(separation.kappa()),
                separation_sigma: pair.separation[place],
                directions: directions.collect(),
                absorbed: separation.absorbed[0],
            }
        };
        Self { required_sigma: ENOUGH, separated: pair.is_separated(), each: [of(0), of(1)] }
    }
}

impl ProposalResult {
    fn of(proposal: &Proposal, found: &ObservabilityStudy) -> Self {
        let candidate = &proposal.candidate;
        let profile = candidate
            .segments
            .iter()
            .map(|part| SegmentResult { rate_deg_s: part.rate / DEG, duration_s: part.duration });
        let attitudes = candidate.runs.iter().map(|run| run.nav_from_table().euler_angles().into());
        let files = (1..=candidate.runs.len()).map(|place| format!("next-{place}.toml"));
        let sigma = found.wanted.as_ref().and_then(|(effect, _)| {
            let identifiability = proposal.joint.identifiability();
            let place = identifiability.find(&effect.ids[0])?;
            Some(
                identifiability.parameters[place].sigma
                    / identifiability.unknowns[place].unit.factor,
            )
        });
        let pair = found.proposed_pair.as_ref();
        Self {
            schedule: candidate.words.clone(),
            duration_s: candidate.duration,
            profile: profile.collect(),
            attitude_deg: attitudes.collect(),
            sufficient: proposal.enough,
            separation_sigma: found.effects.as_ref().map(|_| proposal.reached),
            sigma,
            separation: pair.map(|pair| SeparationsResult::of(pair, found)),
            files: files.collect(),
        }
    }
}
