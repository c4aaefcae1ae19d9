//! What calibrations say of the parameters, and the conditions of their runs.

use anyhow::Context;
use nalgebra::{DMatrix, DVector};
use rins_history::{Conditions, History, Quantity, RunEstimate};
use rins_io::{Calibration, Covariance, Measured, Parameter, parameters};

use super::source::Source;
use crate::homogeneity::conditions;

/// A parameter counts as observed by a run if its 1σ is this part of the 1σ before at most.
const OBSERVED: f64 = 0.5;

/// The typical range of the variations of a parameter, relative to the 1σ before a calibration: as of the data sheet's parameters in the
/// catalogue of effects.
const TYPICAL: (f64, f64) = (0.01, 3.0);

/// The same relative to the smallest 1σ of the estimates, of a calibration that does not state what was known before.
const UNSTATED: (f64, f64) = (1.0, 1e3);

/// The parameters that at least two runs observe: their ids and units.
pub(super) struct Observed {
    pub(super) ids: Vec<String>,
    pub(super) units: Vec<&'static str>,
}

/// The 1σ of a parameter in a list.
fn sigma(list: &[Parameter], id: &str) -> Option<f64> {
    list.iter().find(|one| one.id == id).map(|one| one.value)
}

impl Observed {
    pub(super) fn of(sources: &[Source]) -> Self {
        let all = sources.first().map(|source| parameters(&source.calibration.error));
        let observes = |calibration: &Calibration, id: &str| {
            let before = sigma(&calibration.priors, id);
            sigma(&calibration.sigmas, id)
                .is_some_and(|own| before.is_none_or(|before| own < OBSERVED * before))
        };
        let several = |one: &Parameter| {
            sources.iter().filter(|source| observes(&source.calibration, &one.id)).count() > 1
        };
        let (ids, units) =
            all.into_iter().flatten().filter(several).map(|one| (one.id, one.unit)).unzip();
        Self { ids, units }
    }

    /// The history of these parameters, by the covariances of the runs that are independent of each other.
    pub(super) fn history(
        &self,
        sources: &[Source],
        covariances: &[Option<Covariance>],
    ) -> anyhow::Result<History> {
        let measured: Vec<Measured> =
            sources.iter().map(|source| source.calibration.measured.clone()).collect();
        let conditions = conditions(&measured);
        let runs = sources.iter().zip(covariances).zip(&conditions);
        let runs = runs.map(|((source, covariance), conditions)| {
            let covariance = covariance.as_ref();
            self.estimate(&source.calibration, covariance, *conditions)
                .with_context(|| source.name.clone())
        });
        let typical = |id: &String| {
            let each = || sources.iter().map(|source| &source.calibration);
            let before = each().filter_map(|one| sigma(&one.priors, id)).reduce(f64::max);
            let own = each().filter_map(|one| sigma(&one.sigmas, id)).fold(f64::INFINITY, f64::min);
            let (unit, range) = before.map_or((own, UNSTATED), |before| (before, TYPICAL));
            Quantity { id: id.clone(), typical: (range.0 * unit, range.1 * unit) }
        };
        let quantities = self.ids.iter().map(typical).collect();
        Ok(History::new(quantities, runs.collect::<anyhow::Result<_>>()?)?)
    }

    /// What one run says of the parameters: the inverse of the covariance, less what was known before.
    fn estimate(
        &self,
        calibration: &Calibration,
        covariance: Option<&Covariance>,
        conditions: Conditions,
    ) -> anyhow::Result<RunEstimate> {
        let all = parameters(&calibration.error);
        let own: Vec<usize> = (0..self.ids.len())
            .filter(|&place| sigma(&calibration.sigmas, &self.ids[place]).is_some())
            .collect();
        let of = |row: usize, column: usize| {
            let [a, b] = [row, column].map(|at| &self.ids[own[at]]);
            let stated = covariance.and_then(|covariance| {
                let [row, column] =
                    [a, b].map(|id| covariance.ids.iter().position(|other| other == id));
                Some(covariance.matrix[(row?, column?)])
            });
            let alone = || {
                let sigma = sigma(&calibration.sigmas, a).unwrap_or(f64::INFINITY);
                if row == column { sigma * sigma } else { 0.0 }
            };
            stated.unwrap_or_else(alone)
        };
        let values: Vec<f64> = own
            .iter()
            .map(|&place| {
                all.iter().find(|one| one.id == self.ids[place]).map_or(0.0, |one| one.value)
            })
            .collect();
        let covariance = DMatrix::from_fn(own.len(), own.len(), of);
        let n = self.ids.len();
        let mut estimate = RunEstimate::measured(conditions, (n, &own), &values, &covariance)?;
        let before = |place: usize| {
            sigma(&calibration.priors, &self.ids[place]).map_or(0.0, |sigma| sigma.powi(-2))
        };
        let known = DMatrix::from_diagonal(&DVector::from_fn(n, |place, _| before(place)));
        estimate.information = without(&estimate.information, &known);
        let mut value = DVector::zeros(n);
        for (&place, one) in own.iter().zip(&values) {
            value[place] = *one;
        }
        estimate.score = &estimate.information * value;
        Ok(estimate)
    }
}

/// The information less what was `known` before, in units of this where it is stated; nothing where rounding makes it less than nothing.
fn without(information: &DMatrix<f64>, known: &DMatrix<f64>) -> DMatrix<f64> {
    let n = information.nrows();
    let unit = |place: usize| {
        let known: f64 = known[(place, place)];
        if known > 0.0 {
            known.sqrt()
        } else {
            information[(place, place)].max(f64::MIN_POSITIVE).sqrt()
        }
    };
    let scaled =
        DMatrix::from_fn(n, n, |a, b| (information[(a, b)] - known[(a, b)]) / (unit(a) * unit(b)));
    let eigen = scaled.symmetric_eigen();
    let kept = DMatrix::from_diagonal(&eigen.eigenvalues.map(|value| value.max(0.0)));
    let scaled = &eigen.eigenvectors * kept * eigen.eigenvectors.transpose();
    DMatrix::from_fn(n, n, |a, b| scaled[(a, b)] * unit(a) * unit(b))
}
