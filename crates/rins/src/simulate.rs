//! A simulated data set from a scenario.

use std::fmt;
use std::path::Path;

use anyhow::Context;
use rins_frames::units::DEG;
use rins_io::{InputFile, IoError, ScenarioFile, shown};
use rins_motion::Recording;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::basis::BasisResult;
use crate::error::Result;
use crate::outcome::Outcome;

/// A simulated data set in the form of a recorded log.
#[derive(Debug)]
pub struct SimulatedRun {
    name: String,
    file: ScenarioFile,
    run: Recording,
    basis: BasisResult,
}

/// The result of `rins simulate`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SimulateResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `simulate`.
    pub command: String,
    /// The scenario file.
    pub scenario: String,
    /// How many samples there are.
    pub samples: usize,
    /// How long the run is \[s\].
    pub duration_s: f64,
    /// How often the table turns, either way.
    pub turns: f64,
    /// The seed of its random numbers.
    pub seed: u64,
    /// The files of the run.
    pub files: Vec<String>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// Simulates the run of a scenario file, with `seed` in place of the scenario's seed if it is given.
///
/// # Errors
/// If the file cannot be read or has an invalid value, or if the run cannot be simulated.
///
/// ```
/// use rins::Outcome;
/// let folder = tempfile::tempdir()?;
/// let scenario = folder.path().join("scenario.toml");
/// std::fs::write(&scenario, rins::demo::SCENARIO)?;
/// let run = rins::simulate(&scenario, Some(7))?;
/// assert_eq!(run.result().seed, 7);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulate(scenario: &Path, seed: Option<u64>) -> Result<SimulatedRun> {
    let mut file = ScenarioFile::read(scenario)?;
    if let Some(seed) = seed {
        file.scenario.seed.seed = seed;
    }
    let name = shown(scenario);
    let run = rins_simulation::simulate(&file.scenario).with_context(|| name.clone())?.recording;
    let basis = BasisResult::of_files([InputFile::of(scenario)?]);
    Ok(SimulatedRun { name, file, run, basis })
}

impl fmt::Display for SimulatedRun {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let SimulateResult { samples, duration_s, turns, seed, .. } = self.result();
        writeln!(
            f,
            "Simulated {}\n  {samples} samples over {duration_s:.2} s, {turns:.2} turns, seed {seed}",
            self.name
        )
    }
}

impl Outcome for SimulatedRun {
    type Result = SimulateResult;

    fn result(&self) -> SimulateResult {
        let samples = &self.run.increments;
        let turned: f64 = samples.iter().map(|sample| sample.angle.components().z.abs()).sum();
        SimulateResult {
            schema: crate::SCHEMA,
            command: "simulate".into(),
            scenario: self.name.clone(),
            samples: samples.len(),
            duration_s: samples.iter().map(|sample| sample.interval).sum(),
            turns: turned / (360.0 * DEG),
            seed: self.file.scenario.seed.seed,
            files: ["run.csv", "rig.toml", "truth.json"].map(String::from).to_vec(),
            basis: self.basis.clone(),
        }
    }

    fn basis(&self) -> BasisResult {
        self.basis.clone()
    }

    fn fill(&self, folder: &Path) -> std::result::Result<(), IoError> {
        self.file.write_run(&self.run, folder)
    }
}
