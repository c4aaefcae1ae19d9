//! `rins calibrate`: from runs to sensor errors, with the certificate of what was found.

mod attitude;
mod budget;
mod case;
mod certificate;
mod files;
mod gates;
mod json;
mod paper;
mod prepared;
mod rests;

use rins_io::{Axes, ModelFile, shown};
use rins_terms::Model;

pub(crate) use self::budget::{Budget, Drift};
pub(crate) use self::case::Case;
pub(crate) use self::certificate::{Certificate, CertifiedRun};
pub(crate) use self::files::{EQUATION, STEPS, of_run_alone};
pub(crate) use self::json::{consistency_json, navigation_json, noise_json};
pub(crate) use self::paper::{calibrated, outcome};
pub(crate) use self::prepared::Prepared;
use crate::args::{Calibrate, ModelChoice};
use crate::commands::setup::load;
use crate::outcome::Outcome;

/// A model to be estimated, and what it is called.
pub(crate) struct NamedModel {
    pub(crate) name: String,
    pub(crate) model: Model,
}

impl NamedModel {
    /// The model that was chosen, read if it is a file, in a run with these axes.
    pub(crate) fn of(choice: &ModelChoice, axes: &Axes) -> anyhow::Result<Self> {
        let (name, model) = match choice {
            ModelChoice::Paper12 => ("paper12".into(), Model::paper12()),
            ModelChoice::Full => ("full".into(), Model::full()),
            ModelChoice::File(path) => (shown(path), ModelFile::read_along(path, axes)?.model),
        };
        Ok(Self { name, model })
    }
}

pub(crate) fn run(arguments: &Calibrate) -> anyhow::Result<Outcome> {
    let mut loaded =
        arguments.rigs.iter().map(|rig| load(rig)).collect::<anyhow::Result<Vec<_>>>()?;
    let read = |of: &rins_io::Loaded| {
        of.recording.table_angle.is_some() || of.recording.table_rate.is_some()
    };
    let by_default = match &loaded[..] {
        [only] if read(only) => ModelChoice::Paper12,
        _ => ModelChoice::Full,
    };
    let named = match arguments.model.as_ref().unwrap_or(&by_default) {
        ModelChoice::Paper12 => {
            let calibration = calibrated(&mut loaded[0])?;
            let outcome = outcome(&calibration, &loaded[0], &arguments.rigs[0])?;
            return Ok(outcome.of_log(&loaded[0]));
        }
        choice => NamedModel::of(choice, &loaded[0].rig.spin)?,
    };
    let runs = arguments.rigs.iter().zip(loaded);
    let runs = runs
        .map(|(rig, loaded)| Prepared::of(rig, loaded, arguments.noise))
        .collect::<anyhow::Result<Vec<_>>>()?;
    let certificate = Certificate::of(Case::of(runs, named, arguments.noise)?)?;
    let mut outcome = certificate.outcome();
    for run in &certificate.runs {
        outcome = outcome.of_log(&run.prepared.loaded);
    }
    Ok(outcome)
}
