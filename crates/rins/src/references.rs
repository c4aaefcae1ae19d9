//! The errors of references in several calibrations: of one laboratory they are the same, and no difference has them.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use rins_io::{Calibration, Covariance};

/// Calibrations with the parts of their covariances that are independent of each other.
#[derive(Clone, Debug)]
pub(crate) struct IndependentCovariances {
    /// In the order of the calibrations; `None` of one without covariance.
    pub(crate) each: Vec<Option<Covariance>>,
    /// What was assumed of the references, if the accuracy of one is stated.
    pub(crate) assumption: Option<String>,
}

impl IndependentCovariances {
    /// Of calibrations of one laboratory: noise, and the differences between what the references add to each, since the error of a
    /// reference is the same in all of them. Of several laboratories: the whole covariances.
    pub(crate) fn of(calibrations: &[&Calibration]) -> Self {
        let covariances = || calibrations.iter().filter_map(|one| one.covariance.as_ref());
        let whole = || calibrations.iter().map(|one| one.covariance.clone()).collect();
        let mut names: Vec<&str> = covariances()
            .flat_map(|one| one.references.iter())
            // The components of one reference have its key and a word in brackets.
            .filter_map(|(name, _)| name.split(' ').next())
            .collect();
        names.sort_unstable();
        names.dedup();
        if names.is_empty() {
            return Self { each: whole(), assumption: None };
        }
        let list = names.join(", ");
        let mut laboratories = calibrations.iter().map(|one| &one.measured.laboratory.name);
        let first = laboratories.next();
        if laboratories.any(|one| Some(one) != first) {
            let assumption = format!(
                "Calibrations of several laboratories: the errors of their references ({list}) count as independent, also of two from one \
                 laboratory."
            );
            return Self { each: whole(), assumption: Some(assumption) };
        }
        let shared = Shared::of(covariances());
        let each = calibrations.iter().map(|one| Some(shared.without(one.covariance.as_ref()?)));
        let assumption = format!(
            "The references ({list}) are the same in all calibrations, and so are their errors: differences and forecasts do not contain \
             them, the values do."
        );
        Self { each: each.collect(), assumption: Some(assumption) }
    }
}

/// What the references add to all calibrations alike.
struct Shared<'a> {
    /// By reference and parameter: the sum of the shifts, and their number.
    sums: BTreeMap<(&'a str, &'a str), (f64, f64)>,
}

impl<'a> Shared<'a> {
    fn of(covariances: impl Iterator<Item = &'a Covariance>) -> Self {
        let mut sums = BTreeMap::new();
        for one in covariances {
            for (name, shifts) in &one.references {
                for (id, shift) in one.ids.iter().zip(shifts.iter()) {
                    let (sum, count) =
                        sums.entry((name.as_str(), id.as_str())).or_insert((0.0, 0.0));
                    *sum += shift;
                    *count += 1.0;
                }
            }
        }
        Self { sums }
    }

    /// The covariance of noise and of what the references add beyond the mean of all calibrations.
    ///
    /// Deviations d from a mean of n shifts count as independent, with the variance d² n / (n - 1): the difference of two calibrations
    /// has exactly the variance of the difference of their shifts.
    fn without(&self, covariance: &Covariance) -> Covariance {
        let mut matrix: DMatrix<f64> = covariance.matrix.clone();
        for (name, shifts) in &covariance.references {
            matrix -= shifts * shifts.transpose();
            let beyond = |place: usize| {
                let mean = self.sums.get(&(name.as_str(), covariance.ids[place].as_str()));
                mean.filter(|(_, count)| *count > 1.0).map_or(0.0, |(sum, count)| {
                    (shifts[place] - sum / count) * (count / (count - 1.0)).sqrt()
                })
            };
            let beyond = DVector::from_fn(shifts.len(), |place, _| beyond(place));
            matrix += &beyond * beyond.transpose();
        }
        Covariance { ids: covariance.ids.clone(), matrix, references: Vec::new() }
    }
}
