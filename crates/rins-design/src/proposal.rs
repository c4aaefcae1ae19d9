//! The next test: the shortest schedule that separates two effects, or shows a parameter well enough.

use nalgebra::DVector;
use rayon::prelude::*;
use rins_estimation::{Direction, Joint, distance};
use rins_terms::Model;

use crate::effect::Effect;
use crate::error::DesignError;
use crate::library::{Candidate, Limits, candidates};
use crate::pair::{ENOUGH, Pair, information, with_priors};
use crate::planned::Planned;

/// What is asked of the next schedule.
#[derive(Clone, Debug)]
pub enum Goal<'a> {
    /// Two effects, each in the directions in which the given schedule confuses it with the other.
    Separate {
        /// The effects.
        effects: &'a [Effect; 2],
        /// The directions of each, in units of its priors.
        confused: [Vec<DVector<f64>>; 2],
    },
    /// One parameter to this 1σ.
    Sigma {
        /// The effect, of one parameter.
        effect: &'a Effect,
        /// The 1σ, in SI units.
        sigma: f64,
    },
}

impl<'a> Goal<'a> {
    /// To separate two effects where one run of the given schedule confuses them.
    pub fn separate(effects: &'a [Effect; 2], given: &Pair) -> Self {
        let confused = given.separations.each_ref().map(|separation| {
            let along = |direction: &Direction| direction.along.clone();
            separation.directions.iter().map(along).collect()
        });
        Self::Separate { effects, confused }
    }

    /// What a schedule reaches, and whether that is enough: sigmas apart, or a 1σ in SI units.
    fn reached(&self, joint: &Joint) -> (f64, bool) {
        match self {
            Self::Separate { effects, confused } => {
                let [first, second] = effects.each_ref().map(|effect| effect.places(joint));
                let both: Vec<usize> = first.iter().chain(&second).copied().collect();
                let information = with_priors(joint, &both);
                let mut least = f64::INFINITY;
                for (own, alongs) in [first, second].iter().zip(confused) {
                    for along in alongs {
                        // What belongs to a run is of this size in the first.
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

    /// Whether one figure is nearer to the goal than another.
    fn better(&self, one: f64, other: f64) -> bool {
        match self {
            Self::Separate { .. } => one > other,
            Self::Sigma { .. } => one < other,
        }
    }
}

/// A schedule that reaches a goal, or comes nearest to it.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// The schedule.
    pub candidate: Candidate,
    /// What it reaches: sigmas apart, or a 1σ in SI units.
    pub reached: f64,
    /// Whether that is enough.
    pub enough: bool,
    /// What it says.
    pub joint: Joint,
}

/// The first schedule of the library that reaches the goal, or the one that comes nearest.
///
/// Schedules are of the IMU and at the place of the plan `given`. `tried` hears how many of how many have been looked at.
///
/// # Errors
/// [`DesignError::NothingFits`] if no schedule does within the limits, and whatever [`information`] returns.
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
        // Those of one duration are looked at together.
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
