//! A scenario that is run over and over: what its runs share, and what each finds.

use std::ops::Range;

use nalgebra::Vector3;
use rins_calibration::{CalibrationError, Estimate, Setup, Start, beginning, estimate};
use rins_imu::{ImuNoise, Seed, Span};
use rins_motion::Recording;
use rins_simulation::{Scenario, ScenarioError, TableRecord, simulate};

/// The ids of what each run estimates.
pub const PARAMETERS: [&str; 3] = ["gyro.misalignment.xz", "gyro.misalignment.yz", "gyro.scale.z"];

/// A scenario, and what the filter is told of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// What is simulated; run `k` has the seed's run replaced by `k`.
    pub scenario: Scenario,
    /// What the filter is told.
    pub setup: Setup,
}

/// Why a cell cannot be run at all.
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

/// Why a run has no estimates.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct RunFailure {
    /// The error's message, and those of what is behind it.
    pub reason: String,
}

/// What a run found.
pub type RunResult = Result<Estimate, RunFailure>;

/// A cell made ready: what all of its runs have in common.
#[derive(Clone, Debug)]
pub struct Prepared {
    pub(crate) scenario: Scenario,
    pub(crate) setup: Setup,
    /// The run without noise.
    pub(crate) noiseless: Recording,
    /// Where runs can lie side by side: how they start, and their noise.
    pub(crate) side_by_side: Option<(Start, ImuNoise, Span)>,
}

impl Cell {
    /// The true `M_xz`, `M_yz` \[rad\] and `S_z`.
    pub fn truth(&self) -> Vector3<f64> {
        self.scenario.imu_error.gyro.matrix.column(2).into_owned()
    }

    /// Makes the cell ready: simulates its run without noise, and finds how the filter starts.
    ///
    /// # Errors
    /// [`CellError`] if a run without noise cannot be simulated or calibrated.
    pub fn prepare(&self) -> Result<Prepared, CellError> {
        let Self { scenario, setup } = self;
        let noiseless = simulate(&Scenario { noise: None, ..scenario.clone() })?.recording;
        let (start, samples) = beginning(&noiseless, setup)?;
        // An encoder's noise, effects, and a rest to be aligned on differ from run to run.
        let alike = scenario.table == TableRecord::CommandedRate
            && scenario.effects.terms.is_empty()
            && setup.axis.is_some()
            && samples == (0..noiseless.len());
        let duration = scenario.profile.duration().max(scenario.interval);
        let span = Span { interval: scenario.interval, duration };
        let noise = scenario.noise.clone().unwrap_or_default();
        // An impossible noise is found here, before any run.
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
    /// What runs find, in their order; side by side where they can lie so.
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

    /// What one run finds, simulated and calibrated as any other recording.
    ///
    /// # Errors
    /// [`RunFailure`] if it has no estimates.
    pub fn run_alone(&self, run: u64) -> RunResult {
        let seed = Seed { run, ..self.scenario.seed };
        let simulated = simulate(&Scenario { seed, ..self.scenario.clone() }).map_err(reason)?;
        estimate(&simulated.recording, &self.setup).map_err(reason)
    }
}

/// An error's message and all behind it.
fn reason<E: std::error::Error>(error: E) -> RunFailure {
    let mut reason = error.to_string();
    let mut behind = error.source();
    while let Some(cause) = behind {
        reason = format!("{reason}: {cause}");
        behind = cause.source();
    }
    RunFailure { reason }
}
