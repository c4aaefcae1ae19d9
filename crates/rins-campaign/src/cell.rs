//! A scenario of a campaign: the common data of its runs, and the result of each.

use std::ops::Range;

use nalgebra::Vector3;
use rins_calibration::{CalibrationError, Estimate, Setup, Start, beginning, estimate};
use rins_imu::{ImuNoise, Seed, Span};
use rins_motion::Recording;
use rins_simulation::{Scenario, ScenarioError, TableRecord, simulate};

/// The ids of the estimated parameters.
pub const PARAMETERS: [&str; 3] = ["gyro.misalignment.xz", "gyro.misalignment.yz", "gyro.scale.z"];

/// A scenario with the setup of the filter.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// The scenario; for run `k` the run index of its seed is replaced by `k`.
    pub scenario: Scenario,
    /// The setup of the filter.
    pub setup: Setup,
}

/// The reason why a cell cannot be run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CellError {
    /// It cannot be simulated.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// Its run without noise cannot be calibrated.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
}

/// The reason why a run has no estimates.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct RunFailure {
    /// The error's message, and those of its sources.
    pub reason: String,
}

/// The result of a run.
pub type RunResult = Result<Estimate, RunFailure>;

/// A prepared cell, with the common data of its runs.
#[derive(Clone, Debug)]
pub struct Prepared {
    pub(crate) scenario: Scenario,
    pub(crate) setup: Setup,
    /// The run without noise.
    pub(crate) noiseless: Recording,
    /// The common initial state and noise of the runs, if these can be computed in SIMD lanes.
    pub(crate) side_by_side: Option<(Start, ImuNoise, Span)>,
}

impl Cell {
    /// The true `M_xz`, `M_yz` \[rad\] and `S_z`.
    pub fn truth(&self) -> Vector3<f64> {
        self.scenario.imu_error.gyro.matrix.column(2).into_owned()
    }

    /// Prepares the cell: simulates its run without noise, and determines the initial state of the filter.
    ///
    /// # Errors
    /// [`CellError`] if a run without noise cannot be simulated or calibrated.
    pub fn prepare(&self) -> Result<Prepared, CellError> {
        let Self { scenario, setup } = self;
        let noiseless = simulate(&Scenario { noise: None, ..scenario.clone() })?.recording;
        let (start, samples) = beginning(&noiseless, setup)?;
        // Encoder noise, effects, and a static interval for alignment differ from run to run.
        let alike = scenario.table == TableRecord::CommandedRate
            && scenario.effects.terms.is_empty()
            && setup.axis.is_some()
            && samples == (0..noiseless.len());
        let duration = scenario.profile.duration().max(scenario.interval);
        let span = Span { interval: scenario.interval, duration };
        let noise = scenario.noise.clone().unwrap_or_default();
        // Invalid noise is detected here, before any run.
        noise.source(&span, scenario.seed).map_err(ScenarioError::from)?;
        Ok(Prepared {
            scenario: scenario.clone(),
            setup: *setup,
            noiseless,
            side_by_side: alike.then_some((start, noise, span)),
        })
    }
}

impl Prepared {
    /// The results of the runs, in their order; computed in SIMD lanes if that is possible.
    pub fn run(&self, runs: Range<u64>) -> Vec<RunResult> {
        match &self.side_by_side {
            Some(shared) => {
                let found = self.run_side_by_side(shared, runs.clone());
                let alone = |(run, found): (u64, Option<Estimate>)| {
                    found.map_or_else(|| self.run_alone(run), Ok)
                };
                runs.zip(found).map(alone).collect()
            }
            None => runs.map(|run| self.run_alone(run)).collect(),
        }
    }

    /// The result of one run, simulated and calibrated like any other recording.
    ///
    /// # Errors
    /// [`RunFailure`] if it has no estimates.
    pub fn run_alone(&self, run: u64) -> RunResult {
        let seed = Seed { run, ..self.scenario.seed };
        let simulated = simulate(&Scenario { seed, ..self.scenario.clone() }).map_err(reason)?;
        estimate(&simulated.recording, &self.setup).map_err(reason)
    }
}

/// An error's message and those of its sources.
fn reason<E: std::error::Error>(error: E) -> RunFailure {
    let mut reason = error.to_string();
    let mut behind = error.source();
    while let Some(cause) = behind {
        reason = format!("{reason}: {cause}");
        behind = cause.source();
    }
    RunFailure { reason }
}
