//! An optimal schedule and the schedules beside it.

use rins_design::{Limits, Objective, OptimalSchedule, Planned, information, value};
use rins_estimation::Identifiability;
use rins_terms::Model;

use super::goal::{DesignGoal, InService, figure_of};
use crate::basis::BasisResult;
use crate::observe::schedule::Schedule;

/// All that was found.
#[derive(Debug)]
pub(super) struct DesignStudy {
    /// The given scenarios.
    pub(super) name: String,
    pub(super) model: String,
    pub(super) goal: DesignGoal,
    pub(super) limits: Limits,
    pub(super) service: InService,
    pub(super) optimal: OptimalSchedule,
    /// The given schedule, the usual ones, and the optimal one at the end.
    pub(super) compared: Vec<Compared>,
    /// The bound of all schedules in these orientations, as a value of the criterion.
    pub(super) bound: f64,
    /// The efficiency of the schedule relative to the bound.
    pub(super) efficiency: f64,
    /// The kind of criterion.
    pub(super) criterion: &'static str,
    /// The white noise of the gyros \[rad/√s\].
    pub(super) gyro_noise: f64,
    pub(super) is_time_dependent: bool,
    /// The scenario files of the schedule.
    pub(super) scenarios: Vec<String>,
    pub(super) basis: BasisResult,
}

/// A schedule with what it shows.
#[derive(Debug)]
pub(super) struct Compared {
    pub(super) name: String,
    pub(super) duration: f64,
    /// The value of the criterion; `None` if the schedule leaves it undetermined.
    pub(super) value: Option<f64>,
    pub(super) identifiability: Identifiability,
}

impl Compared {
    pub(super) fn of(
        name: String,
        runs: &[Planned],
        model: &Model,
        objective: &Objective<'_>,
    ) -> anyhow::Result<Self> {
        let joint = information(runs, model)?;
        Ok(Self {
            name,
            duration: runs.iter().map(Planned::duration).sum(),
            value: value(objective, &joint),
            identifiability: joint.identifiability(),
        })
    }

    /// The given schedule, as runs of one power-on: all schedules are compared as such.
    pub(super) fn given(
        schedule: &Schedule,
        model: &Model,
        objective: &Objective<'_>,
    ) -> anyhow::Result<Self> {
        let runs: Vec<Planned> = schedule.runs.iter().map(|run| run.clone().since(0)).collect();
        Self::of("given".into(), &runs, model, objective)
    }

    pub(super) fn optimal(optimal: &OptimalSchedule) -> Self {
        Self {
            name: "optimal".into(),
            duration: optimal.runs.iter().map(|run| run.planned.duration()).sum(),
            value: Some(optimal.value),
            identifiability: optimal.joint.identifiability(),
        }
    }
}

impl DesignStudy {
    /// The figure that a reader sees of a value of the criterion, and its unit.
    pub(super) fn figure(&self, value: f64) -> (f64, &'static str) {
        figure_of(&self.goal, &self.optimal.joint.unknowns, value)
    }

    /// The smallest possible σ of a scale error about the spin axis: angle noise against the angle of rotation, `N / (ω √T)`.
    pub(super) fn scale_bound(&self) -> f64 {
        self.gyro_noise / (self.limits.rate * self.limits.duration.sqrt())
    }
}
