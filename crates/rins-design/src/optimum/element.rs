//! Candidates of a design, and the information of their shares.

use std::collections::BTreeMap;

use nalgebra::{Cholesky, DMatrix, DVector};

/// A candidate of a design: its information if all observations were of this kind.
///
/// It is on the parameters of the design (p), then on those that only the candidates of its group have (q).
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// The group, from zero.
    pub group: usize,
    /// The information ((p + q) × (p + q), positive semidefinite).
    pub information: DMatrix<f64>,
}

/// How much of the parameters of each group (q × p) is estimated with those of the design.
pub(super) type Absorbed = BTreeMap<usize, DMatrix<f64>>;

/// The information of a design.
#[derive(Clone, Debug)]
pub(super) struct State {
    /// That on the parameters of the design (p × p), with the prior.
    pub(super) shared: DMatrix<f64>,
    /// For each group with a share, its parameters against those of the design (q × p), and its own (q × q), with the prior.
    pub(super) groups: BTreeMap<usize, (DMatrix<f64>, DMatrix<f64>)>,
}

impl State {
    pub(super) fn of(prior: &DVector<f64>, elements: &[Element], weights: &[f64]) -> Self {
        let mut state = Self { shared: DMatrix::from_diagonal(prior), groups: BTreeMap::new() };
        for (element, &weight) in elements.iter().zip(weights).filter(|(_, weight)| **weight > 0.0)
        {
            state.add(element, weight);
        }
        state
    }

    pub(super) fn add(&mut self, element: &Element, weight: f64) {
        let shared = self.shared.nrows();
        let own = element.information.nrows() - shared;
        self.shared += weight * element.information.view((0, 0), (shared, shared));
        if own == 0 {
            return;
        }
        let (across, inside) = self
            .groups
            .entry(element.group)
            .or_insert_with(|| (DMatrix::zeros(own, shared), DMatrix::identity(own, own)));
        *across += weight * element.information.view((shared, 0), (own, shared));
        *inside += weight * element.information.view((shared, shared), (own, own));
    }

    /// The information on the parameters of the design if those of the groups are estimated too, and how much of the parameters of each group
    /// (q × p) is then estimated with them.
    pub(super) fn marginal(&self) -> Option<(DMatrix<f64>, Absorbed)> {
        let mut marginal = self.shared.clone();
        let mut absorbed = BTreeMap::new();
        for (&group, (across, inside)) in &self.groups {
            let by = Cholesky::new(inside.clone())?.solve(across);
            marginal -= across.transpose() * &by;
            absorbed.insert(group, by);
        }
        Some((0.5 * (&marginal + marginal.transpose()), absorbed))
    }
}

/// What an additional share of a candidate is worth, with the directions `Y` of the tangent.
pub(super) fn usefulness(directions: &DMatrix<f64>, absorbed: &Absorbed, element: &Element) -> f64 {
    let shared = directions.nrows();
    let own = element.information.nrows() - shared;
    let mut all = directions.clone().resize_vertically(shared + own, 0.0);
    if let Some(by) = absorbed.get(&element.group) {
        all.rows_mut(shared, own).copy_from(&-(by * directions));
    }
    all.dot(&(&element.information * &all))
}
