//! The selection of a few orientations of the axis from a pool.

use rayon::prelude::*;

use super::criterion::Criterion;
use super::objective::Objective;
use super::pool::{Pool, PoolDesign};
use crate::error::DesignError;
use crate::library::Limits;

/// The shortest run in an orientation \[s\].
const SHORTEST_RUN: f64 = 20.0;

/// The gain by another orientation, relative to a variance, below which it is not worth a change.
const GAIN: f64 = 0.01;

/// The loss by leaving out motions of little use, relative to a variance.
const LOSS: f64 = 3e-3;

/// The gap at which orientations are compared.
const ROUGH: f64 = 1e-2;

/// The largest number of changes for one pool.
const MOST_CHANGES: usize = 8;

/// A few orientations of a pool, and the best design of motions in them.
pub(super) struct Selection<'a> {
    objective: &'a Objective<'a>,
    limits: &'a Limits,
    pub(super) criterion: Criterion,
    pub(super) design: PoolDesign,
}

impl<'a> Selection<'a> {
    /// The first orientation of the pool.
    pub(super) fn new(
        objective: &'a Objective<'a>,
        limits: &'a Limits,
        pool: &Pool<'_>,
    ) -> Result<Self, DesignError> {
        let (criterion, _) = objective.criterion(&[]);
        let design = pool.design(objective, &[0], (limits.duration, ROUGH))?;
        Ok(Self { objective, limits, criterion, design })
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
                .map(|trial| pool.design(self.objective, &trial, (self.limits.duration, ROUGH)))
                .collect::<Result<Vec<PoolDesign>, DesignError>>()?;
            let best = designs
                .into_iter()
                .filter(|design| self.is_runnable(design))
                .min_by(|a, b| a.design.value.total_cmp(&b.design.value));
            match best {
                Some(best) if self.gains(&best) => self.design = best,
                _ => return Ok(()),
            }
        }
        Ok(())
    }

    /// Whether each run is long enough.
    fn is_runnable(&self, design: &PoolDesign) -> bool {
        design.orientations.len() == 1 || design.least() * self.limits.duration >= SHORTEST_RUN
    }

    fn gains(&self, other: &PoolDesign) -> bool {
        self.criterion.efficiency(self.design.design.value, other.design.value) < 1.0 - GAIN
    }

    /// The first orientation of the pool alone, then subsets of those selected, with more and more orientations; each with as few motions as
    /// it needs.
    pub(super) fn alternatives(&self, pool: &Pool<'_>) -> Result<Vec<PoolDesign>, DesignError> {
        let duration = self.limits.duration;
        let mut subsets = vec![self.design.orientations.clone()];
        let mut last = self.design.clone();
        while last.orientations.len() > 1 {
            // Without the orientation that is missed least.
            let without = (0..last.orientations.len()).map(|place| {
                let mut kept = last.orientations.clone();
                kept.remove(place);
                pool.design(self.objective, &kept, (duration, ROUGH))
            });
            let designs = without.collect::<Result<Vec<PoolDesign>, DesignError>>()?;
            let Some(best) =
                designs.into_iter().min_by(|a, b| a.design.value.total_cmp(&b.design.value))
            else {
                break;
            };
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
