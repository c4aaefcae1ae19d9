//! The selection of a few orientations of the axis from a pool.

use rayon::prelude::*;

use super::criterion::Criterion;
use super::objective::Objective;
use super::pool::{Pool, PoolDesign};
use crate::error::DesignError;
use crate::limits::Limits;

/// The gain by another orientation, relative to a variance, below which it is not worth a change.
const GAIN: f64 = 0.01;

/// The loss by leaving out motions of little use, relative to a variance.
const LOSS: f64 = 3e-3;

/// The gap at which orientations are compared.
const ROUGH: f64 = 1e-2;

/// The number of orientations of the whole pool that are considered, relative to the number that the schedule may have.
const MOST_AT_FIRST: usize = 2;

/// The largest number of changes for one pool.
const MOST_CHANGES: usize = 8;

/// A few orientations of a pool, and the best design of motions in them.
#[derive(Clone)]
pub(super) struct Selection<'a> {
    objective: &'a Objective<'a>,
    limits: &'a Limits,
    pub(super) criterion: Criterion,
    pub(super) design: PoolDesign,
}

impl<'a> Selection<'a> {
    /// The better of two starts, each improved: the first orientation of the pool, and the design of all orientations, from which one after
    /// the other is left out.
    pub(super) fn new(
        objective: &'a Objective<'a>,
        limits: &'a Limits,
        pool: &Pool<'_>,
    ) -> Result<Self, DesignError> {
        let (criterion, _) = objective.criterion(&[]);
        let close = (limits.duration, ROUGH);
        let design = pool.design(objective, &[0], close)?;
        let mut first = Self { objective, limits, criterion, design };
        first.improve(pool)?;
        if limits.directions == 1 {
            return Ok(first);
        }
        let all: Vec<usize> = (0..pool.orientations.len()).collect();
        let all = pool.design(objective, &all, close)?;
        let some = all.largest(MOST_AT_FIRST * limits.directions);
        let design = pool.design_near(objective, &some, Some(&all), close)?;
        let mut second = Self { design, ..first.clone() };
        while second.design.orientations.len() > limits.directions
            || !second.design.is_runnable(limits.duration)
        {
            let Some(fewer) = second.without_one(&second.design, pool)? else { break };
            second.design = fewer;
        }
        second.improve(pool)?;
        Ok(if first.gains(&second.design) { second } else { first })
    }

    /// Adds and exchanges orientations, one after the other, as long as that gains something.
    pub(super) fn improve(&mut self, pool: &Pool<'_>) -> Result<(), DesignError> {
        for _ in 0..MOST_CHANGES {
            let own = &self.design.orientations;
            let others = (0..pool.orientations.len()).filter(|place| !own.contains(place));
            let mut trials: Vec<Vec<usize>> = Vec::new();
            for other in others {
                if own.len() < self.limits.directions {
                    trials.push(own.iter().copied().chain([other]).collect());
                }
                trials.extend((0..own.len()).map(|place| {
                    let mut exchanged = own.clone();
                    exchanged[place] = other;
                    exchanged
                }));
            }
            let designs = trials
                .into_par_iter()
                .map(|trial| {
                    let close = (self.limits.duration, ROUGH);
                    pool.design_near(self.objective, &trial, Some(&self.design), close)
                })
                .collect::<Result<Vec<PoolDesign>, DesignError>>()?;
            let best = designs
                .into_iter()
                .filter(|design| design.is_runnable(self.limits.duration))
                .min_by(|a, b| a.design.value.total_cmp(&b.design.value));
            match best {
                Some(best) if self.gains(&best) => self.design = best,
                _ => return Ok(()),
            }
        }
        Ok(())
    }

    fn gains(&self, other: &PoolDesign) -> bool {
        self.criterion.efficiency(self.design.design.value, other.design.value) < 1.0 - GAIN
    }

    /// The best design without one of the orientations of this one, the one that is missed least; `None` if it has only one.
    fn without_one(
        &self,
        design: &PoolDesign,
        pool: &Pool<'_>,
    ) -> Result<Option<PoolDesign>, DesignError> {
        if design.orientations.len() < 2 {
            return Ok(None);
        }
        let without = |place: usize| {
            let mut kept = design.orientations.clone();
            kept.remove(place);
            pool.design_near(self.objective, &kept, Some(design), (self.limits.duration, ROUGH))
        };
        let designs = (0..design.orientations.len())
            .into_par_iter()
            .map(without)
            .collect::<Result<Vec<PoolDesign>, DesignError>>()?;
        Ok(designs.into_iter().min_by(|a, b| a.design.value.total_cmp(&b.design.value)))
    }

    /// The first orientation of the pool alone, then subsets of those selected, with more and more orientations; each with as few motions as
    /// it needs.
    pub(super) fn alternatives(&self, pool: &Pool<'_>) -> Result<Vec<PoolDesign>, DesignError> {
        let duration = self.limits.duration;
        let mut subsets = vec![self.design.orientations.clone()];
        let mut last = self.design.clone();
        while let Some(best) = self.without_one(&last, pool)? {
            subsets.push(best.orientations.clone());
            last = best;
        }
        subsets.push(vec![0]);
        subsets.reverse();
        subsets.dedup();
        let simplest = |mut subset: Vec<usize>| {
            subset.sort_unstable();
            let design = pool.design(self.objective, &subset, (duration, LOSS))?;
            Ok(pool.simplest(self.objective, design, (duration, LOSS)))
        };
        subsets.into_iter().map(simplest).collect()
    }
}
