//! What several runs of one IMU say together.

use nalgebra::DMatrix;
use rins_imu::ImuSpec;
use rins_terms::Model;

use crate::evidence::Indefinite;
use crate::identifiability::{Identifiability, Unknown, scaled};
use crate::layout::{Joined, Layout};
use crate::linear::linearise;
use crate::noise_parameters::{Noise, NoiseParameters};
use crate::posterior::Evidence;
use crate::run::Run;

/// The evidence of several runs on all their unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// The unknowns: those of the IMU first, then those of each run.
    pub unknowns: Vec<Unknown>,
    /// Of each unknown, the term of the model that it is of, and which of the term's parameters it is.
    pub parameters: Vec<(usize, usize)>,
    /// What the runs say.
    pub evidence: Evidence,
}

/// Why runs say nothing.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum JointError {
    /// The filter broke off.
    #[error("run {run}: {source}")]
    Indefinite {
        /// Which run, from one.
        run: usize,
        /// Where.
        source: Indefinite,
    },
}

impl Joint {
    /// The Fisher information in units of the priors' sigmas.
    pub fn information(&self) -> DMatrix<f64> {
        let sigmas: Vec<f64> = self.unknowns.iter().map(|unknown| unknown.sigma).collect();
        scaled(&self.evidence.information, &sigmas)
    }

    /// What they tell.
    pub fn identifiability(&self) -> Identifiability {
        Identifiability::of(&self.evidence.information, self.unknowns.clone())
    }
}

/// What `runs` of one IMU say of what `model` estimates, linear about the values that it has.
///
/// What belongs to the sensors is shared; what belongs to a run is each run's own. The model, and all ids, are along the
/// axes of the first run.
///
/// # Errors
/// [`JointError`] if the noise of a run makes no covariance.
pub fn joint(
    runs: &[Run],
    model: &Model,
    imu: &ImuSpec,
    strengths: &NoiseParameters,
) -> Result<Joint, JointError> {
    let Joined { models, free, layout } = Joined::of(model, imu, runs);
    let Layout { all, places, signs } = layout;
    let mut evidence = Evidence::none(all.len());
    for (number, run) in runs.iter().enumerate() {
        let linear = linearise(run, &models[number], &free[number]);
        let of_run = Evidence::of(&linear, &Noise::on(&run.rig, strengths))
            .map_err(|source| JointError::Indefinite { run: number + 1, source })?;
        evidence.add(&of_run, &places[number], &signs[number]);
    }
    let unknowns = all
        .iter()
        .map(|(free, run)| Unknown {
            id: free.id.clone(),
            model_id: models[0].id(free.term, free.parameter),
            run: *run,
            unit: free.unit,
            sigma: free.sigma,
        })
        .collect();
    let parameters = all.iter().map(|(free, _)| (free.term, free.parameter)).collect();
    Ok(Joint { unknowns, parameters, evidence })
}
