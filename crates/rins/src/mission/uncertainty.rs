//! How uncertain the sensor errors of a system are.

use nalgebra::{DMatrix, DVector};
use rins_imu::{ImuSpec, NoiseModel, NormalStream};
use rins_io::Calibration;
use rins_terms::Model;

/// How uncertain the sensor errors are, in SI units.
#[derive(Clone, Debug)]
pub(super) struct Uncertainty {
    /// The covariance of the parameters.
    pub(super) covariance: DMatrix<f64>,
    /// The noise of gyros and accelerometers.
    pub(super) noise: [NoiseModel; 2],
    /// The parameters of which nothing states an uncertainty.
    pub(super) without: Vec<String>,
}

impl Uncertainty {
    /// That of a data sheet, or of what is left after a calibration; `None` if there is neither.
    pub(super) fn of(
        model: &Model,
        imu: Option<&ImuSpec>,
        calibration: Option<&Calibration>,
    ) -> Option<Self> {
        if imu.is_none() && calibration.is_none() {
            return None;
        }
        let ids: Vec<String> = model.ids().collect();
        let places: Vec<(usize, usize)> = model.places().collect();
        let factor = |place: usize| {
            let (term, parameter) = places[place];
            model.terms[term].term.parameters[parameter].unit.factor
        };
        let mut covariance = DMatrix::zeros(ids.len(), ids.len());
        let mut without = Vec::new();
        for (place, (id, &(term, parameter))) in ids.iter().zip(&places).enumerate() {
            let calibrated = calibration
                .and_then(|file| file.sigmas.iter().find(|sigma| sigma.id == *id))
                .map(|sigma| sigma.value * factor(place));
            let stated = imu.map(|imu| model.terms[term].term.parameters[parameter].sigma(imu));
            match calibrated.or(stated) {
                Some(sigma) => covariance[(place, place)] = sigma * sigma,
                None => without.push(id.clone()),
            }
        }
        if let Some(known) = calibration.and_then(|file| file.covariance.as_ref()) {
            let at = |id: &String| known.ids.iter().position(|other| other == id);
            for (row, own) in ids.iter().enumerate() {
                for (column, other) in ids.iter().enumerate() {
                    if let Some((a, b)) = at(own).zip(at(other)) {
                        covariance[(row, column)] =
                            known.matrix[(a, b)] * factor(row) * factor(column);
                    }
                }
            }
        }
        let noise = imu.map_or_else(Default::default, |imu| {
            [NoiseModel::from(&imu.gyro), NoiseModel::from(&imu.accel)]
        });
        Some(Self { covariance, noise, without })
    }

    /// Whether the noise has more than a white part.
    pub(super) fn is_colored(&self) -> bool {
        self.noise.iter().any(|model| {
            model.bias_random_walk > 0.0 || model.flicker.is_some_and(|flicker| flicker > 0.0)
        })
    }

    /// The standard deviations.
    pub(super) fn sigmas(&self) -> Vec<f64> {
        self.covariance.diagonal().iter().map(|variance| variance.max(0.0).sqrt()).collect()
    }

    /// The same noise with independent errors of these standard deviations.
    pub(super) fn with_sigmas(&self, sigmas: &[f64]) -> Self {
        let variances = DVector::from_iterator(sigmas.len(), sigmas.iter().map(|one| one * one));
        Self { covariance: DMatrix::from_diagonal(&variances), ..self.clone() }
    }

    /// A matrix `L` with `L Lᵀ` the covariance, which may be singular.
    pub(super) fn root(&self) -> DMatrix<f64> {
        let sigmas = DVector::from_vec(self.sigmas());
        let inverse = sigmas.map(|sigma| if sigma > 0.0 { 1.0 / sigma } else { 0.0 });
        let correlation = self.covariance.component_mul(&(&inverse * inverse.transpose()));
        let eigen = correlation.symmetric_eigen();
        let spread = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
        let mut root = eigen.eigenvectors * DMatrix::from_diagonal(&spread);
        for (mut row, sigma) in root.row_iter_mut().zip(&sigmas) {
            row *= *sigma;
        }
        root
    }
}

/// Errors that have the covariance `root rootᵀ`.
pub(super) fn drawn(root: &DMatrix<f64>, stream: &mut NormalStream) -> Vec<f64> {
    let normal = DVector::from_fn(root.ncols(), |_, _| stream.sample());
    (root * normal).iter().copied().collect()
}

#[cfg(test)]
mod tests {
    use rins_imu::Seed;

    use super::*;

    /// A singular covariance has a root, and draws have it.
    #[test]
    fn draws_have_the_covariance() {
        let covariance =
            DMatrix::from_row_slice(3, 3, &[4e-6, 2e-9, 0.0, 2e-9, 1e-12, 0.0, 0.0, 0.0, 0.0]);
        let uncertainty = Uncertainty {
            covariance: covariance.clone(),
            noise: Default::default(),
            without: Vec::new(),
        };
        let root = uncertainty.root();
        assert!((&root * root.transpose() - &covariance).amax() < 1e-15);
        let mut stream = Seed::new(3).stream(rins_imu::Sensor::Unit);
        let count = 4000;
        let mut sum = DMatrix::zeros(3, 3);
        for _ in 0..count {
            let one = DVector::from_vec(drawn(&root, &mut stream));
            sum += &one * one.transpose() / f64::from(count);
        }
        assert!((sum[(0, 0)] / 4e-6 - 1.0).abs() < 0.1, "{sum}");
        assert!((sum[(0, 1)] / 2e-9 - 1.0).abs() < 0.1, "{sum}");
    }
}
