//! `rins diagnose`: what a model leaves unexplained in a run, and the effect that explains it.

mod found;
mod json;
mod testable;

pub(crate) use self::found::{Found, Named, Verdict};
use crate::args::Diagnose;
use crate::commands::calibrate::{Case, NamedModel, Prepared};
use crate::commands::setup::load;
use crate::outcome::Outcome;

pub(crate) fn run(arguments: &Diagnose) -> anyhow::Result<Outcome> {
    let named = NamedModel::of(&arguments.model)?;
    let runs = arguments.rigs.iter().map(|rig| Prepared::of(rig, load(rig)?, arguments.noise));
    let runs = runs.collect::<anyhow::Result<Vec<_>>>()?;
    let found = Found::of(Case::of(runs, named, arguments.noise)?)?;
    let mut outcome = found.outcome();
    for run in &found.certificate.runs {
        outcome = outcome.of_log(&run.prepared.loaded);
    }
    Ok(outcome)
}
