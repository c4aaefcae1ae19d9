//! What a run says of the parameters: one pass of the filter, and one linear recursion a column.
//!
//! The filter's innovations and their derivatives by every parameter, whitened, are all there is to know
//! of a linear model: sums of their products are the information, and equal what a filter with the
//! parameters as states would find from a diffuse start.

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

/// A filter whose covariance could not be factored.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the innovations' covariance is not positive definite at epoch {epoch}: a noise parameter is zero or \
     not plausible"
)]
pub struct Indefinite {
    /// Which epoch.
    pub epoch: usize,
}

impl Evidence {
    /// What a linear run says, its noise being this strong.
    ///
    /// # Errors
    /// [`Indefinite`] if the noise makes no covariance.
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

/// The whitened innovations of a linear run where the parameters are `delta` from where it is linear.
///
/// Each is N(0, I) if the model is right. Epochs that play no part have none.
///
/// # Errors
/// [`Indefinite`] if the noise makes no covariance.
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

/// How the axis frame is turned from where a model has it: by a base that tilts or sways, by an angle that is read wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turned {
    /// After how many samples.
    pub samples: usize,
    /// From the frame as it is to the frame as the model has it.
    pub by: Dcm<Table, Table>,
}

/// How the axis frame is turned after each epoch, as the filter knows it by then, the parameters being where the run is
/// linear.
///
/// Epochs that play no part have none.
///
/// # Errors
/// [`Indefinite`] if the noise makes no covariance.
pub fn attitudes(run: &Run, linear: &Linear, noise: &Noise) -> Result<Vec<Turned>, Indefinite> {
    // What is linear is what differs from the way that a base sways.
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

/// What is whitened of the first column, with the sign of an innovation.
fn innovation(whitened: &[f64]) -> SVector<f64, SHOWN> {
    let width = whitened.len() / SHOWN;
    SVector::from_fn(|part, _| -whitened[part * width])
}

/// Runs the filter; `each` is given every epoch with the filter after it, and half the logarithm of the determinant. Where it
/// gives nothing back, something has no covariance.
///
/// With a `combination` the columns are summed up, each times its number, into one.
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
            .and_then(|log_determinant| each(epoch, &filter, log_determinant))
            .ok_or(Indefinite { epoch: index })?;
    }
    Ok(())
}
