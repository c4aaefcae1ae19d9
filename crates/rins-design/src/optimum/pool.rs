//! The pool of candidates: motions in orientations of the axis, as elements of a design.

use nalgebra::DMatrix;
use rins_estimation::Unknown;
use rins_frames::{Dcm, Nav, Table};
use rins_terms::{FreeParameter, Model, Owner};

use super::approximate::ApproximateDesign;
use super::element::Element;
use super::motion::{Motion, informations};
use super::objective::Objective;
use crate::error::DesignError;
use crate::library::Limits;
use crate::planned::Planned;

/// Two orientations whose axes differ by less are one \[rad\].
const SAME: f64 = 1e-6;

/// The pool of candidates.
pub(super) struct Pool<'a> {
    given: &'a Planned,
    model: &'a Model,
    limits: &'a Limits,
    free: Vec<FreeParameter>,
    motions: Vec<Motion>,
    /// The attitude of the axis frame in each orientation.
    pub(super) orientations: Vec<Dcm<Nav, Table>>,
    /// The information of each motion in each orientation for one second.
    informations: Vec<Vec<DMatrix<f64>>>,
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
    pub(super) fn new(given: &'a Planned, model: &'a Model, limits: &'a Limits) -> Self {
        Self {
            given,
            model,
            limits,
            free: model.free(&given.imu),
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
        attitudes: impl IntoIterator<Item = Dcm<Nav, Table>>,
    ) -> Result<(), DesignError> {
        let first = self.orientations.len();
        for attitude in attitudes {
            let same =
                |other: &Dcm<Nav, Table>| (other.matrix() - attitude.matrix()).abs().max() < SAME;
            if !self.orientations.iter().any(same) {
                self.orientations.push(attitude);
            }
        }
        let pieces: Vec<(Dcm<Nav, Table>, Motion)> = self.orientations[first..]
            .iter()
            .flat_map(|&attitude| self.motions.iter().map(move |&motion| (attitude, motion)))
            .collect();
        let all = informations(self.given, self.model, self.limits, &pieces)?;
        self.informations.extend(all.chunks(self.motions.len()).map(<[_]>::to_vec));
        Ok(())
    }

    /// The parameters of all runs, which are in one power-on.
    pub(super) fn unknowns(&self) -> Vec<Unknown> {
        let shared = self.free.iter().filter(|free| free.owner != Owner::Placement);
        let unknown = |free: &FreeParameter| Unknown {
            id: free.id.clone(),
            model_id: free.id.clone(),
            run: None,
            unit: free.unit,
            sigma: free.sigma,
        };
        shared.map(unknown).collect()
    }

    /// The places of a run's parameters: those of all runs, then those of its orientation.
    fn order(&self) -> Vec<usize> {
        let is_own = |place: &usize| self.free[*place].owner == Owner::Placement;
        let (own, mut order): (Vec<usize>, Vec<usize>) = (0..self.free.len()).partition(is_own);
        order.extend(own);
        order
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
        let all = 0..self.motions.len();
        let candidates: Vec<(usize, usize)> = orientations
            .iter()
            .flat_map(|&group| all.clone().map(move |motion| (group, motion)))
            .collect();
        self.of_candidates(objective, &candidates, (duration, close))
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
            let Ok(simple) = self.of_candidates(objective, &candidates, (duration, loss)) else {
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
        (duration, close): (f64, f64),
    ) -> Result<PoolDesign, DesignError> {
        let (criterion, prior) = objective.criterion(&self.unknowns());
        let order = self.order();
        let element = |&(group, motion): &(usize, usize)| {
            let information = &self.informations[group][motion];
            let information = duration * information.select_rows(&order).select_columns(&order);
            Element { group, information }
        };
        let elements: Vec<Element> = candidates.iter().map(element).collect();
        let design = ApproximateDesign::of(&prior, &elements, &criterion, close)
            .ok_or(DesignError::Undetermined)?;
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
        Ok(PoolDesign { orientations, shares, design })
    }
}

impl PoolDesign {
    /// The share of the orientation that has the smallest one.
    pub(super) fn least(&self) -> f64 {
        let whole = |shares: &Vec<(Motion, f64)>| shares.iter().map(|(_, share)| share).sum();
        self.shares.iter().map(whole).fold(1.0, f64::min)
    }
}
