//! Criteria of a design, and the equivalence theorem for each.

use nalgebra::{Cholesky, DMatrix, DVector};

/// The exponent of the smooth minimum of several squared distances: it is below the minimum by a factor of at most `n^(1/60)`.
const SHARPNESS: f64 = 60.0;

/// A criterion, as a convex function of the information matrix `M` (p × p).
#[derive(Clone, Debug, PartialEq)]
pub enum Criterion {
    /// The sum of the variances of the linear functions in the columns of `K` (p × s), `tr Kᵀ M⁻¹ K`: c-optimal for one column,
    /// A-optimal for unit columns.
    Variance(DMatrix<f64>),
    /// The determinant of the covariance of the linear functions in the columns of `K` (p × s), `ln det Kᵀ M⁻¹ K`: D-optimal, and
    /// D-optimal for a subset of the parameters.
    Determinant(DMatrix<f64>),
    /// The smallest squared distance `aᵀ (M₁₁ - M₁₂ M₂₂⁻¹ M₂₁) a` of several signatures, each with the places of its parameters and its size
    /// `a`; all other parameters are estimated too.
    Distance(Vec<(Vec<usize>, DVector<f64>)>),
}

/// A criterion at an information matrix, with its derivatives.
#[derive(Clone, Debug)]
pub(super) struct Tangent {
    /// The criterion as it is minimized.
    pub(super) value: f64,
    /// `Y` (p × s): the derivative along an information `N` is `-tr Yᵀ N Y / scale`.
    pub(super) directions: DMatrix<f64>,
    /// The scale of a gap.
    pub(super) scale: f64,
    /// What the smooth minimum adds to a gap, before it is scaled.
    pub(super) slack: f64,
}

impl Criterion {
    /// The value at an information matrix: a variance, the mean logarithm of variances, or minus the logarithm of a squared distance.
    ///
    /// `None` if the information matrix is not positive definite.
    pub fn value(&self, information: &DMatrix<f64>) -> Option<f64> {
        match self {
            Self::Variance(_) => Some(self.tangent(information)?.value),
            Self::Determinant(functions) => {
                Some(self.tangent(information)?.value / functions.ncols() as f64)
            }
            Self::Distance(signatures) => {
                let distances = distances(signatures, information)?;
                Some(
                    -distances.iter().map(|(square, _)| *square).fold(f64::INFINITY, f64::min).ln(),
                )
            }
        }
    }

    /// The value that a gap (relative to the value) leaves possible: a lower bound of all designs.
    pub fn bound(&self, value: f64, gap: f64) -> f64 {
        match self {
            Self::Variance(_) => value * (1.0 - gap).max(0.0),
            Self::Determinant(_) => value - gap,
            Self::Distance(_) => value - gap.ln_1p(),
        }
    }

    /// The gap of a design with this value, given a bound.
    pub fn gap(&self, value: f64, bound: f64) -> f64 {
        match self {
            Self::Variance(_) => 1.0 - bound / value,
            Self::Determinant(_) => value - bound,
            Self::Distance(_) => (value - bound).exp_m1(),
        }
    }

    /// The efficiency of a design with this value relative to one with another value: the ratio of the times that both need for
    /// the same result where there is no prior.
    pub fn efficiency(&self, value: f64, best: f64) -> f64 {
        match self {
            Self::Variance(_) => best / value,
            Self::Determinant(_) | Self::Distance(_) => (best - value).exp(),
        }
    }

    /// The value and the derivatives at an information matrix; `None` if that is not positive definite.
    pub(super) fn tangent(&self, information: &DMatrix<f64>) -> Option<Tangent> {
        match self {
            Self::Variance(functions) => {
                let directions = Cholesky::new(information.clone())?.solve(functions);
                let value = functions.dot(&directions);
                finite(Tangent { value, directions, scale: value, slack: 0.0 })
            }
            Self::Determinant(functions) => {
                let solved = Cholesky::new(information.clone())?.solve(functions);
                let covariance = functions.transpose() * &solved;
                let factor = Cholesky::new(0.5 * (&covariance + covariance.transpose()))?;
                let lower = factor.l();
                let value = 2.0 * lower.diagonal().map(f64::ln).sum();
                let whitened = lower.solve_lower_triangular(&solved.transpose())?;
                let scale = functions.ncols() as f64;
                finite(Tangent { value, directions: whitened.transpose(), scale, slack: 0.0 })
            }
            Self::Distance(signatures) => {
                let all = distances(signatures, information)?;
                let least = all.iter().map(|(square, _)| *square).fold(f64::INFINITY, f64::min);
                if least <= 0.0 {
                    return None;
                }
                let shares: Vec<f64> =
                    all.iter().map(|(square, _)| (square / least).powf(-SHARPNESS - 1.0)).collect();
                let whole: f64 = shares.iter().sum();
                let sum: f64 =
                    all.iter().map(|(square, _)| (square / least).powf(-SHARPNESS)).sum();
                let mean: f64 = all
                    .iter()
                    .zip(&shares)
                    .map(|((square, _), share)| square * share / whole)
                    .sum();
                let columns: Vec<DVector<f64>> = all
                    .iter()
                    .zip(&shares)
                    .map(|((_, along), share)| along * (share / whole).sqrt())
                    .collect();
                finite(Tangent {
                    value: sum.ln() / SHARPNESS - least.ln(),
                    directions: DMatrix::from_columns(&columns),
                    scale: least,
                    slack: mean - least,
                })
            }
        }
    }
}

fn finite(tangent: Tangent) -> Option<Tangent> {
    (tangent.value.is_finite() && tangent.directions.iter().all(|one| one.is_finite()))
        .then_some(tangent)
}

/// The squared distance of each signature, and the combination of all parameters (p) that attains it.
fn distances(
    signatures: &[(Vec<usize>, DVector<f64>)],
    information: &DMatrix<f64>,
) -> Option<Vec<(f64, DVector<f64>)>> {
    let of = |(own, size): &(Vec<usize>, DVector<f64>)| {
        let others: Vec<usize> =
            (0..information.nrows()).filter(|place| !own.contains(place)).collect();
        let block = information.select_rows(&others).select_columns(&others);
        let mut along = DVector::zeros(information.nrows());
        for (&place, &part) in own.iter().zip(size.iter()) {
            along[place] = part;
        }
        if !others.is_empty() {
            let across = (information * &along).select_rows(&others);
            let absorbed = Cholesky::new(block)?.solve(&across);
            for (&place, &part) in others.iter().zip(absorbed.iter()) {
                along[place] = -part;
            }
        }
        let square = along.dot(&(information * &along));
        Some((square, along))
    };
    signatures.iter().map(of).collect()
}
