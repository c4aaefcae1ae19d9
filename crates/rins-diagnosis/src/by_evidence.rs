//! The diagnosis by the score of whole hypotheses.

use rins_estimation::{Estimate, Fit, NoiseKnowledge, Run};
use rins_imu::ImuSpec;
use rins_terms::{Model, TermInstance};

use crate::case::Case;
use crate::cause::Cause;
use crate::diagnosis::{Diagnosis, DiagnosisError, Search, ensure_one_axis, with_lines};
use crate::hypothesis::Hypothesis;
use crate::lines::FastLine;
use crate::rounding::Rounding;
use crate::search::{Round, State, Tried};

/// Finds what `model` lacks in `runs` of one IMU, with one score for every hypothesis: the logarithm of its marginal likelihood
/// times its prior.
///
/// Amplitudes are integrated out with a prior over their typical range, settings over the range that the runs resolve; noise
/// parameters are profiled with the priors of the data sheet. The search adds, drops and exchanges effects, noise processes and
/// departures from stated priors as long as the score rises.
///
/// # Errors
/// As [`diagnose`](crate::diagnose).
pub fn diagnose_by_evidence(
    runs: &[Run],
    model: &Model,
    imu: &ImuSpec,
    knowledge: NoiseKnowledge,
    mut progress: impl FnMut(&'static str),
) -> Result<Diagnosis, DiagnosisError> {
    ensure_one_axis(runs)?;
    let rounding = Rounding::of(runs, knowledge.sheet());
    let case = Case::new(runs, model, imu, knowledge, &rounding);
    case.searched(Search::Evidence, &mut progress)
}

/// What given effects explain in runs of one IMU beyond a model, by the score of [`diagnose_by_evidence`].
///
/// Every one of them stays, whether it is significant or not.
///
/// # Errors
/// [`DiagnosisError`] if the model, with them or without, cannot be fitted.
pub fn evaluate_by_evidence(
    runs: &[Run],
    model: &Model,
    effects: &[TermInstance],
    imu: &ImuSpec,
    knowledge: NoiseKnowledge,
) -> Result<Diagnosis, DiagnosisError> {
    ensure_one_axis(runs)?;
    let rounding = Rounding::of(runs, knowledge.sheet());
    let case = Case::new(runs, model, imu, knowledge, &rounding);
    case.supposing(effects, |case, before, found| {
        let near = case.with_given(before)?;
        let (state, round, tried) = case.approximate().evaluated(&near, &found)?;
        case.concluded(&near, (state, &round, &tried))
    })
}

impl Case<'_> {
    /// What there is beyond a model and these fast lines: the hypothesis of the largest score.
    pub(crate) fn by_score(
        &self,
        before: &Fit,
        fast: &[FastLine],
        progress: &mut impl FnMut(&'static str),
    ) -> Result<Diagnosis, DiagnosisError> {
        let given = with_lines(self.given, fast);
        let case = Case { given: &given, ..*self };
        let present = case.with_given(before)?;
        let (state, round, tried) = case.approximate().search(&present, progress)?;
        let not_testable = round.not_testable();
        let given = state.hypothesis.given(case.given, case.imu);
        let (after, causes) = case.concluded(&present, (state, &round, &tried))?;
        let case = Case { given: &given, ..case };
        let found = self.finished(&case, (before, after), fast, causes)?;
        Ok(Diagnosis { not_testable, ..found })
    }

    /// The fit of the given model near that of one that may lack its fast lines.
    fn with_given(&self, near: &Fit) -> Result<Fit, DiagnosisError> {
        let is_same = near.model().terms.len() == self.given.terms.len();
        Ok(if is_same { near.clone() } else { self.fit_near(near, &[])? })
    }

    /// The final fit of a hypothesis, with the uncertainty of its settings, and its causes.
    fn concluded(
        &self,
        before: &Fit,
        (state, round, tried): (State, &Round, &[Tried]),
    ) -> Result<(Fit, Vec<Cause>), DiagnosisError> {
        let mut causes = self.causes_of(&state, round, tried)?;
        if state.hypothesis.is(&Hypothesis::default()) {
            return Ok((before.clone(), causes));
        }
        let given = state.hypothesis.given(self.given, self.imu);
        let case = Case { given: &given, ..self.with_processes(&state.hypothesis.open) };
        let effects = state.hypothesis.effects.into_iter();
        let mut found: Vec<TermInstance> = effects.map(|one| one.instance).collect();
        let (near, _) = case.approximate().at_their_best(state.fit, &mut found)?;
        let (after, sought) = case.sharpened(case.fit_near(&near, &found)?, &mut found)?;
        let offset = self.given.terms.len();
        for (index, (cause, found)) in causes.iter_mut().zip(&found).enumerate() {
            let of = |p: &&Estimate| p.parameter.term == offset + index;
            cause.parameters = after.parameters.iter().filter(of).cloned().collect();
            cause.settings.clone_from(&found.settings);
            let own = sought.iter().find(|one| one.cause == index);
            cause.sought = own.map(|one| (one.place, one.sigma));
        }
        Ok((after, causes))
    }
}
