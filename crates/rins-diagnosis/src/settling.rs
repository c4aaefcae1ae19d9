//! A last look at every cause beside the others.

use rins_estimation::Fit;
use rins_terms::{Role, SettingKind, TermInstance, catalogue};

use crate::candidates::{Candidate, candidates};
use crate::case::Case;
use crate::cause::{Cause, Rival};
use crate::dead_zone;
use crate::diagnosis::{DiagnosisError, FALSE_ALARMS};
use crate::disturbance;
use crate::sought::settling_later;
use crate::suggested::at_frequency;
use crate::survey::Survey;
use crate::timing::has_frequency;
use crate::trial::{Context, Trial, best_pair, trials};

/// A rival is kept whose odds are no worse than one to this many e-folds: 1 to 55.
pub(crate) const RIVALS: f64 = 4.0;

/// An effect takes another's place if its odds are better by this many e-folds.
const BETTER: f64 = 0.5;

/// How often a cause may be exchanged or dropped.
const MOST_CHANGES: usize = 4;

/// A cause of fewer directions is not exchanged for two.
const FEWEST_FOR_TWO: usize = 3;

/// How many effects are tried as the first of two.
const FIRST_OF_TWO: usize = 4;

/// How effects came into a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Found {
    /// By a search: one may have to make room for another, or for none.
    Searched,
    /// They were said to be there.
    Supposed,
}

/// What the last look at a cause says.
enum Look {
    Keep(Cause),
    Drop,
    Exchange(Vec<TermInstance>),
}

/// All that is asked of one cause.
struct Question<'a> {
    survey: &'a Survey,
    list: &'a [Candidate],
    found: &'a [TermInstance],
    /// Which of those that were found.
    index: usize,
    /// Where its parameters are: a list for each.
    places: &'a [Vec<usize>],
    /// Every effect in its place.
    tried: Vec<Trial>,
    /// The odds for it with the time, or the exponent, that was found.
    as_found: Option<f64>,
    /// Among how many frequencies a line was found, or an event among how many times more than are tried.
    among: f64,
}

