//! What a schedule is optimized for.

use nalgebra::{DMatrix, DVector};
use rins_estimation::Unknown;

use super::criterion::Criterion;
use crate::effect::Effect;

/// The information of the prior on a parameter of an effect that has none in a separation, relative to its usual prior: enough to invert a
/// matrix.
const ALMOST_NONE: f64 = 1e-6;

/// A linear function of parameters: ids, each with a coefficient in SI units. A parameter of a run is that of the first run.
pub type LinearFunction = Vec<(String, f64)>;

/// What a schedule is optimized for.
#[derive(Clone, Debug)]
pub enum Objective<'a> {
    /// The sum of the variances of linear functions: c-optimal for one, A-optimal for several.
    Variance(Vec<LinearFunction>),
    /// The determinant of the covariance of these parameters: D-optimal.
    Determinant(Vec<String>),
    /// The smallest separation of two effects, each of them in these directions, in units of its priors.
    Separation {
        /// The effects.
        effects: &'a [Effect; 2],
        /// The directions of each.
        along: [Vec<DVector<f64>>; 2],
    },
}

impl Objective<'_> {
    /// Whether a parameter with this id is part of it.
    pub fn has(&self, id: &str) -> bool {
        match self {
            Self::Variance(functions) => functions.iter().flatten().any(|(own, _)| own == id),
            Self::Determinant(ids) => ids.iter().any(|own| own == id),
            Self::Separation { effects, .. } => {
                effects.iter().flat_map(|effect| &effect.ids).any(|own| own == id)
            }
        }
    }

    /// The criterion on the information of these unknowns, in units of their priors, and the information of the priors.
    pub fn criterion(&self, unknowns: &[Unknown]) -> (Criterion, DVector<f64>) {
        let of_first = |unknown: &Unknown| unknown.run.is_none_or(|run| run == 0);
        let place =
            |id: &str| unknowns.iter().position(|unknown| unknown.id == id && of_first(unknown));
        let mut prior = DVector::from_element(unknowns.len(), 1.0);
        let criterion = match self {
            Self::Variance(functions) => {
                let mut all = DMatrix::zeros(unknowns.len(), functions.len());
                for (column, function) in functions.iter().enumerate() {
                    for (id, coefficient) in function {
                        if let Some(row) = place(id) {
                            all[(row, column)] += coefficient * unknowns[row].sigma;
                        }
                    }
                }
                Criterion::Variance(all)
            }
            Self::Determinant(ids) => {
                let places: Vec<usize> = ids.iter().filter_map(|id| place(id)).collect();
                let all = DMatrix::from_fn(unknowns.len(), places.len(), |row, column| {
                    f64::from(u8::from(places[column] == row))
                });
                Criterion::Determinant(all)
            }
            Self::Separation { effects, along } => {
                let mut signatures = Vec::new();
                for (effect, along) in effects.iter().zip(along) {
                    let own: Vec<usize> = effect.ids.iter().filter_map(|id| place(id)).collect();
                    for &place in &own {
                        prior[place] = ALMOST_NONE;
                    }
                    for along in along {
                        let size = along.len().min(own.len());
                        signatures.push((own[..size].to_vec(), along.rows(0, size).into_owned()));
                    }
                }
                Criterion::Distance(signatures)
            }
        };
        (criterion, prior)
    }
}
