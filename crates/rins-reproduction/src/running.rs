//! Runs of section 4 processed sample by sample: convergence of the estimates, and navigation with online
//! compensation.

use nalgebra::Vector3;
use rayon::prelude::*;
use rins_calibration::{RunningEstimate, navigate_freely, navigate_online, running_estimate};
use rins_imu::ImuError;
use rins_simulation::Simulated;

use crate::convergence::{WITHIN, convergence_times};
use crate::error::ReproductionError;
use crate::experiment::{Experiment, spin_axis_error};
use crate::pure_navigation::Outcome;

/// The times at which the estimates are stored \[s\].
pub(crate) const TIMES: [f64; 6] = [0.1, 1.0, 10.0, 36.0, 100.0, 360.0];

/// One run, processed sample by sample.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Followed {
    /// The time from which on each estimate stays within [`WITHIN`] final sigmas of its final value \[s\].
    pub(crate) converged: Vector3<f64>,
    /// The estimate and its 1σ at each of [`TIMES`].
    pub(crate) kept: Vec<[Vector3<f64>; 2]>,
    /// The result of navigation without compensation.
    pub(crate) none: Outcome,
    /// The same with each sample compensated by the estimate before it.
    pub(crate) online: Outcome,
    /// The same with all samples compensated by the final estimate.
    pub(crate) batch: Outcome,
}

/// The results of `n_runs` runs of an experiment with a known initial attitude; `progress` is called after each.
///
/// # Errors
/// [`ReproductionError`] of the first failed run.
pub(crate) fn followed(
    experiment: &Experiment,
    n_runs: u64,
    progress: impl Fn() + Sync,
) -> Result<Vec<Followed>, ReproductionError> {
    let runs = (0..n_runs).into_par_iter().map(|run| {
        let done = follow(experiment, run)?;
        progress();
        Ok(done)
    });
    runs.collect()
}

fn follow(experiment: &Experiment, run: u64) -> Result<Followed, ReproductionError> {
    let Experiment { scenario, setup } = experiment;
    let Simulated { recording, truth } = experiment.run(run)?;
    let running = running_estimate(&recording, setup)
        .map_err(|source| ReproductionError::Calibration { run, source })?;
    let RunningEstimate { points, span } = &running;
    let interval = scenario.interval;
    let start = recording.times[span.start] - interval;
    let angles: Vec<f64> = std::iter::once(0.0).chain(truth.table_angle).collect();
    let (axis, station) = (scenario.nav_from_table, &scenario.station);
    let navigate = |compensation| {
        Outcome::from(&navigate_freely(&recording, &angles, axis, station, compensation))
    };
    let last = running.before(recording.len());
    let batch = ImuError { gyro: spin_axis_error(&last), ..ImuError::default() }.compensation()?;
    let each = running.compensations(0..recording.len())?;
    let online = navigate_online(&recording, &angles, axis, station, &each);
    // The estimate for a time is the first at or after it.
    let kept = TIMES.map(|time| {
        let after = points.partition_point(|point| point.time - start < time - 0.5 * interval);
        let point = &points[after.min(points.len() - 1)];
        [point.estimate, point.sigma]
    });
    Ok(Followed {
        converged: convergence_times(points, start, WITHIN),
        kept: kept.into(),
        none: navigate(None),
        online: Outcome::from(&online),
        batch: navigate(Some(&batch)),
    })
}
