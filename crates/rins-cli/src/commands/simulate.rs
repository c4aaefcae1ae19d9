//! `rins simulate`: a measured-looking run from a scenario.

use anyhow::Context;
use rins_frames::units::DEG;
use rins_io::ScenarioFile;
use rins_simulation::simulate;
use serde_json::json;

use crate::args::Simulate;
use crate::outcome::Outcome;
use rins_io::shown;

pub(crate) fn run(arguments: &Simulate) -> anyhow::Result<Outcome> {
    let mut file = ScenarioFile::read(&arguments.scenario)?;
    if let Some(seed) = arguments.seed {
        file.scenario.seed.seed = seed;
    }
    let simulated = simulate(&file.scenario).with_context(|| shown(&arguments.scenario))?;
    let run = simulated.recording;
    let duration: f64 = run.increments.iter().map(|sample| sample.interval).sum();
    let turned: f64 =
        run.increments.iter().map(|sample| sample.angle.components().z.abs()).sum::<f64>()
            / (360.0 * DEG);
    let samples = run.len();
    let text = format!(
        "Simulated {}\n  {samples} samples over {duration:.2} s, {turned:.2} turns, seed {}\n",
        shown(&arguments.scenario),
        file.scenario.seed.seed
    );
    let json = json!({
        "schema": 1,
        "command": "simulate",
        "scenario": shown(&arguments.scenario),
        "samples": samples,
        "duration_s": duration,
        "turns": turned,
        "seed": file.scenario.seed.seed,
        "files": ["run.csv", "rig.toml", "truth.json"],
    });
    Ok(Outcome {
        json,
        text,
        fill: Some(Box::new(move |folder| file.write_run(&run, folder))),
        ..Outcome::default()
    })
}
