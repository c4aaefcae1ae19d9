//! A last look at every cause beside the others.

use rins_estimation::Fit;
use rins_terms::Chosen;

use crate::candidates::{Candidate, candidates};
use crate::case::Case;
use crate::diagnosis::{Cause, DiagnosisError, FALSE_ALARMS, Rival};
use crate::disturbance;
use crate::lines::at_frequency;
use crate::survey::Survey;
use crate::trial::{Context, Trial, trials};

/// A rival is kept whose odds are no worse than one to this many e-folds: 1 to 33.
const RIVALS: f64 = 3.5;

/// An effect takes another's place if its odds are better by this many e-folds.
const BETTER: f64 = 0.5;

/// How often a cause may be exchanged or dropped.
const MOST_CHANGES: usize = 4;

/// What the last look at a cause says.
enum Look {
    Keep(Cause),
    Drop,
    Exchange(Chosen),
}

impl Case<'_> {
    /// Looks at every cause again beside the others: drops it if it is no longer needed, exchanges it for what
    /// explains it better, and lists what explains it as well.
    pub(crate) fn settled(
        &self,
        before: &Fit,
        mut present: Fit,
        mut found: Vec<Chosen>,
    ) -> Result<(Fit, Vec<Cause>), DiagnosisError> {
        let given = self.given.terms.len();
        let mut changes = 0;
        while !found.is_empty() {
            let list = self.with_events(&found);
            let noises = self.between(before, &present);
            let survey = Survey::of(self.runs, &present, self.imu, &list, &noises)?;
            let mut causes = Vec::new();
            let mut change = None;
            for index in 0..found.len() {
                let dropped: Vec<usize> = survey.of_term(given + index).concat();
                let Some(context) = Context::of(&survey, &dropped, &[]) else { continue };
                let tried = trials(&survey, &context, &list);
                match self.look(&list, &tried, &found, index) {
                    Look::Keep(cause) => causes.push(cause),
                    other if changes < MOST_CHANGES => {
                        change = Some((index, other));
                        break;
                    }
                    _ => causes.push(cause(&list, &tried, &found[index])),
                }
            }
            changes += 1;
            match change {
                Some((index, Look::Exchange(better))) => found[index] = better,
                Some((index, _)) => _ = found.remove(index),
                None => {
                    for (index, cause) in causes.iter_mut().enumerate() {
                        let of = |p: &&rins_estimation::Estimate| p.parameter.term == given + index;
                        cause.parameters = present.parameters.iter().filter(of).cloned().collect();
                    }
                    causes.sort_by(|a, b| a.ln_p.total_cmp(&b.ln_p));
                    return Ok((present, causes));
                }
            }
            present = self.fit(&found)?;
        }
        Ok((present, Vec::new()))
    }

    /// All candidates, and every event at the times of those that were found, every line at their frequencies.
    fn with_events(&self, found: &[Chosen]) -> Vec<Candidate> {
        let mut list = candidates(self.runs, self.given);
        for cause in found {
            let at: Vec<Candidate> =
                list.iter().filter_map(|candidate| candidate.at_the_time_of(cause)).collect();
            for candidate in at {
                if !list.iter().any(|other| other.chosen == candidate.chosen) {
                    list.push(candidate);
                }
            }
            if cause.term.id == disturbance::ID {
                let chosen = cause.clone().with_values(&vec![0.0; cause.values.len()]).estimated();
                list.push(Candidate { chosen, looks: 1.0, step: None });
            }
            let of_frequency = cause.term.settings.first().filter(|s| s.name == "frequency");
            if of_frequency.is_some() {
                // That there is a line is known by now: what it is, is asked.
                let at = at_frequency(cause.settings[0]).into_iter();
                list.extend(at.map(|chosen| Candidate { chosen, looks: 1.0, step: None }));
            }
        }
        list
    }

    fn look(&self, list: &[Candidate], tried: &[Trial], found: &[Chosen], index: usize) -> Look {
        let id = |trial: &Trial| list[trial.candidate].chosen.term.id;
        let threshold = FALSE_ALARMS.ln() - (tried.len() as f64).ln();
        let own = tried.iter().find(|trial| id(trial) == found[index].term.id);
        if tried.iter().all(|trial| trial.ln_p > threshold) {
            return Look::Drop;
        }
        let taken = |id: &str| found.iter().any(|other| other.term.id == id);
        let better = tried.iter().find(|trial| !taken(id(trial)));
        if let Some(better) = better
            && own.is_none_or(|own| better.evidence > own.evidence + BETTER)
        {
            return Look::Exchange(list[better.candidate].expecting(better, self.imu));
        }
        Look::Keep(cause(list, tried, &found[index]))
    }
}

fn cause(list: &[Candidate], tried: &[Trial], cause: &Chosen) -> Cause {
    let term = |trial: &Trial| list[trial.candidate].chosen.term;
    let own = tried.iter().find(|trial| term(trial).id == cause.term.id);
    // In how many parts an effect may come says nothing of whether it came.
    let odds = |trial: &Trial| trial.evidence + trial.choices;
    let top = tried.iter().map(odds).fold(f64::NEG_INFINITY, f64::max);
    let mut rivals: Vec<Rival> = tried
        .iter()
        .filter(|trial| term(trial).id != cause.term.id && odds(trial) > top - RIVALS)
        .map(|trial| Rival {
            term: term(trial),
            settings: list[trial.candidate].chosen.settings.clone(),
            odds: odds(trial) - top,
        })
        .collect();
    rivals.sort_by(|a, b| b.odds.total_cmp(&a.odds));
    let families = (tried.len() as f64).ln();
    Cause {
        term: cause.term,
        settings: cause.settings.clone(),
        parameters: Vec::new(),
        ln_p: own.map_or(0.0, |own| (own.ln_p + families).min(0.0)),
        dof: own.map_or(0, |own| own.dof),
        gain: own.map_or(0.0, |own| 0.5 * own.statistic),
        rivals,
    }
}
