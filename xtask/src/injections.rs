//! Known errors added to measured logs: diagnoses them, and writes the page of the book.

use std::path::Path;

use clap::Args;

use crate::Result;
use crate::blind::{optimized, trials};
use crate::false_alarms::revision;

/// The measured logs, by their rig files under `tests/rigs`.
const LOGS: [&str; 3] = ["psins_lasergyro", "tofupilot_thermal", "worklab_wheel_right"];

/// The options of the trials.
#[derive(Args)]
pub(crate) struct Options {
    /// Number of parts of each log, each diagnosed with errors of four amplitudes
    #[arg(long, default_value_t = 7)]
    rounds: u64,
    /// Seed of all trials
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Diagnoses measured logs with errors added and writes `docs/src/injections.md`.
pub(crate) fn run(root: &Path, options: &Options) -> Result<()> {
    let data = std::env::var("RINS_DATA")
        .map_err(|_| "RINS_DATA is not set: the folder of the measured logs is not known")?;
    let program = optimized(root)?;
    let folder = root.join("target/injections");
    std::fs::create_dir_all(&folder)?;
    let mut rigs = Vec::new();
    for log in LOGS {
        let name = format!("{log}.toml");
        let rig = std::fs::read_to_string(root.join("tests/rigs").join(&name))?;
        let own = folder.join(name);
        std::fs::write(&own, rig.replace("RINS_DATA", &data))?;
        rigs.push(own.display().to_string());
    }
    let rigs = rigs.join(",");
    let page = root.join("docs/src/injections.md").display().to_string();
    let [seed, rounds] = [options.seed, options.rounds].map(|number| number.to_string());
    trials(root, &["injections", &program, &rigs, &seed, &rounds, &page, &revision(root)?])
}
