//! The pool of candidates: motions in orientations of the axis, as elements of a design.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use nalgebra::DMatrix;
use rins_estimation::Unknown;
use rins_frames::{Dcm, Nav, SignedAxes, Table};
use rins_terms::{FreeParameter, Model};

use super::approximate::{ApproximateDesign, NEGLIGIBLE};
use super::element::Element;
use super::motion::{Motion, informations};
use super::mounting::Mounting;
use super::objective::Objective;
use crate::error::DesignError;
use crate::limits::Limits;
use crate::planned::Planned;

/// The shortest run in one of several orientations \[s\].
const SHORTEST_RUN: f64 = 20.0;

/// Two orientations whose axes differ by less are one \[rad\].
const SAME: f64 = 1e-6;

/// The pool of candidates.
pub(super) struct Pool<'a> {
    given: &'a Planned,
    limits: &'a Limits,
    mountings: Vec<Mounting>,
    /// The parameters that all runs share.
    shared: Vec<FreeParameter>,
    motions: Vec<Motion>,
    /// The orientations.
    pub(super) orientations: Vec<Orientation>,
    /// The information of each motion in each orientation for one second, on the parameters of a run.
    informations: Vec<Arc<Vec<DMatrix<f64>>>>,
}

/// An orientation of the spin axis and of the IMU about it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Orientation {
    /// The attitude of the axis frame.
    pub(super) attitude: Dcm<Nav, Table>,
    /// The mounting of the IMU, of those of the pool.
    pub(super) mounting: usize,
}

/// A design of motions in some orientations of a pool.
#[derive(Clone, Debug)]
pub(super) struct PoolDesign {
    /// The orientations.
    pub(super) orientations: Vec<usize>,
    /// The shares of the motions in each of them.
    pub(super) shares: Vec<Vec<(Motion, f64)>>,
    /// The design.
    pub(super) design: ApproximateDesign,
}

impl<'a> Pool<'a> {
    /// A pool without candidates, for an IMU that can be mounted with these axes. The model is along the sensors' own axes.
    pub(super) fn new(
        given: &'a Planned,
        model: &Model,
        limits: &'a Limits,
        axes: &[SignedAxes],
    ) -> Self {
        let (mountings, shared) = Mounting::all(axes, model, &given.imu);
        Self {
            given,
            limits,
            mountings,
            shared,
            motions: Motion::all(limits),
            orientations: Vec::new(),
            informations: Vec::new(),
        }
    }

    /// The number of candidates.
    pub(super) fn candidates(&self) -> usize {
        self.orientations.len() * self.motions.len()
    }

    /// Adds those of these orientations that are not yet in the pool.
    ///
    /// # Errors
    /// As of [`information`](crate::information).
    pub(super) fn add(
        &mut self,
        orientations: impl IntoIterator<Item = Orientation>,
    ) -> Result<(), DesignError> {
        let first = self.orientations.len();
        for one in orientations {
            let same = |other: &Orientation| {
                other.mounting == one.mounting && is_same(&other.attitude, &one.attitude)
            };
            if !self.orientations.iter().any(same) {
                self.orientations.push(one);
            }
        }
        // Mountings with the same model differ in the names of the parameters only.
        let model = |one: &Orientation| &self.mountings[one.mounting].model;
        let known = |place: usize| {
            let one = &self.orientations[place];
            self.orientations[..place].iter().position(|other| {
                model(other) == model(one) && is_same(&other.attitude, &one.attitude)
            })
        };
        let added = first..self.orientations.len();
        let sources: Vec<Option<usize>> = added.clone().map(known).collect();
        let pieces: Vec<(Dcm<Nav, Table>, &Model, Motion)> = added
            .zip(&sources)
            .filter(|(_, source)| source.is_none())
            .flat_map(|(place, _)| {
                let one = &self.orientations[place];
                let (attitude, model) = (one.attitude, model(one));
                self.motions.iter().map(move |&motion| (attitude, model, motion))
            })
            .collect();
        let all = informations(self.given, self.limits, &pieces)?;
        let mut computed = all.chunks(self.motions.len()).map(|chunk| Arc::new(chunk.to_vec()));
        for source in sources {
            let information = source.map(|place| self.informations[place].clone());
            self.informations.extend(information.or_else(|| computed.next()));
        }
        Ok(())
    }

    /// The axes of a mounting.
    pub(super) fn axes(&self, mounting: usize) -> SignedAxes {
        self.mountings[mounting].axes
    }

