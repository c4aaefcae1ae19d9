//! `rins demo`: the main job on an embedded run, with nothing to prepare.

use std::path::Path;

use anyhow::Context;

use crate::commands::calibrate::{calibrated, outcome};
use crate::outcome::Outcome;

/// The rig file of the embedded run.
const RIG: &str = include_str!("../../data/demo/rig.toml");
/// Its log, made by `rins simulate` from `data/demo/scenario.toml`.
const LOG: &str = include_str!("../../data/demo/run.csv");

pub(crate) fn run() -> anyhow::Result<Outcome> {
    // The run is read as anybody's would be: from files.
    let folder = tempfile::tempdir().context("no temporary folder for the embedded run")?;
    let rig = folder.path().join("rig.toml");
    let write = |name: &str, content: &str| {
        std::fs::write(folder.path().join(name), content)
            .with_context(|| format!("cannot write the embedded {name}"))
    };
    write("rig.toml", RIG)?;
    write("run.csv", LOG)?;
    let loaded = rins_io::read(&rig)?;
    let calibration = calibrated(&loaded)?;
    let mut outcome = outcome(&calibration, &loaded, Path::new("the embedded demo run"))?;
    outcome.json["command"] = "demo".into();
    outcome.files.push(("rig.toml", RIG.into()));
    outcome.files.push(("run.csv", LOG.into()));
    outcome.text.push_str(
        "\n  The run and its rig file lie beside the report. Try next:\n    \
         rins check rins-demo/rig.toml\n    \
         rins calibrate rins-demo/rig.toml -o my-calibration\n    \
         rins navigate rins-demo/rig.toml --calibration rins-demo/calibration.toml\n",
    );
    Ok(outcome)
}