impl Case<'_> {
    /// Looks at every cause again beside the others: drops it if it is no longer needed, exchanges it for what
    /// explains it better, and lists what explains it as well.
    pub(crate) fn settled(
        &self,
        before: &Fit,
        mut present: Fit,
        mut found: Vec<TermInstance>,
        mut how: Found,
    ) -> Result<(Fit, Vec<Cause>), DiagnosisError> {
        let given = self.given.terms.len();
        // What was found, if exchanges lead to nothing: of two in its place one may be dropped, and the other not be enough.
        let mut as_searched = None;
        let mut changes = 0;
        loop {
            if found.is_empty() {
                let Some(searched) = as_searched.take() else { break };
                (present, found) = searched;
                changes = MOST_CHANGES;
            }
            let list = self.with_events(&present, &found);
            let epoch = present.linear[0].mean_epoch();
            let later = settling_later(&found, self.duration(), epoch);
            let all: Vec<Candidate> =
                list.iter().chain(later.iter().map(|(_, later)| later)).cloned().collect();
            let noises = self.between(before, &present);
            let survey = self.survey(&present, &all, &noises)?;
            let found_among = self.found_among(&present, &found)?;
            let mut causes = Vec::new();
            let mut change = None;
            for index in 0..found.len() {
                let places = survey.of_term(given + index);
                // What else settles may do so a little sooner or later without this one.
                let others = later.iter().enumerate().filter(|(_, (cause, _))| *cause != index);
                let taken: Vec<usize> = others
                    .flat_map(|(other, _)| survey.of_candidate(list.len() + other).concat())
                    .collect();
                let Some(context) = Context::of(&survey, &places.concat(), &taken) else {
                    continue;
                };
                let tried = trials(&survey, &context, &list);
                let is_found = |candidate: &Candidate| {
                    let (own, found) = (&candidate.chosen, &found[index]);
                    if dead_zone::is_of_widths(own) && dead_zone::is_true(found) {
                        return dead_zone::is_shape_of(own, &self.causes_in(&present)[index]);
                    }
                    let is_sought =
                        |kind| [SettingKind::Time, SettingKind::Exponent].contains(&kind);
                    own.term.settings.iter().any(|setting| is_sought(setting.kind))
                        && own.term.is(found.term)
                        && own.settings == found.settings
                };
                let as_found = list.iter().position(is_found).and_then(|at| {
                    let trial = context.trial(at, &list[at], survey.of_candidate(at))?;
                    Some(trial.evidence)
                });
                let (survey, list, found) = (&survey, &list, &found);
                let among = found_among[index];
                let mut question =
                    Question { survey, list, found, index, places, tried, as_found, among };
                // One that is alone has been fitted with and without, which says more than what is linear about the last fit.
                if let (1, Some(own)) = (found.len(), question.own_place()) {
                    question.tried[own].ln_p = self.ln_p(before, &present, &question.tried[own]);
                }
                let mut look = match how {
                    Found::Searched => self.look(&question),
                    Found::Supposed => Look::Keep(question.cause()),
                };
                // Exchanges may go round in circles: what is significant stays then, and what is not goes.
                if changes >= MOST_CHANGES && matches!(look, Look::Exchange(_)) {
                    let stays = question.own().is_some_and(|own| question.is_significant(own));
                    look = if stays { Look::Keep(question.cause()) } else { Look::Drop };
                }
                match look {
                    Look::Keep(cause) => causes.push(cause),
                    other => {
                        change = Some((index, other));
                        break;
                    }
                }
            }
            changes += 1;
            let is_exchange = matches!(change, Some((_, Look::Exchange(_))));
            if is_exchange && as_searched.is_none() {
                as_searched = Some((present.clone(), found.clone()));
            }
            let mut changed = found.clone();
            match change {
                Some((index, Look::Exchange(better))) => _ = changed.splice(index..=index, better),
                Some((index, _)) => _ = changed.remove(index),
                None => {
                    let (present, sought) = self.sharpened(present, &mut found)?;
                    for (index, cause) in causes.iter_mut().enumerate() {
                        let of = |p: &&rins_estimation::Estimate| p.parameter.term == given + index;
                        cause.parameters = present.parameters.iter().filter(of).cloned().collect();
                        cause.settings.clone_from(&found[index].settings);
                        let own = sought.iter().find(|one| one.cause == index);
                        cause.sought = own.map(|one| (one.place, one.sigma));
                    }
                    causes.sort_by(|a, b| a.ln_p.total_cmp(&b.ln_p));
                    return Ok((present, causes));
                }
            }
            // What an effect has carried far off may find no way back from there.
            let fitted = self.fit_near(&present, &changed);
            match fitted.or_else(|_| self.fit_near(before, &changed)) {
                Ok(fitted) => (present, found) = (fitted, changed),
                // What is better as far as it is linear may be no model of the run.
                Err(_) if is_exchange => changes = MOST_CHANGES,
                // Without it the model is too far from the run: what was found stays.
                Err(_) => how = Found::Supposed,
            }
        }
        Ok((present, Vec::new()))
    }

    /// All candidates, and every event at the times of those that were found, every line at their frequencies; of a dead
    /// zone that was found what was found, and such of further gyros.
    fn with_events(&self, present: &Fit, found: &[TermInstance]) -> Vec<Candidate> {
        let mut list = candidates(self.runs, self.given);
        for (index, cause) in found.iter().enumerate() {
            if dead_zone::is_true(cause) {
                list.retain(|other| !other.chosen.term.is(cause.term));
                let zone = &self.causes_in(present)[index];
                list.extend(dead_zone::with_another(zone));
            }
            let at: Vec<Candidate> =
                list.iter().filter_map(|candidate| candidate.at_the_time_of(cause)).collect();
            for candidate in at {
                if !list.iter().any(|other| other.chosen == candidate.chosen) {
                    list.push(candidate);
                }
            }
            if disturbance::is_one(cause.term) {
                let chosen = cause.clone().with_values(&vec![0.0; cause.values.len()]).estimated();
                list.push(Candidate { chosen, looks: 1.0, step: None, departs: None });
            }
            let is_listed = |other: &Candidate| {
                other.chosen.term.is(cause.term) && other.chosen.settings == cause.settings
            };
            if cause.term.is(&catalogue::ENCODER_HARMONIC) && !list.iter().any(is_listed) {
                list.push(Candidate::high_harmonic(cause.settings[0]));
            }
            if has_frequency(cause.term) {
                // That there is a line is known by now: what it is, is asked.
                let at = at_frequency(cause.settings[0]).into_iter();
                list.extend(at.map(|chosen| Candidate {
                    chosen,
                    looks: 1.0,
                    step: None,
                    departs: None,
                }));
            }
        }
        list
    }

    fn look(&self, question: &Question<'_>) -> Look {
        let Question { list, tried, .. } = question;
        let expecting = |trial: &Trial| list[trial.candidate].expecting(trial, self.imu);
        let better = tried
            .iter()
            .find(|trial| question.is_new(trial))
            .filter(|better| better.ln_p < question.threshold());
        let Some(own) = question.own().filter(|own| question.is_significant(own)) else {
            return match better.filter(|better| better.is_likely()) {
                Some(better) => Look::Exchange(vec![expecting(better)]),
                None => Look::Drop,
            };
        };
        // The same at the time of another event, which it may make needless; or with another exponent.
        if question.as_found.is_some_and(|as_found| own.evidence > as_found + BETTER) {
            return Look::Exchange(vec![expecting(own)]);
        }
        let own = own.evidence + BETTER;
        if let Some(better) = better.filter(|better| better.evidence > own) {
            return Look::Exchange(vec![expecting(better)]);
        }
        match question.pair() {
            Some((pair, evidence)) if evidence > own => {
                Look::Exchange(pair.iter().map(expecting).collect())
            }
            _ => Look::Keep(question.cause()),
        }
    }
}