    /// The parameters of all runs, which are in one power-on.
    pub(super) fn unknowns(&self) -> Vec<Unknown> {
        let unknown = |free: &FreeParameter| Unknown {
            id: free.id.clone(),
            model_id: free.id.clone(),
            run: None,
            unit: free.unit,
            sigma: free.sigma,
        };
        self.shared.iter().map(unknown).collect()
    }

    /// The best design of motions in these orientations for runs of this total duration \[s\], to a gap `close`.
    ///
    /// # Errors
    /// [`DesignError::Undetermined`] if it leaves a parameter of the objective undetermined.
    pub(super) fn design(
        &self,
        objective: &Objective<'_>,
        orientations: &[usize],
        (duration, close): (f64, f64),
    ) -> Result<PoolDesign, DesignError> {
        self.design_near(objective, orientations, None, (duration, close))
    }

    /// The same from the shares of a design of some of these orientations.
    pub(super) fn design_near(
        &self,
        objective: &Objective<'_>,
        orientations: &[usize],
        near: Option<&PoolDesign>,
        (duration, close): (f64, f64),
    ) -> Result<PoolDesign, DesignError> {
        let all = 0..self.motions.len();
        let candidates: Vec<(usize, usize)> = orientations
            .iter()
            .flat_map(|&group| all.clone().map(move |motion| (group, motion)))
            .collect();
        let start = near.map(|near| near.start(orientations, self.motions.len()));
        self.of_candidates(objective, &candidates, start, (duration, close))
    }

    /// The same design, or a nearly equal one, with the fewest motions in each orientation.
    pub(super) fn simplest(
        &self,
        objective: &Objective<'_>,
        design: PoolDesign,
        (duration, loss): (f64, f64),
    ) -> PoolDesign {
        let (criterion, _) = objective.criterion(&[]);
        for count in 1..self.motions.len() {
            let candidates: Vec<(usize, usize)> = design
                .orientations
                .iter()
                .zip(&design.shares)
                .flat_map(|(&group, shares)| {
                    let mut order: Vec<usize> = (0..shares.len()).collect();
                    order.sort_by(|&a, &b| shares[b].1.total_cmp(&shares[a].1));
                    order.truncate(count);
                    order.into_iter().map(move |motion| (group, motion)).collect::<Vec<_>>()
                })
                .collect();
            let Ok(simple) = self.of_candidates(objective, &candidates, None, (duration, loss))
            else {
                continue;
            };
            if criterion.efficiency(simple.design.value, design.design.value) > 1.0 - loss {
                let bound = criterion.bound(design.design.value, design.design.gap);
                let gap = criterion.gap(simple.design.value, bound);
                return PoolDesign { design: ApproximateDesign { gap, ..simple.design }, ..simple };
            }
        }
        design
    }

    fn of_candidates(
        &self,
        objective: &Objective<'_>,
        candidates: &[(usize, usize)],
        start: Option<Vec<f64>>,
        (duration, close): (f64, f64),
    ) -> Result<PoolDesign, DesignError> {
        let (criterion, prior) = objective.criterion(&self.unknowns());
        let element = |&(group, motion): &(usize, usize)| {
            let mounting = &self.mountings[self.orientations[group].mounting];
            let information = duration * mounting.of_design(&self.informations[group][motion]);
            Element { group, information }
        };
        let elements: Vec<Element> = candidates.iter().map(element).collect();
        let mut design = match start {
            Some(start) => {
                ApproximateDesign::from_start(&prior, &elements, &criterion, (start, close))
            }
            None => ApproximateDesign::of(&prior, &elements, &criterion, close),
        }
        .ok_or(DesignError::Undetermined)?;
        // A run takes some time even if the optimum has it for an instant.
        let groups: Vec<usize> = candidates.iter().map(|(group, _)| *group).collect();
        if let Some(weights) = extended(&design.weights, &groups, SHORTEST_RUN / duration) {
            design = design
                .with_weights(weights, &prior, &elements, &criterion)
                .ok_or(DesignError::Undetermined)?;
        }
        let mut orientations: Vec<usize> = Vec::new();
        let mut shares: Vec<Vec<(Motion, f64)>> = Vec::new();
        for (&(group, motion), &weight) in candidates.iter().zip(&design.weights) {
            if orientations.last() != Some(&group) {
                orientations.push(group);
                shares.push(Vec::new());
            }
            if let Some(last) = shares.last_mut() {
                last.push((self.motions[motion], weight));
            }
        }
        let (orientations, shares) =
            orientations.into_iter().zip(shares).filter(|(_, shares)| whole(shares) > 0.0).unzip();
        Ok(PoolDesign { orientations, shares, design })
    }
}

