//! Effects that are given and not searched for.

use rins_estimation::{NoiseKnowledge, Run};
use rins_imu::ImuSpec;
use rins_terms::{Model, TermInstance};

use crate::case::Case;
use crate::criticism::rounding::Rounding;
use crate::diagnosis::{Diagnosis, DiagnosisError, ensure_one_axis, with_lines};

/// What `supposed` effects explain in `runs` of one IMU beyond `model`, by the score of [`diagnose`](crate::diagnose), without a search
/// for others.
///
/// Every one of them stays, whether it is significant or not.
///
/// # Errors
/// [`DiagnosisError`] if the model, with them or without, cannot be fitted.
pub fn suppose(
    runs: &[Run],
    model: &Model,
    supposed: &[TermInstance],
    imu: &ImuSpec,
    knowledge: NoiseKnowledge,
) -> Result<Diagnosis, DiagnosisError> {
    ensure_one_axis(runs)?;
    let rounding = Rounding::of(runs, knowledge.sheet());
    let case = Case::new(runs, model, imu, knowledge, &rounding);
    let before = case.fit()?;
    let (lines, effects) = case.supposed_lines(&before, supposed);
    let given = with_lines(model, &lines);
    let case = Case { given: &given, ..case };
    let near = case.with_given(&before)?;
    let (state, round, tried) = case.approximate().evaluated(&near, &effects)?;
    let (after, mut causes) = case.concluded(&near, (state, &round, &tried))?;
    causes.extend(lines.into_iter().map(|(_, cause)| cause));
    causes.sort_by(|a, b| a.ln_p.total_cmp(&b.ln_p));
    let unexplained = case.unexplained((&before, &after), &causes)?;
    Ok(Diagnosis { causes, unexplained, before, after, not_testable: Vec::new() })
}
