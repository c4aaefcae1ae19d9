//! The joint evidence of several runs of one IMU.

use nalgebra::DMatrix;
use rins_frames::SignedAxes;
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
    /// For each unknown, its term in the model and its place within the term.
    pub parameters: Vec<(usize, usize)>,
    /// The evidence of all runs.
    pub evidence: Evidence,
}

/// The reason why the evidence of a run cannot be calculated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum JointError {
    /// The filter failed.
    #[error("run {run}: {source}")]
    Indefinite {
        /// The number of the run, from one.
        run: usize,
        /// The epoch.
        source: Indefinite,
    },
}

impl Joint {
    /// The Fisher information in units of the priors' sigmas.
    pub fn information(&self) -> DMatrix<f64> {
        let sigmas: Vec<f64> = self.unknowns.iter().map(|unknown| unknown.sigma).collect();
        scaled(&self.evidence.information, &sigmas)
    }

    /// The observability of the unknowns.
    pub fn identifiability(&self) -> Identifiability {
        Identifiability::of(&self.evidence.information, self.unknowns.clone())
    }
}

/// The joint evidence of `runs` of one IMU on the free parameters of `model`, linearized at the values of the model.
///
/// Parameters of the sensors are shared; parameters of a run belong to that run. The model, and all ids, are along the
/// sensors' own axes.
///
/// # Errors
/// [`JointError`] if an innovation covariance of a run is not positive definite.
pub fn joint(
    runs: &[Run],
    model: &Model,
    imu: &ImuSpec,
    strengths: &NoiseParameters,
) -> Result<Joint, JointError> {
    let Joined { models, free, layout } = Joined::of(model, &SignedAxes::IDENTITY, imu, runs);
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
