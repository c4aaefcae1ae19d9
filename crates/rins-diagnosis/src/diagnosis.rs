//! From what a model leaves unexplained to the effects that explain it.

use rins_estimation::{Estimate, Fit, FitError, Indefinite, NoiseKnowledge, Run};
use rins_imu::{ImuNoiseError, ImuSpec};
use rins_terms::{Model, Term, TermInstance};

use crate::case::Case;
use crate::criticism::bursts::gathered;
use crate::criticism::rounding::Rounding;
use crate::criticism::unexplained::{Unexplained, described};
use crate::generic::is_generic;
use crate::hypothesis::Hypothesis;
use crate::proposal::lines::FastLine;
use crate::search::{MOST_EFFECTS, Round, State, Tried};
use crate::verdict::cause::Cause;

/// The chance of naming anything where there is nothing, over the whole catalogue.
pub const FALSE_ALARMS: f64 = 0.01;

/// A finished diagnosis.
#[derive(Clone, Debug)]
pub struct Diagnosis {
    /// What was found, strongest first; nothing is "adequate".
    pub causes: Vec<Cause>,
    /// What is left that no effect explains, most significant first.
    pub unexplained: Vec<Unexplained>,
    /// The model as it was given.
    pub before: Fit,
    /// The model with the causes in it.
    pub after: Fit,
    /// The effects of which these runs would show nothing.
    pub not_testable: Vec<&'static str>,
}

impl Diagnosis {
    /// The model with the causes in it, without what has no name.
    pub fn extended(&self) -> Model {
        let mut model = self.after.model().clone();
        model.terms.retain(|chosen| !is_generic(chosen.term));
        model
    }

    /// Whether the hypothesis has as many effects as the search allows, so that further ones may be hidden among what is unexplained.
    #[must_use]
    pub fn is_full(&self) -> bool {
        let [before, after] = [&self.before, &self.after].map(|fit| fit.model().terms.len());
        after.saturating_sub(before) >= MOST_EFFECTS
    }
}

/// Why runs could not be diagnosed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DiagnosisError {
    /// The given model cannot be fitted.
    #[error("the model cannot be fitted to the run")]
    Fit(#[from] FitError),
    /// The candidates cannot be tried.
    #[error("the effects of the catalogue cannot be tested on the run")]
    Screening(#[from] Indefinite),
    /// The noise of a fit cannot be simulated.
    #[error("the estimated noise cannot be simulated")]
    Simulation(#[from] ImuNoiseError),
    /// The runs are about different axes of the IMU.
    #[error(
        "the runs have different spin axes: only runs about one axis of the IMU can be diagnosed together"
    )]
    SeveralAxes,
}

/// Finds what `model` lacks in `runs` of one IMU, with one score for every hypothesis: the logarithm of its marginal likelihood
/// times its prior.
///
/// Amplitudes are integrated out with a prior over their typical range, settings over the range that the runs resolve; noise
/// parameters are profiled with the priors of the data sheet. The search adds, drops and exchanges effects, noise processes and
/// departures from stated priors as long as the score rises.
///
/// `progress` is told of every effect that joins the hypothesis.
///
/// # Errors
/// [`DiagnosisError`] if the model as given cannot be fitted, or the runs are about different axes.
pub fn diagnose(
    runs: &[Run],
    model: &Model,
    imu: &ImuSpec,
    knowledge: NoiseKnowledge,
    mut progress: impl FnMut(&'static str),
) -> Result<Diagnosis, DiagnosisError> {
    ensure_one_axis(runs)?;
    let rounding = Rounding::of(runs, knowledge.sheet());
    let case = Case::new(runs, model, imu, knowledge, &rounding);
    case.searched(&mut progress)
}

impl Case<'_> {
    /// What there is beyond the model.
    pub(crate) fn searched(
        &self,
        progress: &mut impl FnMut(&'static str),
    ) -> Result<Diagnosis, DiagnosisError> {
        let before = self.fit()?;
        // Lines that are faster than an epoch would come back as slow ones; but those that the table's own motion has come
        // after what may be wrong about it, for they would stand for that.
        let [mut of_motion, mut fast] = self.by_motion(&before, self.fast_lines(&before));
        loop {
            let diagnosis = self.by_score(&before, &fast, progress)?;
            let left = self.still_there(&diagnosis.after, &of_motion);
            of_motion.clear();
            if !left.is_empty() {
                fast.extend(left);
                continue;
            }
            // What was a line may be the table's own motion, read late.
            let still = self.still_there(&diagnosis.after, &fast);
            if still.len() == fast.len() {
                return Ok(diagnosis);
            }
            fast = still;
        }
    }

    /// What there is beyond a model and these fast lines: the hypothesis of the largest score.
    fn by_score(
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
    pub(crate) fn with_given(&self, near: &Fit) -> Result<Fit, DiagnosisError> {
        let is_same = near.model().terms.len() == self.given.terms.len();
        Ok(if is_same { near.clone() } else { self.fit_near(near, &[])? })
    }

    /// The final fit of a hypothesis, with the uncertainty of its settings, and its causes.
    pub(crate) fn concluded(
        &self,
        before: &Fit,
        (state, round, tried): (State, &Round, &[Tried]),
    ) -> Result<(Fit, Vec<Cause>), DiagnosisError> {
        let mut causes = self.causes_of(before, &state, round, tried)?;
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

    /// The diagnosis of a case that knows these fast lines: what is left unexplained beside the causes, and the noise.
    fn finished(
        &self,
        case: &Case<'_>,
        (before, after): (&Fit, Fit),
        fast: &[FastLine],
        causes: Vec<Cause>,
    ) -> Result<Diagnosis, DiagnosisError> {
        let (unknown, mut causes): (Vec<Cause>, Vec<Cause>) =
            causes.into_iter().partition(|cause| is_generic(cause.term));
        let mut unexplained: Vec<Unexplained> =
            unknown.iter().map(|cause| described(cause, &after)).collect();
        unexplained.extend(case.unexplained((before, &after), &causes)?);
        causes.extend(self.quantisation(&after));
        causes.extend(fast.iter().map(|(_, cause)| cause.clone()));
        let (mut causes, bursts) = gathered(causes, case.duration());
        let known = |burst: &Unexplained| {
            let alike = |one: &Unexplained| {
                (one.run, one.of, one.structure) == (burst.run, burst.of, burst.structure)
            };
            unexplained.iter().any(alike)
        };
        let bursts: Vec<Unexplained> = bursts.into_iter().filter(|burst| !known(burst)).collect();
        unexplained.extend(bursts);
        let noise = case.noise_causes(&after, unexplained.is_empty())?;
        let known: Vec<&Term> = causes.iter().map(|cause| cause.term).collect();
        causes.extend(noise.into_iter().filter(|one| !known.iter().any(|term| term.is(one.term))));
        causes.sort_by(|a, b| a.ln_p.total_cmp(&b.ln_p));
        let before = before.clone();
        Ok(Diagnosis { causes, unexplained, before, after, not_testable: Vec::new() })
    }
}

/// Refuses runs about different axes of the IMU.
pub(crate) fn ensure_one_axis(runs: &[Run]) -> Result<(), DiagnosisError> {
    let is_one = runs.iter().all(|run| run.axes == runs[0].axes);
    if is_one { Ok(()) } else { Err(DiagnosisError::SeveralAxes) }
}

/// A model with fast lines.
pub(crate) fn with_lines(model: &Model, lines: &[FastLine]) -> Model {
    let mut model = model.clone();
    model.terms.extend(lines.iter().map(|(line, _)| line.clone()));
    model
}