impl Question<'_> {
    fn id(&self, trial: &Trial) -> &'static str {
        self.list[trial.candidate].chosen.term.id
    }

    fn threshold(&self) -> f64 {
        FALSE_ALARMS.ln() - (self.tried.len() as f64).ln()
    }

    /// The cause itself among those that are tried in its place.
    fn own(&self) -> Option<&Trial> {
        self.own_place().map(|own| &self.tried[own])
    }

    fn own_place(&self) -> Option<usize> {
        self.tried.iter().position(|trial| self.id(trial) == self.found[self.index].term.id)
    }

    /// Whether the cause itself is significant. Of a line the frequency is not asked again: it was found against all others.
    fn is_significant(&self, own: &Trial) -> bool {
        let is_line = has_frequency(self.found[self.index].term);
        own.ln_p + if is_line { 0.0 } else { self.among.ln() } < self.threshold()
    }

    /// Whether an effect is none of those that were found.
    fn is_new(&self, trial: &Trial) -> bool {
        self.found.iter().all(|found| found.term.id != self.id(trial))
    }

    /// Two effects that together explain what this one does, and the odds for both: the first pick of a search
    /// may be one that has parameters enough for two.
    fn pair(&self) -> Option<([Trial; 2], f64)> {
        if self.own().is_some_and(|own| own.dof < FEWEST_FOR_TWO) {
            return None;
        }
        let firsts = self.tried.iter().filter(|trial| self.is_new(trial)).take(FIRST_OF_TWO);
        let is_second = |trial: &Trial| self.is_new(trial) && trial.ln_p < self.threshold();
        let pair = best_pair(self.survey, self.list, &self.places.concat(), firsts, is_second)?;
        let evidence = pair[0].evidence + pair[1].evidence;
        Some((pair, evidence))
    }

    fn cause(&self) -> Cause {
        let found = &self.found[self.index];
        let own = self.own();
        // What it is has been asked at the frequency that was found, or the time, one of many.
        let families = (self.tried.len() as f64 * self.among).ln();
        Cause {
            term: found.term,
            settings: found.settings.clone(),
            sought: None,
            parameters: Vec::new(),
            ln_p: own.map_or(0.0, |own| (own.ln_p + families).min(0.0)),
            dof: own.map_or(0, |own| own.dof),
            gain: own.map_or(0.0, |own| 0.5 * own.statistic),
            rivals: self.rivals(),
        }
    }

    /// What explains the cause, or what one sensor shows of it, as well.
    fn rivals(&self) -> Vec<Rival> {
        let mut rivals = self.rivals_among(&self.tried);
        for part in self.rows() {
            let Some(context) = Context::of(self.survey, &part, &[]) else { continue };
            let tried = trials(self.survey, &context, self.list);
            if tried.first().is_none_or(|trial| trial.ln_p > self.threshold()) {
                continue;
            }
            for rival in self.rivals_among(&tried) {
                if rivals.iter().all(|other| !other.term.is(rival.term)) {
                    rivals.push(rival);
                }
            }
        }
        rivals.sort_by(|a, b| b.odds.total_cmp(&a.odds));
        rivals
    }

    /// The places of what each sensor shows of the cause, if it is a matrix and more than one does. A base that sways about three
    /// axes at one frequency is one thing.
    fn rows(&self) -> Vec<Vec<usize>> {
        let found = &self.found[self.index];
        let n = found.values.len();
        if n <= 3 || !n.is_multiple_of(3) || has_frequency(found.term) {
            return Vec::new();
        }
        let mut rows = vec![Vec::new(); 3];
        let estimated = (0..n).filter(|&parameter| found.roles[parameter] != Role::Held);
        for (parameter, places) in estimated.zip(self.places) {
            rows[parameter / (n / 3)].extend(places);
        }
        rows.retain(|row| !row.is_empty());
        if rows.len() > 1 { rows } else { Vec::new() }
    }

    fn rivals_among(&self, tried: &[Trial]) -> Vec<Rival> {
        // In how many parts an effect may come says nothing of whether it came, but what comes in one only should not
        // lose by it; nor should what is small of its kind, where the run is good enough to show so little of it. All
        // ways of counting are asked.
        let odds =
            |trial: &Trial| [0.0, trial.choices, trial.slight].map(|more| trial.evidence + more);
        let mut top = [f64::NEG_INFINITY; 3];
        for trial in tried {
            let of_trial = odds(trial);
            top = [0, 1, 2].map(|way| top[way].max(of_trial[way]));
        }
        let behind = |trial: &Trial| {
            let ways = odds(trial).into_iter().zip(top);
            ways.map(|(of_trial, top)| of_trial - top).fold(f64::NEG_INFINITY, f64::max)
        };
        // What explains less than half of it is no rival, however little that is.
        let least = -RIVALS.min(0.5 * top[0]);
        let explained = |trial: &Trial| trial.statistic - trial.dof as f64;
        let half = tried.first().map_or(0.0, |first| 0.5 * explained(first));
        let own = self.found[self.index].term.id;
        let is_rival = |trial: &&Trial| {
            self.id(trial) != own && behind(trial) > least && explained(trial) > half
        };
        tried
            .iter()
            .filter(is_rival)
            .map(|trial| Rival {
                term: self.list[trial.candidate].chosen.term,
                settings: self.list[trial.candidate].chosen.settings.clone(),
                odds: behind(trial),
            })
            .collect()
    }
}
