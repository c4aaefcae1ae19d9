//! Changes between two calibrations of one IMU.

mod outcome;
mod page;
mod result;

use std::path::Path;

use nalgebra::{DMatrix, DVector};
use rins_io::{Calibration, Covariance, InputFile, parameters, shown};
use rins_terms::Role;
use statrs::distribution::{ChiSquared, ContinuousCDF};

pub use self::result::{ChangeResult, CompareResult, TogetherResult};
use crate::basis::BasisResult;
use crate::error::Result;
use crate::references::IndependentCovariances;

/// The change of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Moved {
    pub(crate) id: String,
    pub(crate) unit: &'static str,
    /// Both values, in the unit of the parameter.
    pub(crate) values: [f64; 2],
    /// Their 1σ.
    pub(crate) sigmas: [f64; 2],
    /// The 1σ of the change, in the unit of the parameter.
    pub(crate) sigma: f64,
}

impl Moved {
    /// The change, in the unit of the parameter.
    pub(crate) fn difference(&self) -> f64 {
        self.values[1] - self.values[0]
    }

    /// The change in sigmas.
    pub(crate) fn sigmas_moved(&self) -> f64 {
        self.difference() / self.sigma
    }
}

/// The joint test of all changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Together {
    pub(crate) chi_square: f64,
    pub(crate) dof: usize,
    /// The p-value of the test.
    pub(crate) p: f64,
}

/// Two calibrations of one IMU, compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The names of the two calibrations.
    pub(crate) names: [String; 2],
    /// The parameters that both have estimated.
    pub(crate) moved: Vec<Moved>,
    pub(crate) together: Option<Together>,
    /// The parameters that only one has estimated.
    pub(crate) only: [Vec<String>; 2],
    pub(crate) basis: BasisResult,
}

/// Compares two calibration files of one IMU.
///
/// # Errors
/// If a file cannot be read, or the two have no parameter in common that was estimated in both.
///
/// ```
/// use rins::{CalibrateOptions, Outcome, Overwrite};
/// let folder = tempfile::tempdir()?;
/// let log = rins::demo::log(folder.path())?;
/// let out = folder.path().join("out");
/// rins::calibrate(vec![log], &CalibrateOptions::default())?.write(&out, Overwrite::Refuse)?;
/// let file = out.join("calibration.toml");
/// let comparison = rins::compare(&file, &file)?;
/// assert!(comparison.result().parameters.iter().all(|parameter| parameter.difference == 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare(before: &Path, after: &Path) -> Result<Comparison> {
    let names = [shown(before), shown(after)];
    let files = [InputFile::of(before)?, InputFile::of(after)?];
    let calibrations = [Calibration::read(before)?, Calibration::read(after)?];
    let bases: Vec<BasisResult> = files
        .into_iter()
        .zip(&calibrations)
        .map(|(file, calibration)| BasisResult::of_calibration(file, &calibration.measured))
        .collect();
    let basis = BasisResult::together(&bases);
    let comparison = Comparison::of(calibrations.each_ref(), names, basis);
    if comparison.moved.is_empty() {
        let why = format!(
            "{} and {} have no parameter in common that was estimated in both",
            comparison.names[0], comparison.names[1]
        );
        return Err(anyhow::Error::msg(why).into());
    }
    Ok(comparison)
}

/// An estimated parameter, in its unit.
struct Estimated {
    id: String,
    unit: &'static str,
    value: f64,
    sigma: f64,
}

fn estimated(calibration: &Calibration) -> Vec<Estimated> {
    let sigma_of = |id: &str| calibration.sigmas.iter().find(|sigma| sigma.id == id);
    let triads = parameters(&calibration.error).into_iter().filter_map(|parameter| {
        let sigma = sigma_of(&parameter.id)?.value;
        Some(Estimated { id: parameter.id, unit: parameter.unit, value: parameter.value, sigma })
    });
    let own = calibration.own_terms();
    let others = own.into_iter().filter_map(|(id, (place, which))| {
        let chosen = &calibration.terms.terms[place];
        let Role::Within(sigma) = chosen.roles[which] else { return None };
        let unit = chosen.term.parameters[which].unit;
        let (_, sign) = chosen.own(which, &calibration.spin.into());
        Some(Estimated {
            id,
            unit: unit.symbol,
            value: sign * chosen.values[which] / unit.factor,
            sigma: sigma / unit.factor,
        })
    });
    triads.chain(others).collect()
}

impl Comparison {
    fn of(of: [&Calibration; 2], names: [String; 2], basis: BasisResult) -> Self {
        let lists = of.map(estimated);
        let mut moved: Vec<Moved> = lists[0]
            .iter()
            .filter_map(|a| {
                let b = lists[1].iter().find(|b| b.id == a.id)?;
                Some(Moved {
                    id: a.id.clone(),
                    unit: a.unit,
                    values: [a.value, b.value],
                    sigmas: [a.sigma, b.sigma],
                    sigma: 0.0,
                })
            })
            .collect();
        let independent = IndependentCovariances::of(&of);
        let [before, after] =
            [0, 1].map(|which| covariance(&moved, independent.each[which].as_ref(), which));
        let covariance = before + after;
        for (place, one) in moved.iter_mut().enumerate() {
            one.sigma = covariance[(place, place)].sqrt();
        }
        let only = |list: &[Estimated]| -> Vec<String> {
            let alone = list.iter().filter(|a| !moved.iter().any(|both| both.id == a.id));
            alone.map(|a| a.id.clone()).collect()
        };
        let only = [only(&lists[0]), only(&lists[1])];
        let together = together(&moved, &covariance);
        let basis = basis.assuming(independent.assumption);
        Self { names, moved, together, only, basis }
    }
}

/// The χ² of all changes with their covariance.
fn together(moved: &[Moved], covariance: &DMatrix<f64>) -> Option<Together> {
    let n = moved.len();
    // Each parameter is scaled by its sigma, so that different units do not degrade the condition of the matrix.
    let correlation = DMatrix::from_fn(n, n, |row, column| {
        covariance[(row, column)] / (moved[row].sigma * moved[column].sigma)
    });
    let off = DVector::from_fn(n, |row, _| moved[row].sigmas_moved());
    let chi_square = off.dot(&correlation.cholesky()?.solve(&off));
    let p = ChiSquared::new(n as f64).ok()?.sf(chi_square);
    Some(Together { chi_square, dof: n, p })
}

/// The covariance of the common parameters by one calibration; diagonal, from the sigmas, if it has no covariance.
fn covariance(moved: &[Moved], known: Option<&Covariance>, which: usize) -> DMatrix<f64> {
    let place = |id: &str| known.and_then(|known| known.ids.iter().position(|other| other == id));
    DMatrix::from_fn(moved.len(), moved.len(), |row, column| {
        match (known, place(&moved[row].id), place(&moved[column].id)) {
            (Some(known), Some(a), Some(b)) => known.matrix[(a, b)],
            _ if row == column => moved[row].sigmas[which].powi(2),
            _ => 0.0,
        }
    })
}
