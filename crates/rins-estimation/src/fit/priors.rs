//! The priors of an estimation problem.

use rins_terms::FreeParameter;

use super::Problem;

impl Problem<'_> {
    /// The sigmas of the priors.
    pub(super) fn sigmas(&self) -> Vec<f64> {
        self.layout.all.iter().map(|(free, _)| free.sigma).collect()
    }

    /// The means of the priors minus the values.
    pub(super) fn offsets(&self) -> Vec<f64> {
        self.expected.iter().zip(&self.values).map(|(expected, value)| expected - value).collect()
    }

    /// The id of the parameter that is farthest from its prior, and its distance in prior sigmas.
    pub(super) fn farthest(&self) -> (String, f64) {
        let distances = self
            .offsets()
            .into_iter()
            .zip(&self.layout.all)
            .map(|(offset, (free, _))| (free.id.clone(), (offset / free.sigma).abs()));
        distances.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default()
    }

    /// The sum of squares of these offsets in units of the priors' sigmas.
    pub(super) fn pull(&self) -> f64 {
        let of = |(offset, (free, _)): (f64, &(FreeParameter, Option<usize>))| {
            (offset / free.sigma).powi(2)
        };
        self.offsets().into_iter().zip(&self.layout.all).map(of).sum()
    }
}
