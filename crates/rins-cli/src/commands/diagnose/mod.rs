//! `rins diagnose`: what a model leaves unexplained in a run, and the effect that explains it.

mod found;
mod json;
mod measured;
mod testable;

use std::path::Path;

pub(crate) use self::found::{Found, Named, Verdict};
pub(crate) use self::measured::Measured;
use crate::args::Diagnose;
use crate::commands::calibrate::{Case, NamedModel, Prepared};
use crate::commands::setup::load;
use crate::outcome::Outcome;

pub(crate) fn run(arguments: &Diagnose) -> anyhow::Result<Outcome> {
    let named = NamedModel::of(&arguments.model)?;
    let prepared = |rig: &Path| -> anyhow::Result<Prepared> {
        Ok(Prepared::of(rig, load(rig)?, arguments.noise)?.of_longest_rest())
    };
    let runs = arguments.rigs.iter().map(|rig| prepared(rig));
    let runs = runs.collect::<anyhow::Result<Vec<_>>>()?;
    let other = arguments.held_out.as_deref();
    let other = other.map(prepared).transpose()?;
    let case = Case::of(runs, named, arguments.noise)?;
    if let Some(other) = &other {
        case.ensure_same_imu(other)?;
    }
    let found = Found::of(case, other.as_ref())?;
    let mut outcome = found.outcome();
    for run in &found.certificate.runs {
        outcome = outcome.of_log(&run.prepared.loaded);
    }
    Ok(outcome)
}
