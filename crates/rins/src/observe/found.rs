//! What was found of schedules, and the one to run next.

use rins_design::{Effect, Goal, Limits, Pair, Proposal, propose};
use rins_estimation::Identifiability;
use rins_terms::Model;

use super::schedule::{Schedule, scenarios};
use crate::basis::BasisResult;
use crate::progress::Progress;

/// What was found of one schedule.
#[derive(Debug)]
pub(super) struct Observed {
    pub(super) schedule: Schedule,
    pub(super) identifiability: Identifiability,
    pub(super) pair: Option<Pair>,
}

/// All that was found.
#[derive(Debug)]
pub(super) struct ObservabilityStudy {
    pub(super) model: String,
    pub(super) observed: Vec<Observed>,
    pub(super) effects: Option<[Effect; 2]>,
    pub(super) wanted: Option<(Effect, f64)>,
    pub(super) limits: Limits,
    pub(super) proposal: Option<Proposal>,
    /// What the proposal makes of the pair.
    pub(super) proposed_pair: Option<Pair>,
    /// The scenario files of the proposal.
    pub(super) scenarios: Vec<String>,
    pub(super) basis: BasisResult,
}

impl ObservabilityStudy {
    /// Looks for the next schedule, if the given one does not do.
    pub(super) fn search(&mut self, model: &Model, progress: &Progress) -> anyhow::Result<()> {
        let given = &self.observed[0];
        let goal = match (&self.effects, &given.pair, &self.wanted) {
            (Some(effects), Some(pair), _) if !pair.is_separated() => Goal::separate(effects, pair),
            (None, _, Some((effect, sigma))) if !given.knows(effect, *sigma) => {
                Goal::Sigma { effect, sigma: *sigma }
            }
            _ => return Ok(()),
        };
        let stage = progress.begin("looking for a schedule", None);
        let heard = |tried: usize, all: usize| {
            stage.at(&format!("looking for a schedule, {tried} of {all}"));
        };
        let proposal = propose(&given.schedule.runs[0], model, &goal, &self.limits, heard)?;
        drop(stage);
        self.proposed_pair =
            self.effects.as_ref().map(|effects| Pair::of(&proposal.joint, effects));
        self.scenarios = scenarios(&proposal, &given.schedule.paths[0], &self.limits)?;
        self.proposal = Some(proposal);
        Ok(())
    }
}

impl Observed {
    /// Whether a parameter is known to this 1σ.
    pub(super) fn knows(&self, effect: &Effect, sigma: f64) -> bool {
        self.identifiability
            .find(&effect.ids[0])
            .is_some_and(|place| self.identifiability.parameters[place].sigma <= sigma)
    }
}
