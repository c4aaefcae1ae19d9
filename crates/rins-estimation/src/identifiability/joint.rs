//! What several runs of one IMU say together.

use nalgebra::DMatrix;
use rins_imu::ImuSpec;
use rins_terms::Model;

use crate::evidence::Indefinite;
use crate::identifiability::{Identifiability, Unknown, scaled};
use crate::layout::Layout;
use crate::linear::linearise;
use crate::posterior::Evidence;
use crate::run::Run;
use crate::strengths::{Noise, Strengths};

/// The evidence of several runs on all their unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// The unknowns: those of the IMU first, then those of each run.
    pub unknowns: Vec<Unknown>,
    /// Of each unknown, which parameter of the model it is.
    pub parameters: Vec<usize>,
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
/// What belongs to the sensors is shared; what belongs to a run is each run's own.
///
/// # Errors
/// [`JointError`] if the noise of a run makes no covariance.
pub fn joint(
    runs: &[Run],
    model: &Model,
    imu: &ImuSpec,
    strengths: &Strengths,
) -> Result<Joint, JointError> {
    let free = model.free(imu);
    let Layout { all, places } = Layout::of(&free, runs);
    let columns: Vec<(usize, usize)> =
        free.iter().map(|parameter| (parameter.term, parameter.parameter)).collect();
    let mut evidence = Evidence::none(all.len());
    for (number, (run, places)) in runs.iter().zip(&places).enumerate() {
        let linear = linearise(run, model, &columns);
        let of_run = Evidence::of(&linear, &Noise::on(&run.rig, strengths))
            .map_err(|source| JointError::Indefinite { run: number + 1, source })?;
        evidence.add(&of_run, places);
    }
    let unknowns = all
        .iter()
        .map(|&(index, run)| Unknown {
            id: free[index].id.clone(),
            run,
            unit: free[index].unit,
            sigma: free[index].sigma,
        })
        .collect();
    Ok(Joint { unknowns, parameters: all.iter().map(|&(index, _)| index).collect(), evidence })
}
