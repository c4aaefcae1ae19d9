//! The Monte Carlo of section 4: runs of the paper's filter with seeds, independent of the number of threads.

use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use rins_calibration::{Calibration, EstimatePoint, NavigationPoint, calibrate};
use rins_frames::units::{ARCSEC, PPM};
use rins_simulation::Simulated;

use crate::error::ReproductionError;
use crate::experiment::Experiment;
use crate::pure_navigation::Outcome;
use crate::statistics::Sample;

/// The units of `M_xz`, `M_yz` \[rad\] and `S_z` in the paper: arc seconds, arc seconds, ppm.
pub(crate) const UNITS: [f64; 3] = [ARCSEC, ARCSEC, PPM];

/// A finished run of the paper's filter.
#[derive(Clone, Debug)]
pub(crate) struct Calibrated {
    /// The estimates of `M_xz`, `M_yz` \[rad\] and `S_z`.
    pub(crate) estimate: Vector3<f64>,
    /// Their 1σ by the filter.
    pub(crate) sigma: Vector3<f64>,
    /// The NEES of the three: χ² with three degrees of freedom if the covariance is consistent.
    pub(crate) nees: f64,
    /// The history of the estimates.
    pub(crate) history: Vec<EstimatePoint>,
    /// The result of the navigation without compensation.
    pub(crate) before: Outcome,
    /// The same with the estimates compensated.
    pub(crate) after: Outcome,
    /// The history of the navigation without compensation.
    pub(crate) before_history: Vec<NavigationPoint>,
}

/// The runs of a Monte Carlo, in order of their index.
#[derive(Clone, Debug)]
pub(crate) struct Campaign {
    /// The true `M_xz`, `M_yz` \[rad\] and `S_z`.
    pub(crate) truth: Vector3<f64>,
    /// The runs.
    pub(crate) runs: Vec<Calibrated>,
}

impl Campaign {
    /// The runs of an experiment; `progress` is called after each run, from any thread.
    ///
    /// # Errors
    /// [`ReproductionError`] of the first failed run.
    pub(crate) fn of(
        experiment: &Experiment,
        n_runs: u64,
        progress: impl Fn() + Sync,
    ) -> Result<Self, ReproductionError> {
        let truth = experiment.scenario.imu_error.gyro.matrix.column(2).into_owned();
        let runs = (0..n_runs).into_par_iter().map(|run| {
            let done = calibrated(experiment, run, &truth)?;
            progress();
            Ok(done)
        });
        Ok(Self { truth, runs: runs.collect::<Result<_, ReproductionError>>()? })
    }

    /// The estimates of one of the three, in arc seconds, arc seconds and ppm.
    pub(crate) fn estimates(&self, parameter: usize) -> Sample {
        Sample::of(self.runs.iter().map(|run| run.estimate[parameter] / UNITS[parameter]))
    }

    /// The 1σ of one of the three by the filter, in the same units.
    pub(crate) fn claimed(&self, parameter: usize) -> f64 {
        Sample::of(self.runs.iter().map(|run| run.sigma[parameter] / UNITS[parameter])).mean
    }

    /// The ratio of the root mean square error of one of the three over the runs to its 1σ.
    pub(crate) fn overconfidence(&self, parameter: usize) -> f64 {
        let squares = self.runs.iter().map(|run| {
            let off = (run.estimate[parameter] - self.truth[parameter]) / run.sigma[parameter];
            off * off
        });
        Sample::of(squares).mean.sqrt()
    }

    /// The mean NEES of the three.
    pub(crate) fn nees(&self) -> f64 {
        Sample::of(self.runs.iter().map(|run| run.nees)).mean
    }

    /// One of the five figures of the navigations before or after, in m/s and degrees.
    pub(crate) fn navigated(
        &self,
        outcome: impl Fn(&Calibrated) -> Outcome,
        figure: usize,
    ) -> Sample {
        Sample::of(self.runs.iter().map(|run| outcome(run).figures()[figure]))
    }
}

fn calibrated(
    experiment: &Experiment,
    run: u64,
    truth: &Vector3<f64>,
) -> Result<Calibrated, ReproductionError> {
    let Simulated { recording, .. } = experiment.run(run)?;
    let calibration = calibrate(&recording, &experiment.setup, |_| ())
        .map_err(|source| ReproductionError::Calibration { run, source })?;
    let (estimate, sigma) = figures(&calibration);
    let covariance = Matrix3::from_fn(|row, column| {
        calibration.correlation[(row, column)] * sigma[row] * sigma[column]
    });
    let error = estimate - truth;
    let inverse = covariance.try_inverse().ok_or(ReproductionError::Singular { run })?;
    Ok(Calibrated {
        estimate,
        sigma,
        nees: error.dot(&(inverse * error)),
        history: calibration.history,
        before: Outcome::from(&calibration.before),
        after: Outcome::from(&calibration.after),
        before_history: calibration.before.history,
    })
}

/// The three estimates of a calibration and their 1σ.
pub(crate) fn figures(calibration: &Calibration) -> (Vector3<f64>, Vector3<f64>) {
    let parameters = &calibration.parameters;
    (
        Vector3::from_fn(|row, _| parameters[row].value),
        Vector3::from_fn(|row, _| parameters[row].sigma),
    )
}
