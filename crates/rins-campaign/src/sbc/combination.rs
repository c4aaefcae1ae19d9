//! The combinations of parameters that data determine well: eigenvectors of the posterior covariance.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::posterior::PosteriorRun;

/// A parameter or a combination is well determined if its posterior sigma is below this fraction of its prior sigma.
pub const DETERMINED: f64 = 0.5;

/// Combinations of parameters, each with a prior sigma of 1: eigenvectors of the posterior covariance in units of the prior sigmas.
///
/// The combination `k` of the parameters `x` is the sum of `weights[(i, k)] x[i] / prior_sigma[i]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Combinations {
    /// Unit vectors (parameters × combinations).
    pub weights: DMatrix<f64>,
    /// The posterior sigma of each, where they were determined; its prior sigma is 1. In ascending order.
    pub ratios: Vec<f64>,
}

/// The normalized estimation error squared of the well-determined combinations of one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nees {
    /// The NEES: chi-squared if the posterior is consistent.
    pub value: f64,
    /// Its degrees of freedom: the number of combinations.
    pub dof: usize,
}

/// The covariance in units of the prior sigmas.
fn scaled(covariance: &DMatrix<f64>, prior_sigmas: &[f64]) -> DMatrix<f64> {
    DMatrix::from_fn(prior_sigmas.len(), prior_sigmas.len(), |row, column| {
        covariance[(row, column)] / (prior_sigmas[row] * prior_sigmas[column])
    })
}

impl Combinations {
    /// The well-determined combinations of a posterior covariance (n × n) with these prior sigmas.
    ///
    /// The largest weight of each is positive.
    ///
    /// # Panics
    /// If the covariance has another size.
    pub fn of(covariance: &DMatrix<f64>, prior_sigmas: &[f64]) -> Self {
        let eigen = SymmetricEigen::new(scaled(covariance, prior_sigmas));
        let mut places: Vec<usize> = (0..prior_sigmas.len())
            .filter(|&place| eigen.eigenvalues[place] < DETERMINED * DETERMINED)
            .collect();
        places.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let ratios = places.iter().map(|&place| eigen.eigenvalues[place].max(0.0).sqrt()).collect();
        let mut weights = eigen.eigenvectors.select_columns(&places);
        for mut column in weights.column_iter_mut() {
            if column[column.icamax()] < 0.0 {
                column.neg_mut();
            }
        }
        Self { weights, ratios }
    }

    /// The error of each combination in a run, and its posterior sigma.
    pub(super) fn errors(&self, run: &PosteriorRun) -> Vec<(f64, f64)> {
        let error = run.scaled_error();
        let covariance = scaled(&run.covariance, &run.prior_sigmas);
        let of = |weights: nalgebra::DVectorView<'_, f64>| {
            let variance = weights.dot(&(&covariance * weights));
            (weights.dot(&error), variance.max(0.0).sqrt())
        };
        self.weights.column_iter().map(of).collect()
    }

    /// The part of each parameter that lies in the combinations, from 0 to 1.
    pub fn shares(&self) -> Vec<f64> {
        self.weights.row_iter().map(|row| row.norm_squared()).collect()
    }
}

impl Nees {
    /// The NEES of a run in the combinations that its own covariance determines well.
    pub fn of(run: &PosteriorRun) -> Self {
        let eigen = SymmetricEigen::new(scaled(&run.covariance, &run.prior_sigmas));
        let along: DVector<f64> = eigen.eigenvectors.tr_mul(&run.scaled_error());
        let mut nees = Self { value: 0.0, dof: 0 };
        for (&variance, component) in eigen.eigenvalues.iter().zip(&along) {
            if variance < DETERMINED * DETERMINED {
                // A covariance that is not positive definite is too small.
                nees.value +=
                    if variance > 0.0 { component.powi(2) / variance } else { f64::INFINITY };
                nees.dof += 1;
            }
        }
        nees
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two parameters of which only the sum is measured.
    fn run(errors: [f64; 2]) -> PosteriorRun {
        // Prior sigmas 1 and 10; a + b / 10 is known to 0.1.
        let information = DMatrix::from_row_slice(2, 2, &[1.0 + 50.0, 5.0, 5.0, 0.01 + 0.5]);
        PosteriorRun {
            truth: vec![0.0, 0.0],
            estimate: errors.to_vec(),
            prior_sigmas: vec![1.0, 10.0],
            covariance: information.try_inverse().unwrap(),
        }
    }

    #[test]
    fn the_measured_sum_is_the_combination() {
        let run = run([0.1, 2.0]);
        let found = Combinations::of(&run.covariance, &run.prior_sigmas);
        assert_eq!(found.ratios.len(), 1);
        let half = 0.5_f64.sqrt();
        for weight in found.weights.iter() {
            assert!((weight - half).abs() < 1e-9, "{weight}");
        }
        // The information of the data about (a + b / 10)/√2 is 100, that of the prior 1.
        let sigma = (1.0_f64 / 101.0).sqrt();
        assert!((found.ratios[0] / sigma - 1.0).abs() < 1e-9);
        assert!(found.shares().iter().all(|share| (share - 0.5).abs() < 1e-9));
        let [(error, of)] = found.errors(&run)[..] else { panic!("one combination") };
        assert!((error - 0.3 * half).abs() < 1e-12 && (of / sigma - 1.0).abs() < 1e-9);
        let nees = Nees::of(&run);
        assert!(nees.dof == 1 && (nees.value / (error / sigma).powi(2) - 1.0).abs() < 1e-9);
    }
}
