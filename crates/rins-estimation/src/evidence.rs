//! The information of a run on the parameters: one pass of the filter, with one linear recursion for each column.
//!
//! The whitened innovations of the filter and their derivatives by every parameter are sufficient statistics of a linear model:
//! the sums of their products are the information matrix and the score. They equal those of a filter with the parameters as
//! augmented states and a diffuse prior.

use nalgebra::SVector;
use rins_frames::{Dcm, Table};

use crate::epoch::Epoch;
use crate::gains::Gains;
use crate::gram::Gram;
use crate::linear::Linear;
use crate::noise_parameters::Noise;
use crate::pass::Pass;
use crate::posterior::Evidence;
use crate::run::Run;
use crate::space::Space;
use crate::step::SHOWN;
use crate::sway::Sway;

/// The error that the covariance of an innovation could not be factored.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the innovations' covariance is not positive definite at epoch {epoch}: a noise parameter is zero or \
     not plausible"
)]
pub struct Indefinite {
    /// The index of the epoch.
    pub epoch: usize,
}

impl Evidence {
    /// The evidence of a linearized run with this noise.
    ///
    /// # Errors
    /// [`Indefinite`] if the covariance of an innovation is not positive definite.
    pub fn of(linear: &Linear, noise: &Noise) -> Result<Self, Indefinite> {
        let mut gram = Gram::new(linear.parameters + 1);
        let mut log_determinant = 0.0;
        pass(linear, noise, None, |_, filter, log_det| {
            gram.add(filter.whitened(), SHOWN);
            log_determinant += log_det;
            Some(())
        })?;
        let epochs = linear.epochs.iter().filter(|epoch| !epoch.left_out).count();
        Ok(Self::from_products(&gram.finish(), epochs * linear.shown(), log_determinant))
    }
}

/// The whitened innovations of a linearized run for parameters that differ by `delta` from the point of linearization.
///
/// Each is N(0, I) if the model is correct. Excluded epochs have none.
///
/// # Errors
/// [`Indefinite`] if the covariance of an innovation is not positive definite.
pub fn innovations(
    linear: &Linear,
    noise: &Noise,
    delta: &[f64],
) -> Result<Vec<SVector<f64, SHOWN>>, Indefinite> {
    let mut all = Vec::with_capacity(linear.epochs.len());
    let mut combination = vec![1.0];
    combination.extend_from_slice(delta);
    pass(linear, noise, Some(&combination), |_, filter, _| {
        all.push(innovation(filter.whitened()));
        Some(())
    })?;
    Ok(all)
}

/// The rotation of the axis frame relative to the model, due to base motion or an error of the table angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turned {
    /// The number of samples up to this epoch's end.
    pub samples: usize,
    /// The rotation from the actual frame to the frame of the model.
    pub by: Dcm<Table, Table>,
}

/// The rotation of the axis frame after each epoch as estimated by the filter up to it, with the parameters at the point of
/// linearization.
///
/// Excluded epochs have none.
///
/// # Errors
/// [`Indefinite`] if the covariance of an innovation is not positive definite.
pub fn attitudes(run: &Run, linear: &Linear, noise: &Noise) -> Result<Vec<Turned>, Indefinite> {
    // The linear states are deviations from the sway trajectory of the base.
    let sway = Sway::of(run);
    let mut all = Vec::with_capacity(linear.epochs.len());
    pass(linear, noise, Some(&[1.0]), |epoch, filter, _| {
        let samples = epoch.samples.1;
        let off = Dcm::<Table, Table>::from_rotation_vector(&filter.attitude());
        let swayed = sway.as_ref().map(|sway| sway.attitudes[samples - 1][1].scaled_axis());
        let by = off * Dcm::from_rotation_vector(&swayed.unwrap_or_default());
        all.push(Turned { samples, by });
        Some(())
    })?;
    Ok(all)
}

/// The first whitened column, with the sign of an innovation.
fn innovation(whitened: &[f64]) -> SVector<f64, SHOWN> {
    let width = whitened.len() / SHOWN;
    SVector::from_fn(|part, _| -whitened[part * width])
}

/// Runs the filter; `each` receives every epoch, the filter after it, and half the log-determinant of the covariance of its readings
/// given the earlier ones. A `None` from it means that a covariance is not positive definite.
///
/// With a `combination` the columns are replaced by their sum with these weights.
pub(crate) fn pass(
    linear: &Linear,
    noise: &Noise,
    combination: Option<&[f64]>,
    mut each: impl FnMut(&Epoch, &Pass, f64) -> Option<()>,
) -> Result<(), Indefinite> {
    let space = Space::new(linear, noise);
    let columns = if combination.is_none() { linear.parameters + 1 } else { 1 };
    let mut filter = Pass::new(&space, columns);
    for (index, epoch) in linear.epochs.iter().enumerate() {
        if epoch.left_out {
            filter.pass_over(&space, epoch);
            continue;
        }
        let combined: Gains;
        let gains = match combination {
            None => &epoch.gains,
            Some(weights) => {
                combined = epoch.gains.combined(weights);
                &combined
            }
        };
        let anew = linear.starts_anew(index);
        filter
            .step(&space, epoch, gains, anew)
            .and_then(|log_determinant| each(epoch, &filter, log_determinant + linear.ln_volume))
            .ok_or(Indefinite { epoch: index })?;
    }
    Ok(())
}
