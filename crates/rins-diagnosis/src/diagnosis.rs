//! From what a model leaves unexplained to the effects that explain it.

use rins_estimation::{Fit, FitError, Indefinite, NoiseKnowledge, Run};
use rins_imu::ImuSpec;
use rins_terms::{Model, SettingKind, Term, TermInstance};

use crate::bursts::gathered;
use crate::candidates::{Candidate, candidates};
use crate::case::Case;
use crate::cause::Cause;
use crate::disturbance;
use crate::lines::FastLine;
use crate::probability::ln_tail;
use crate::rounding::Rounding;
use crate::settling::Found;
use crate::structure::Structure;
use crate::survey::Survey;
use crate::timing::has_frequency;
use crate::trial::{Context, Trial, best_pair, trials};
use crate::unexplained::{Unexplained, described};
use crate::wander::CHOSEN;

/// The chance of naming anything where there is nothing, over the whole catalogue.
pub const FALSE_ALARMS: f64 = 0.01;

/// The most effects that are looked for.
const MOST_CAUSES: usize = 8;

/// After so many effects that looked significant and were not, the search ends.
const MOST_REFUSED: usize = 2;

/// How many effects are tried as the first of two that mask each other.
const FIRST_OF_MASKED: usize = 8;

/// A time constant of more than this part of the longest run is that of something that never settles.
const NEVER: f64 = 0.3;

/// An effect of more parameters that never settles is doubted.
const MOST_SIMPLE: usize = 3;

/// How many effects are accepted before the noise is found anew and the model made linear about them.
const AT_ONCE: usize = 3;

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
        model.terms.retain(|chosen| !disturbance::is_one(chosen.term));
        model
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
    /// The runs are about different axes of the IMU.
    #[error(
        "the runs have different spin axes: only runs about one axis of the IMU can be diagnosed together"
    )]
    SeveralAxes,
}

/// Finds what `model` leaves unexplained in `runs` of one IMU, one effect after the other.
///
/// Where the noise is to be found it is found anew beside every effect that is tried: fitted without
/// the effect, it would have swallowed it. `progress` is told of every effect that is accepted.
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
    let found = case.searched(Search::Stepwise, &mut progress)?;
    let (case, found) =
        case.read_unevenly(found, |uneven| uneven.searched(Search::Stepwise, &mut progress))?;
    case.wandering(found, |walking| walking.searched(Search::Stepwise, &mut progress))
}

/// How effects are searched for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Search {
    /// One after the other, the most significant first.
    Stepwise,
    /// By the score of the whole hypothesis.
    Evidence,
}

