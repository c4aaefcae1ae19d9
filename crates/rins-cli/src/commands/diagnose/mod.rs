//! `rins diagnose`: what a model leaves unexplained in a run, and the effect that explains it.

mod found;
mod json;
mod measured;
mod testable;

use std::path::Path;

use rins_io::{Loaded, ModelFile, shown};
use rins_terms::Chosen;

pub(crate) use self::found::{Asked, ByChance, Found, Named, Verdict};
pub(crate) use self::measured::{Measured, On};
use crate::args::{Diagnose, ModelChoice, NoiseChoice};
use crate::commands::calibrate::{Case, NamedModel, Prepared};
use crate::commands::setup::load;
use crate::outcome::Outcome;

/// A diagnosis of one run as it comes, without an output.
pub(crate) fn diagnosed(rig: &Path, loaded: Loaded) -> anyhow::Result<Found> {
    let noise = NoiseChoice::Likely;
    let run = Prepared::of(rig, loaded, noise)?.alone();
    let named = NamedModel::of(&ModelChoice::Full, &run.loaded.rig.spin)?;
    Found::of(Case::of(vec![run], named, noise)?, &Asked::default())
}

pub(crate) fn run(arguments: &Diagnose) -> anyhow::Result<Outcome> {
    let prepared = |rig: &Path| -> anyhow::Result<Prepared> {
        Ok(Prepared::of(rig, load(rig)?, arguments.noise)?.alone())
    };
    let runs = arguments.rigs.iter().map(|rig| prepared(rig));
    let runs = runs.collect::<anyhow::Result<Vec<_>>>()?;
    let other = arguments.held_out.as_deref();
    let other = other.map(prepared).transpose()?;
    let named = NamedModel::of(&arguments.model, &runs[0].loaded.rig.spin)?;
    let case = Case::of(runs, named, arguments.noise)?;
    if let Some(other) = &other {
        case.ensure_same_imu(other)?;
    }
    let supposed = arguments.suppose.as_deref().map(|file| supposed(file, &case)).transpose()?;
    let asked = Asked {
        supposed,
        held_out: other,
        transfer: arguments.transfer,
        bootstrap: arguments.bootstrap,
    };
    let found = Found::of(case, &asked)?;
    let mut outcome = found.outcome();
    for run in &found.certificate.runs {
        outcome = outcome.of_log(&run.prepared.loaded);
    }
    Ok(outcome)
}

/// The effects of a model file beyond a case's model.
fn supposed(file: &Path, case: &Case) -> anyhow::Result<Vec<Chosen>> {
    let mut terms = ModelFile::read_along(file, &case.runs[0].loaded.rig.spin)?.model.terms;
    terms.retain(|chosen| !case.model.terms.iter().any(|own| own.term.id == chosen.term.id));
    let silent = terms.iter().find(|chosen| !chosen.term.is_signal());
    if let Some(chosen) = silent {
        anyhow::bail!(
            "{}: {} adds nothing to any signal: what noise there is, is found beside every model",
            shown(file),
            chosen.term.id
        );
    }
    anyhow::ensure!(
        !terms.is_empty(),
        "{}: there is nothing to suppose: it holds no term that the model has not",
        shown(file)
    );
    Ok(terms)
}
