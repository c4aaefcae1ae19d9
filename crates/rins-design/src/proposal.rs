//! The next test: the shortest schedule that distinguishes two effects, or determines a parameter with a required
//! uncertainty.

use nalgebra::DVector;
use rayon::prelude::*;
use rins_estimation::{Direction, Joint, distance};
use rins_terms::Model;

use crate::candidate::Candidate;
use crate::effect::Effect;
use crate::error::DesignError;
use crate::library::candidates;
use crate::limits::Limits;
use crate::pair::{ENOUGH, Pair, information, with_priors};
use crate::planned::Planned;

/// The goal of the next schedule.
#[derive(Clone, Debug)]
pub enum Goal<'a> {
    /// To distinguish two effects, each in the directions in which it is confused with the other under the given schedule.
    Separate {
        /// The effects.
        effects: &'a [Effect; 2],
        /// The directions of each, in units of its priors.
        confused: [Vec<DVector<f64>>; 2],
    },
    /// To determine one parameter with this 1σ.
    Sigma {
        /// The effect, which has one parameter.
        effect: &'a Effect,
        /// The 1σ, in SI units.
        sigma: f64,
    },
}

impl<'a> Goal<'a> {
    /// To distinguish two effects that one run of the given schedule confuses.
    pub fn separate(effects: &'a [Effect; 2], given: &Pair) -> Self {
        let confused = given.separations.each_ref().map(|separation| {
            let along = |direction: &Direction| direction.along.clone();
            separation.directions.iter().map(along).collect()
        });
        Self::Separate { effects, confused }
    }

    /// The result of a schedule, and whether it reaches the goal: the separation in sigmas, or a 1σ in SI units.
    fn reached(&self, joint: &Joint) -> (f64, bool) {
        match self {
            Self::Separate { effects, confused } => {
                let [first, second] = effects.each_ref().map(|effect| effect.places(joint));
                let both: Vec<usize> = first.iter().chain(&second).copied().collect();
                let information = with_priors(joint, &both);
                let mut least = f64::INFINITY;
                for (own, alongs) in [first, second].iter().zip(confused) {
                    for along in alongs {
                        // The size of parameters that belong to a run is that in the first run.
                        let n = along.len().min(own.len());
                        let along = along.rows(0, n).into_owned();
                        least = least.min(distance(&information, &own[..n], &along));
                    }
                }
                (least, least >= ENOUGH)
            }
            Self::Sigma { effect, sigma } => {
                let identifiability = joint.identifiability();
                let place = identifiability.find(&effect.ids[0]);
                let reached =
                    place.map_or(f64::INFINITY, |place| identifiability.parameters[place].sigma);
                (reached, reached <= *sigma)
            }
        }
    }

    /// Whether one result is closer to the goal than another.
    fn better(&self, one: f64, other: f64) -> bool {
        match self {
            Self::Separate { .. } => one > other,
            Self::Sigma { .. } => one < other,
        }
    }
}

/// A schedule that reaches a goal, or is the closest to it.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// The schedule.
    pub candidate: Candidate,
    /// The separation in sigmas, or a 1σ in SI units.
    pub reached: f64,
    /// Whether it reaches the goal.
    pub enough: bool,
    /// Its information.
    pub joint: Joint,
}

/// The first schedule of the library that reaches the goal, or the closest one.
///
/// The schedules are for the IMU and the site of the plan `given`. `tried` receives the number of evaluated schedules and the
/// total.
///
/// # Errors
/// [`DesignError::NothingFits`] if no schedule is within the limits, and all errors of [`information`].
pub fn propose(
    given: &Planned,
    model: &Model,
    goal: &Goal<'_>,
    limits: &Limits,
    mut tried: impl FnMut(usize, usize),
) -> Result<Proposal, DesignError> {
    let all = candidates(given, limits);
    let (mut looked_at, n_all) = (0, all.len());
    let mut best: Option<Proposal> = None;
    let mut all = all.into_iter().peekable();
    while let Some(first) = all.next() {
        // Schedules of equal duration are evaluated in parallel.
        let mut group = vec![first];
        while let Some(next) = all.next_if(|next| next.is_as_long_as(&group[0])) {
            group.push(next);
        }
        looked_at += group.len();
        tried(looked_at, n_all);
        let proposals = group
            .into_par_iter()
            .map(|candidate| {
                let joint = information(&candidate.runs, model)?;
                let (reached, enough) = goal.reached(&joint);
                Ok(Proposal { candidate, reached, enough, joint })
            })
            .collect::<Result<Vec<Proposal>, DesignError>>()?;
        for proposal in proposals {
            if proposal.enough {
                return Ok(proposal);
            }
            let nearer =
                best.as_ref().is_none_or(|best| goal.better(proposal.reached, best.reached));
            if nearer {
                best = Some(proposal);
            }
        }
    }
    best.ok_or(DesignError::NothingFits)
}
