//! A scheme in service: how its table moves, and how its errors grow.

use anyhow::Context;
use nalgebra::{DMatrix, SMatrix};
use rins_design::Growth;
use rins_io::{RotationScheme, shown};
use rins_terms::Model;

use super::case::{Case, OfStates};
use super::radial::probable_radius;
use super::simulated::{Simulated, Wish};
use super::uncertainty::Uncertainty;
use super::want::Wanted;

/// A scheme with its navigation errors.
#[derive(Clone, Debug)]
pub(super) struct SchemeInService {
    pub(super) name: String,
    /// The position error east and north by the stated errors, at each time \[m\].
    pub(super) by_errors: Option<Vec<[f64; 2]>>,
    /// The secular growth of the error east by the stated errors \[m/s\], if the carrier is at rest and a cycle is whole revolutions.
    pub(super) law: Option<f64>,
    /// The errors by the uncertainties, at each time.
    pub(super) by_uncertainty: Option<Vec<Spread>>,
    /// The same without the calibration, if there is one.
    pub(super) before: Option<Vec<Spread>>,
    /// The radial position error at the end by each source alone, 1σ \[m\]; the largest first.
    pub(super) budget: Vec<(String, f64)>,
    /// The simulated draws.
    pub(super) simulated: Option<Simulated>,
    /// What a wanted figure asks for.
    pub(super) wanted: Option<Wanted>,
}

/// The spread of random navigation errors.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    /// The root mean square of the radial position error \[m\].
    pub(super) rms: f64,
    /// The radius that holds half of the cases \[m\].
    pub(super) half: f64,
    /// The radius that holds 95 % of them \[m\].
    pub(super) most: f64,
    /// The root mean square of the horizontal velocity error \[m/s\].
    pub(super) velocity: f64,
    /// That of the tilt, both axes together, and of the heading \[rad\].
    pub(super) attitude: [f64; 2],
}

impl SchemeInService {
    /// The errors of a scheme, by linear propagation.
    pub(super) fn of(case: &Case<'_>, scheme: &RotationScheme) -> anyhow::Result<Self> {
        let table = case.table(scheme)?;
        let (growth, law) = case.growth(scheme, &table)?;
        let model = case.model;
        let errors: Option<Vec<f64>> = case.file.errors.as_ref().map(|errors| {
            let stated = Model::from(errors);
            model.ids().map(|id| stated.value(&id).unwrap_or_default()).collect()
        });
        let law = errors
            .as_ref()
            .zip(law)
            .map(|(errors, by)| by.iter().zip(errors).map(|(by, error)| by * error).sum());
        let by_errors = errors.map(|errors| growth.iter().map(|at| at.position(&errors)).collect());
        let start = case.start();
        let spread = |of: &Uncertainty| {
            growth.iter().map(|at| Spread::of(&at.covariance(&of.covariance, &start))).collect()
        };
        let last = growth.last();
        let budget = case.uncertainty.zip(last).map(|(of, last)| budget(model, of, last, &start));
        let wanted = match (case.want, case.uncertainty) {
            (Some(want), Some(of)) => {
                let place = want.place(&case.file.times).with_context(|| shown(&case.file.path))?;
                Some(Wanted::of(want, (model, of), &growth[place], &start))
            }
            _ => None,
        };
        Ok(Self {
            name: scheme.name.clone(),
            by_errors,
            law,
            by_uncertainty: case.uncertainty.map(spread),
            before: case.before.map(spread),
            budget: budget.unwrap_or_default(),
            simulated: None,
            wanted,
        })
    }

    /// Simulates the draws of the scheme.
    pub(super) fn simulate(
        &mut self,
        case: &Case<'_>,
        scheme: &RotationScheme,
        wish: &Wish<'_>,
    ) -> anyhow::Result<()> {
        let Some(of) = case.uncertainty else { return Ok(()) };
        let table = case.table(scheme)?;
        self.simulated = Some(Simulated::of(case, &table, of, wish)?);
        if let Some(wanted) = &mut self.wanted {
            let times =
                wanted.want.place(&case.file.times).map(|place| &case.file.times[..=place])?;
            let asked = of.with_sigmas(&wanted.sigmas);
            let simulated = Simulated::within((case, times), &table, &asked, wish)?;
            wanted.simulated = simulated.spreads.last().map(|spread| spread.rms);
        }
        Ok(())
    }
}

/// The radial position error by each source alone, 1σ \[m\], the largest first; correlations are not in it.
fn budget(model: &Model, of: &Uncertainty, last: &Growth, start: &OfStates) -> Vec<(String, f64)> {
    let none = DMatrix::zeros(of.covariance.nrows(), of.covariance.ncols());
    let mut alone = vec![0.0; of.covariance.nrows()];
    let sigmas = of.sigmas();
    let mut sources: Vec<(String, f64)> = Vec::new();
    for (place, id) in model.ids().enumerate() {
        alone[place] = sigmas[place];
        let [east, north] = last.position(&alone);
        sources.push((id, east.hypot(north)));
        alone[place] = 0.0;
    }
    let without_noise = Growth { by_noise: SMatrix::zeros(), ..last.clone() };
    sources
        .push(("initial attitude".into(), Growth::radial(&without_noise.covariance(&none, start))));
    let noise = if of.is_colored() { "noise" } else { "white noise" };
    sources.push((noise.into(), Growth::radial(&last.by_noise)));
    sources.sort_by(|a, b| b.1.total_cmp(&a.1));
    sources
}

impl Spread {
    fn of(covariance: &OfStates) -> Self {
        let position = Growth::of_position(covariance);
        let spread = position.symmetric_eigenvalues().map(|variance| variance.max(0.0).sqrt());
        let sigmas = [spread.max(), spread.min()];
        let rms = |states: &[usize]| {
            let sum: f64 = states.iter().map(|state| covariance[(*state, *state)]).sum();
            sum.max(0.0).sqrt()
        };
        Self {
            rms: Growth::radial(covariance),
            half: probable_radius(sigmas, 0.5),
            most: probable_radius(sigmas, 0.95),
            velocity: rms(&[3, 4]),
            attitude: [rms(&[0, 1]), rms(&[2])],
        }
    }
}
