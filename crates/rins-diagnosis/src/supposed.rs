//! Effects that are given and not searched for.

use rins_estimation::{Fit, NoiseKnowledge, Run};
use rins_imu::ImuSpec;
use rins_terms::{Model, TermInstance};

use crate::case::Case;
use crate::cause::Cause;
use crate::diagnosis::{Diagnosis, DiagnosisError, ensure_one_axis, with_lines};
use crate::rounding::Rounding;
use crate::settling::Found;

/// What `supposed` effects explain in `runs` of one IMU beyond `model`, without a search for others.
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
    case.supposing(supposed, |case, before, found| {
        let present = case.fit_near(before, &found)?;
        case.settled(before, present, found, Found::Supposed)
    })
}

impl Case<'_> {
    /// What some effects explain: `conclude` gets the case with those of them that are fast lines, the fit of the model, and the
    /// others.
    pub(crate) fn supposing(
        &self,
        supposed: &[TermInstance],
        conclude: impl FnOnce(
            &Case<'_>,
            &Fit,
            Vec<TermInstance>,
        ) -> Result<(Fit, Vec<Cause>), DiagnosisError>,
    ) -> Result<Diagnosis, DiagnosisError> {
        let before = self.fit()?;
        let (lines, found) = self.supposed_lines(&before, supposed);
        let given = with_lines(self.given, &lines);
        let case = Case { given: &given, ..*self };
        let (after, mut causes) = conclude(&case, &before, found)?;
        causes.extend(lines.into_iter().map(|(_, cause)| cause));
        causes.sort_by(|a, b| a.ln_p.total_cmp(&b.ln_p));
        let unexplained = case.unexplained((&before, &after), &causes)?;
        Ok(Diagnosis { causes, unexplained, before, after, not_testable: Vec::new() })
    }
}