impl Case<'_> {
    /// What there is beyond the model.
    pub(crate) fn searched(
        &self,
        search: Search,
        progress: &mut impl FnMut(&'static str),
    ) -> Result<Diagnosis, DiagnosisError> {
        let before = self.fit()?;
        // Lines that are faster than an epoch would come back as slow ones; but those that the table's own motion has come
        // after what may be wrong about it, for they would stand for that.
        let [mut of_motion, mut fast] = self.by_motion(&before, self.fast_lines(&before));
        loop {
            let diagnosis = match search {
                Search::Stepwise => self.likelier(&before, &fast, progress)?,
                Search::Evidence => self.by_score(&before, &fast, progress)?,
            };
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

    /// What there is beyond a model and these fast lines, by the likelier of two ways.
    ///
    /// An effect that can follow much may be found for several others at once, and with it in the model none of them is
    /// missed. But it is not the same throughout the run then: what would have been found without it is tried too.
    fn likelier(
        &self,
        before: &Fit,
        fast: &[FastLine],
        progress: &mut impl FnMut(&'static str),
    ) -> Result<Diagnosis, DiagnosisError> {
        let found = self.beyond(before, fast, &[], progress)?;
        let inconstant = |one: &Unexplained| {
            one.of.filter(|_| matches!(one.structure, Structure::Inconstant(_)))
        };
        let mut doubtful: Vec<&str> = found.unexplained.iter().filter_map(inconstant).collect();
        // What has not settled when the run ends follows slow effects of any kind.
        let never_settles = |cause: &&Cause| {
            let place = cause.term.setting(SettingKind::TimeConstant);
            let time_constant = place.map_or(0.0, |place| cause.settings[place]);
            cause.term.parameters.len() > MOST_SIMPLE && time_constant > NEVER * self.duration()
        };
        doubtful.extend(found.causes.iter().filter(never_settles).map(|cause| cause.term.id));
        let given = before.model().terms.len() + fast.len();
        let causes = |one: &Diagnosis| one.after.model().terms.len() - given;
        // One that stands alone has been held against every other by now.
        if doubtful.is_empty() || causes(&found) == 1 {
            return Ok(found);
        }
        let Ok(other) = self.beyond(before, fast, &doubtful, progress) else { return Ok(found) };
        let gained = other.after.log_likelihood - found.after.log_likelihood;
        let chosen = |one: &Diagnosis| CHOSEN * causes(one) as f64 + self.sought_from(&one.causes);
        let odds = gained + chosen(&found) - chosen(&other);
        // Noise may stand for them too, but it is no other effect.
        let is_likelier = causes(&other) > 0 && odds > 0.0;
        Ok(if is_likelier { other } else { found })
    }

    /// What there is beyond a model and these fast lines, without a search for what is `refused`.
    fn beyond(
        &self,
        before: &Fit,
        fast: &[FastLine],
        refused: &[&str],
        progress: &mut impl FnMut(&'static str),
    ) -> Result<Diagnosis, DiagnosisError> {
        let mut present = before.clone();
        let given = with_lines(self.given, fast);
        let case = Case { given: &given, ..*self };
        let Case { runs, imu, .. } = case;
        if !fast.is_empty() {
            present = case.fit_near(before, &[])?;
        }
        let mut found: Vec<TermInstance> = Vec::new();
        let mut not_testable = None;
        let (mut refused, most_refused) = (refused.to_vec(), refused.len() + MOST_REFUSED);
        while found.len() < MOST_CAUSES {
            let mut list = candidates(runs, present.model());
            let jolts = case.jolts(&present);
            list.extend(case.suggested(&present, &jolts));
            list.retain(|candidate| !refused.contains(&candidate.chosen.term.id));
            let survey = case.survey(&present, &list, &case.noises(&present))?;
            let Some(context) = Context::of(&survey, &[], &[]) else { break };
            let tried = trials(&survey, &context, &list);
            not_testable.get_or_insert_with(|| unseen(&list, &tried));
            let threshold = FALSE_ALARMS.ln() - (tried.len() as f64).ln();
            let accepted = match case.best(&present, &list, &tried, threshold)? {
                Some((mut candidate, trial)) => {
                    jolts.pin(&mut candidate.chosen);
                    let as_listed = list[trial.candidate].chosen == candidate.chosen;
                    let mut accepted = vec![(candidate, trial)];
                    // An effect that had to be sought, or that the noise may have swallowed, is fitted by itself.
                    if as_listed && accepted[0].1.ln_p < threshold {
                        let most = AT_ONCE.min(MOST_CAUSES - found.len());
                        beside(&survey, &list, &mut accepted, threshold, most);
                    }
                    accepted
                }
                None => match masked(&survey, &list, &tried, threshold) {
                    Some(pair) if found.len() + 2 <= MOST_CAUSES => {
                        pair.map(|trial| (list[trial.candidate].clone(), trial)).into()
                    }
                    _ => break,
                },
            };
            let earlier = found.len();
            found.extend(accepted.iter().map(|(candidate, trial)| candidate.expecting(trial, imu)));
            let fitted = case.fit_near(&present, &found);
            let significant = |fitted: &Fit| match &accepted[..] {
                [(_, trial)] => case.ln_p(&present, fitted, trial) <= threshold,
                _ => true,
            };
            let Some(fitted) = fitted.ok().filter(significant) else {
                found.truncate(earlier);
                // One that is not linear, or that noise explains as well, hides what else there is.
                if refused.len() < most_refused {
                    refused.extend(accepted.iter().map(|(one, _)| one.chosen.term.id));
                    continue;
                }
                break;
            };
            for (candidate, _) in &accepted {
                progress(candidate.chosen.term.id);
            }
            present = fitted;
            // Each of two that settle has taken a part of the other, and what a line leaves whose frequency is a little off is
            // another line beside it: either would pass for something else.
            let is_line = |(one, _): &(Candidate, Trial)| has_frequency(one.chosen.term);
            if settles_twice(&found) || accepted.iter().any(is_line) {
                present = case.at_their_best(present, &mut found)?.0;
            }
        }
        let (after, causes) = case.settled(before, present, found, Found::Searched)?;
        let found = self.finished(&case, (before, after), fast, causes)?;
        Ok(Diagnosis { not_testable: not_testable.unwrap_or_default(), ..found })
    }

    /// The diagnosis of a case that knows these fast lines: what is left unexplained beside the causes, and the noise.
    pub(crate) fn finished(
        &self,
        case: &Case<'_>,
        (before, after): (&Fit, Fit),
        fast: &[FastLine],
        causes: Vec<Cause>,
    ) -> Result<Diagnosis, DiagnosisError> {
        let (unknown, mut causes): (Vec<Cause>, Vec<Cause>) =
            causes.into_iter().partition(|cause| disturbance::is_one(cause.term));
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

/// Two effects that mask each other: neither shows alone, both do together.
fn masked(
    survey: &Survey,
    list: &[Candidate],
    tried: &[Trial],
    threshold: f64,
) -> Option<[Trial; 2]> {
    let as_listed = |trial: &Trial| list[trial.candidate].step.is_none();
    let firsts = tried.iter().filter(|trial| as_listed(trial)).take(FIRST_OF_MASKED);
    let is_second = |trial: &Trial| as_listed(trial) && trial.ln_p < threshold;
    let pair = best_pair(survey, list, &[], firsts, is_second)?;
    let [one, other] = &pair;
    let looks = one.looks + other.looks + 2.0 * (tried.len() as f64).ln();
    let ln_p = ln_tail(one.statistic + other.statistic, one.dof + other.dof) + looks;
    (ln_p < FALSE_ALARMS.ln() && one.evidence + other.evidence > 0.0).then_some(pair)
}

/// Adds what is significant beside the effects that have been accepted, as long as nothing has to be sought.
fn beside(
    survey: &Survey,
    list: &[Candidate],
    accepted: &mut Vec<(Candidate, Trial)>,
    threshold: f64,
    most: usize,
) {
    while accepted.len() < most {
        let of = |(_, trial): &(Candidate, Trial)| survey.of_candidate(trial.candidate).concat();
        let taken: Vec<usize> = accepted.iter().flat_map(of).collect();
        let Some(context) = Context::of(survey, &[], &taken) else { return };
        let tried = trials(survey, &context, list);
        let other = |trial: &&Trial| {
            let id = list[trial.candidate].chosen.term.id;
            accepted.iter().all(|(candidate, _)| candidate.chosen.term.id != id)
        };
        let Some(next) = tried.iter().find(other) else { return };
        if next.ln_p > threshold || next.evidence < 0.0 || list[next.candidate].step.is_some() {
            return;
        }
        accepted.push((list[next.candidate].clone(), next.clone()));
    }
}

/// Whether the last effect of some settles in another time than one of its kind before.
fn settles_twice(found: &[TermInstance]) -> bool {
    found.split_last().is_some_and(|(last, before)| {
        let settles = last.term.setting(SettingKind::TimeConstant).is_some();
        settles && before.iter().any(|one| one.term.is(last.term))
    })
}

/// Terms of which no shape shows.
fn unseen(list: &[Candidate], tried: &[Trial]) -> Vec<&'static str> {
    let mut ids = Vec::new();
    for candidate in list {
        let id = candidate.chosen.term.id;
        let seen = tried.iter().any(|trial| list[trial.candidate].chosen.term.id == id);
        if !ids.contains(&id) && !seen {
            ids.push(id);
        }
    }
    ids
}
