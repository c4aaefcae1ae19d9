//! The uncertainty due to parameters that the data hardly show, of second order.
//!
//! The readings depend on products of parameters: with all axes of a triad turned by a small angle `α` the scale errors change by
//! `α²/2`. If the data do not show `α`, a linear covariance has nothing of this change, and the scale errors may be determined
//! far better than that.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rayon::prelude::*;
use rins_terms::Unit;

use super::Problem;
use crate::fit_error::FitError;
use crate::linear::Pieces;
use crate::noise_parameters::Noise;
use crate::posterior::Posterior;

/// The data show less than half of a direction's prior uncertainty if its posterior variance, relative to that of the prior, is
/// larger.
const HARDLY_SHOWN: f64 = 0.25;

/// Half the square of an angle matters if it exceeds this fraction of the smallest 1σ of a ratio.
const MATTERS: f64 = 0.1;

/// The largest number of directions of which products are calculated.
const MOST_PAIRS: usize = 6;

impl Problem<'_> {
    /// What the second order, and the uncertainty of the colored noise (`around`), add to the covariance.
    pub(super) fn beyond_first_order(
        &mut self,
        posterior: &Posterior,
        noise: &[Noise],
        around: &[[Vec<Noise>; 2]],
    ) -> Result<DMatrix<f64>, FitError> {
        let mut added = self.of_second_order(posterior, noise);
        // The bias instability is determined by few data: the covariance is the mean over its uncertainty and the resulting
        // changes of the estimate.
        let sides: Vec<&Vec<Noise>> = around.iter().flatten().collect();
        let others = sides
            .into_par_iter()
            .map(|side| self.posterior(&self.linear, side, 0).map(|(_, other)| other));
        for other in others.collect::<Result<Vec<_>, _>>()? {
            let moved = &other.step - &posterior.step;
            added += (&other.covariance - &posterior.covariance + &moved * moved.transpose()) / 6.0;
        }
        Ok(added)
    }

    /// The addition to the covariance by the second-order effect of directions that the data hardly show.
    ///
    /// Along a direction `v` of one posterior sigma, the estimate of all parameters is `z v + z² c` with `z` normal; `c` is half
    /// the sum of the steps back from `v` and from `-v`.
    fn of_second_order(&mut self, posterior: &Posterior, noise: &[Noise]) -> DMatrix<f64> {
        let count = self.values.len();
        let mut added = DMatrix::zeros(count, count);
        let directions = self.hardly_shown(posterior);
        if directions.is_empty() {
            return added;
        }
        let estimate = self.values.clone();
        let mut step_from = |sign: f64, direction: &DVector<f64>| {
            self.values = estimate.iter().zip(direction).map(|(at, by)| at + sign * by).collect();
            self.take_values(Pieces::Coarse);
            self.posterior(&self.linear, noise, 0).ok().map(|(_, posterior)| posterior.step)
        };
        let none = step_from(0.0, &directions[0]).unwrap_or_else(|| DVector::zeros(count));
        // Of each direction the even and the odd part of the steps: the bend, and the way back.
        let mut parts = |direction: &DVector<f64>| {
            let steps = [1.0, -1.0].map(|sign| step_from(sign, direction));
            let [Some(there), Some(back)] = steps else {
                return (DVector::zeros(count), -direction);
            };
            (0.5 * (&there + &back) - &none, 0.5 * (there - back))
        };
        let (bends, ways): (Vec<DVector<f64>>, Vec<DVector<f64>>) =
            directions.iter().map(&mut parts).unzip();
        // The moments of products of independent normal variables.
        let sum: DVector<f64> = bends.iter().sum();
        added += &sum * sum.transpose();
        for bend in &bends {
            added += 2.0 * bend * bend.transpose();
        }
        if directions.len() <= MOST_PAIRS {
            for (place, one) in directions.iter().enumerate() {
                for (other, another) in directions.iter().enumerate().skip(place + 1) {
                    // The odd parts of two directions add up, but for terms of third order.
                    let Some(both) = step_from(1.0, &(one + another)) else { continue };
                    let bend = both - &none - &ways[place] - &ways[other];
                    let product = bend - &bends[place] - &bends[other];
                    added += &product * product.transpose();
                }
            }
        }
        self.values = estimate;
        self.take_values(Pieces::Samples);
        added
    }

    /// The directions that the data hardly show and whose angles are large enough, each of one posterior sigma, in SI units.
    fn hardly_shown(&self, posterior: &Posterior) -> Vec<DVector<f64>> {
        let sigmas = DVector::from_vec(self.sigmas());
        let relative = DMatrix::from_fn(sigmas.len(), sigmas.len(), |row, column| {
            posterior.covariance[(row, column)] / (sigmas[row] * sigmas[column])
        });
        let is_angle = |place: usize| self.layout.all[place].0.unit.symbol == Unit::ARCSEC.symbol;
        let is_ratio = |place: usize| self.layout.all[place].0.unit.symbol == Unit::PPM.symbol;
        let ratios = (0..sigmas.len()).filter(|&place| is_ratio(place));
        let finest = ratios.map(|place| posterior.sigma(place)).fold(f64::INFINITY, f64::min);
        let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(relative);
        let direction = |place: usize| {
            let scaled =
                eigenvectors.column(place).component_mul(&sigmas) * eigenvalues[place].sqrt();
            let angle: f64 =
                (0..scaled.len()).filter(|&at| is_angle(at)).map(|at| scaled[at].powi(2)).sum();
            (0.5 * angle > MATTERS * finest).then_some(scaled)
        };
        let hardly = (0..sigmas.len()).filter(|&place| eigenvalues[place] > HARDLY_SHOWN);
        hardly.filter_map(direction).collect()
    }
}