/// The weights with at least the share `least` for each group that has one, if there are several such groups and there is enough for all; the
/// others have less in proportion. `None` if nothing changes.
fn extended(weights: &[f64], groups: &[usize], least: f64) -> Option<Vec<f64>> {
    let mut shares: BTreeMap<usize, f64> = BTreeMap::new();
    for (&group, weight) in groups.iter().zip(weights) {
        *shares.entry(group).or_default() += weight;
    }
    shares.retain(|_, share| *share > 0.0);
    if shares.len() < 2 || shares.len() as f64 * least > 1.0 {
        return None;
    }
    let mut short: BTreeSet<usize> = BTreeSet::new();
    let scale = loop {
        let rest: f64 =
            shares.iter().filter(|(group, _)| !short.contains(group)).map(|(_, share)| share).sum();
        let scale = (1.0 - least * short.len() as f64) / rest;
        let more =
            shares.iter().find(|(group, share)| !short.contains(group) && **share * scale < least);
        match more {
            Some((&group, _)) => short.insert(group),
            None => break scale,
        };
    };
    let factor = |group: &usize| match shares.get(group) {
        Some(share) if short.contains(group) => least / share,
        _ => scale,
    };
    let changed =
        || groups.iter().zip(weights).map(|(group, weight)| weight * factor(group)).collect();
    (!short.is_empty()).then(changed)
}

/// The share of all motions together.
pub(super) fn whole(shares: &[(Motion, f64)]) -> f64 {
    shares.iter().map(|(_, share)| share).sum()
}

fn is_same(one: &Dcm<Nav, Table>, other: &Dcm<Nav, Table>) -> bool {
    (one.matrix() - other.matrix()).abs().max() < SAME
}

impl PoolDesign {
    /// Shares of all motions in these orientations: those of this design, and for an orientation that it does not have the even part of one
    /// orientation.
    fn start(&self, orientations: &[usize], motions: usize) -> Vec<f64> {
        let even = 1.0 / (orientations.len() * motions) as f64;
        let mut shares: Vec<f64> = Vec::new();
        for orientation in orientations {
            match self.orientations.iter().position(|own| own == orientation) {
                Some(place) => shares.extend(self.shares[place].iter().map(|(_, share)| share)),
                None => shares.extend(std::iter::repeat_n(even, motions)),
            }
        }
        let whole: f64 = shares.iter().sum();
        for share in &mut shares {
            *share /= whole;
        }
        shares
    }

    /// At most so many orientations with a share, those with the largest ones, in the order of the pool.
    pub(super) fn largest(&self, count: usize) -> Vec<usize> {
        let share = |place: &usize| whole(&self.shares[*place]);
        let mut places: Vec<usize> = (0..self.orientations.len()).collect();
        places.sort_by(|a, b| share(b).total_cmp(&share(a)));
        places.truncate(count);
        places.sort_unstable();
        places.into_iter().map(|place| self.orientations[place]).collect()
    }

    /// The same design without one of the motions of a run that has several, for each of them.
    pub(super) fn without_a_motion(&self) -> impl Iterator<Item = Self> {
        let runs = self.shares.iter().enumerate();
        let used = runs.flat_map(|(run, shares)| {
            let used: Vec<usize> =
                (0..shares.len()).filter(|&motion| shares[motion].1 > NEGLIGIBLE).collect();
            let several = used.len() > 1;
            used.into_iter().filter(move |_| several).map(move |motion| (run, motion))
        });
        used.map(|(run, motion)| {
            let mut fewer = self.clone();
            fewer.shares[run][motion].1 = 0.0;
            // The run keeps its time.
            let longer = whole(&self.shares[run]) / whole(&fewer.shares[run]);
            for (_, share) in &mut fewer.shares[run] {
                *share *= longer;
            }
            fewer
        })
    }

    /// Whether runs of this total duration \[s\] are long enough in each orientation.
    pub(super) fn is_runnable(&self, duration: f64) -> bool {
        let least = self.shares.iter().map(|shares| whole(shares)).fold(1.0, f64::min);
        self.orientations.len() == 1 || least * duration > SHORTEST_RUN * (1.0 - 1e-9)
    }
}
