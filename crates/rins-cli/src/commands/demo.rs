//! `rins demo`: the main job on an embedded run, with nothing to prepare.

use std::path::Path;

use anyhow::Context;

use crate::args::Demo;
use crate::commands::calibrate::{calibrated, outcome};
use crate::commands::diagnose::diagnosed;
use crate::outcome::Outcome;

/// The rig file of the embedded run.
const RIG: &str = include_str!("../../data/demo/rig.toml");
/// Its log, made by `rins simulate` from `data/demo/scenario.toml`.
const LOG: &str = include_str!("../../data/demo/run.csv");

pub(crate) fn run(demo: &Demo) -> anyhow::Result<Outcome> {
    // The run is read as anybody's would be: from files.
    let folder = tempfile::tempdir().context("no temporary folder for the embedded run")?;
    let rig = folder.path().join("rig.toml");
    let write = |name: &str, content: &str| {
        std::fs::write(folder.path().join(name), content)
            .with_context(|| format!("cannot write the embedded {name}"))
    };
    write("rig.toml", RIG)?;
    write("run.csv", LOG)?;
    let mut loaded = rins_io::read(&rig)?;
    let calibration = calibrated(&mut loaded)?;
    let mut outcome = outcome(&calibration, &loaded, Path::new("the embedded demo run"))?;
    outcome.json["command"] = "demo".into();
    // There is more in the run than the paper's filter has states for.
    let diagnosis = diagnosed(Path::new("the embedded demo run"), loaded)?.outcome();
    outcome.json["diagnosis"] = diagnosis.json;
    outcome.text.push('\n');
    outcome.text.push_str(&diagnosis.text);
    if let (Some(report), Some(further)) = (&mut outcome.report, diagnosis.report) {
        report.summary.extend(further.summary);
        report.sections.extend(further.sections);
    }
    let further = diagnosis.files.into_iter();
    outcome.files.extend(further.map(|(name, content)| (format!("extended-{name}"), content)));
    outcome.files.push(("rig.toml".into(), RIG.into()));
    outcome.files.push(("run.csv".into(), LOG.into()));
    outcome.text.push_str(&next(&demo.output));
    Ok(outcome)
}

/// What to try next on the files in `folder`, ready to be pasted into a shell.
fn next(folder: &Path) -> String {
    let [rig, calibration] = ["rig.toml", "extended-calibration.toml"]
        .map(|name| quoted(&folder.join(name).display().to_string()));
    format!(
        "\n  The run and its rig file lie beside the report. Try next:\n    \
         rins check {rig}\n    \
         rins calibrate {rig} -o my-calibration\n    \
         rins diagnose {rig}\n    \
         rins navigate {rig} --calibration {calibration}\n"
    )
}

/// A path as a shell takes it for one word.
fn quoted(path: &str) -> String {
    let plain = |letter: char| letter.is_alphanumeric() || "/\\:._-+,@%".contains(letter);
    if path.chars().all(plain) { path.into() } else { format!("'{}'", path.replace('\'', r"'\''")) }
}
