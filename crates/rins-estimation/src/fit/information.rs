//! The evidence of all runs, and of what joins them, on the joint parameters.

use rayon::prelude::*;

use super::Problem;
use super::drift::Deviations;
use crate::evidence::Indefinite;
use crate::fit_error::FitError;
use crate::layout::Layout;
use crate::linear::Linear;
use crate::noise_parameters::Noise;
use crate::posterior::{Evidence, Posterior};
use crate::turn::{self, LinearTurn};

/// The noise is estimated again if the sum of squared residuals differs from its expectation by more than this fraction.
const MISJUDGED: f64 = 0.1;

impl Problem<'_> {
    /// Whether the residuals agree with the noise at the estimate.
    pub(super) fn fits(&self, evidence: &Evidence) -> bool {
        let figures = evidence.figures as f64;
        let dof = figures - self.layout.all.len() as f64;
        (evidence.square - dof).abs() < MISJUDGED * figures
    }

    /// The evidence of each run on its parameters.
    fn of_runs(linear: &[Linear], noise: &[Noise]) -> Result<Vec<Evidence>, Indefinite> {
        let runs = linear.par_iter().zip(noise);
        runs.map(|(linear, noise)| Evidence::of(linear, noise)).collect()
    }

    /// The deviations of the biases of each run from the shared ones, as additions to its parameters.
    pub(super) fn moved(&self, noise: &[Noise]) -> Result<Vec<Vec<f64>>, Indefinite> {
        let counts: Vec<usize> = self.linear.iter().map(|linear| linear.parameters).collect();
        if self.sequences.is_empty() {
            return Ok(counts.iter().map(|&count| vec![0.0; count]).collect());
        }
        let of_runs = Self::of_runs(&self.linear, noise)?;
        let count = self.layout.all.len();
        let deviations = Deviations::new(&self.sequences, &self.linear, noise, count);
        let none = Evidence::none(count);
        let extended = self.extended((&none, &of_runs), &deviations, (&self.linear, noise));
        Ok(deviations.estimated(&extended, &counts))
    }

    fn evidence(&self, linear: &[Linear], noise: &[Noise]) -> Result<Evidence, Indefinite> {
        let of_runs = Self::of_runs(linear, noise)?;
        let Layout { all, places, signs } = &self.layout;
        let mut sum = Evidence::none(all.len());
        for (of_run, (places, signs)) in of_runs.iter().zip(places.iter().zip(signs)) {
            sum.add(of_run, places, signs);
        }
        if self.sequences.is_empty() && self.turns.is_empty() {
            return Ok(sum);
        }
        let deviations = Deviations::new(&self.sequences, linear, noise, all.len());
        let extended = self.extended((&sum, &of_runs), &deviations, (linear, noise));
        Ok(deviations.integrated_out(&extended).unwrap_or(sum))
    }

    /// The evidence of runs and of the rotations between them on the joint parameters and on the deviations of the biases.
    fn extended(
        &self,
        (sum, of_runs): (&Evidence, &[Evidence]),
        deviations: &Deviations<'_>,
        (linear, noise): (&[Linear], &[Noise]),
    ) -> Evidence {
        let count = self.layout.all.len();
        let wide = |turn: &LinearTurn| deviations.widened(turn.slope(), turn.runs(), &self.layout);
        let mut extended = turn::evidence(&self.turns, (linear, noise), deviations.len(), wide);
        for (run, of_run) in of_runs.iter().enumerate() {
            deviations.add_run(&mut extended, of_run, run, &self.layout);
        }
        extended.add(sum, &(0..count).collect::<Vec<_>>(), &vec![1.0; count]);
        extended
    }

    pub(super) fn log_likelihood(&self, noise: &[Noise]) -> Option<f64> {
        self.evidence(&self.linear, noise).ok()?.log_likelihood(&self.sigmas(), &self.offsets())
    }

    pub(super) fn posterior(
        &self,
        linear: &[Linear],
        noise: &[Noise],
        iteration: usize,
    ) -> Result<(Evidence, Posterior), FitError> {
        let evidence = self.evidence(linear, noise)?;
        let posterior = evidence.posterior(&self.sigmas(), &self.offsets());
        let finite = posterior.filter(|posterior| posterior.log_likelihood.is_finite());
        Ok((evidence, finite.ok_or(FitError::NoInformation { iteration })?))
    }
}
