//! Trials, one after the other, and what came of each, in a file that can be gone on with.

use std::collections::BTreeSet;
use std::fs::{self, OpenOptions};
use std::io::Write as _;
use std::path::Path;
use std::sync::Mutex;

use rins_blind::{record, write};
use rins_terms::{Model, Term, TermInstance, catalogue};
use serde::{Deserialize, Serialize};
use tempfile::TempDir;

use crate::answer::{Analyser, Answer};
use crate::draw::{Kind, Trial};
use crate::hide::Hidden;
use crate::laboratory::{Grade, Length, Level, Schedule};
use crate::outside::Outside;
use crate::trouble::Trouble;
use crate::workers::at_once;

/// What one effect of so many sigmas gains is set against what the true model gains.
const GAINFUL: f64 = 6.0;

/// A trial and its answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The seed of all trials.
    pub seed: u64,
    /// Which trial.
    pub index: u64,
    /// Whether it was run to see how long it takes: alone, and as long as can be.
    pub timed: bool,
    /// What was hidden.
    pub kind: Kind,
    /// How the table turned.
    pub schedule: Schedule,
    /// How real it was.
    pub level: Level,
    /// The grade of the IMU.
    #[serde(default)]
    pub grade: Grade,
    /// The length of a sample \[s\].
    pub interval: f64,
    /// How long the run was \[s\].
    pub duration: f64,
    /// The effects that were hidden.
    pub hidden: Vec<Hidden>,
    /// What was hidden and in no catalogue.
    pub outside: Option<Outside>,
    /// Effects that were there because no table is perfect.
    pub present: Vec<String>,
    /// What the program said.
    pub answer: Answer,
}

/// A population of trials.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Population {
    /// Blind trials: [`Trial::draw`].
    Blind,
    /// Runs without an unmodeled error: [`Trial::null`].
    Null,
}

/// Which trials are to be run.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// From which population.
    pub population: Population,
    /// The seed of all of them.
    pub seed: u64,
    /// How many there are.
    pub trials: usize,
    /// How many run at once.
    pub threads: usize,
    /// The shard to be run, such as (2, 5) for the second of five; (1, 1) for all trials.
    pub shard: (u64, u64),
}

impl Plan {
    /// Whether a trial belongs to the shard.
    fn has(&self, index: u64) -> bool {
        let (shard, of) = self.shard;
        index % of == shard - 1
    }
}

/// The records of a journal; a last line that was not finished is left out.
///
/// # Errors
/// [`Trouble`] if it cannot be read.
pub fn records(journal: &Path) -> Result<Vec<Record>, Trouble> {
    if !journal.exists() {
        return Ok(Vec::new());
    }
    let text = fs::read_to_string(journal)?;
    let whole = text.rfind('\n').map_or("", |end| &text[..end]);
    let mut records = Vec::new();
    for line in whole.lines() {
        records.push(serde_json::from_str(line)?);
    }
    Ok(records)
}

/// Makes a trial, asks the program, and leaves nothing behind.
///
/// # Errors
/// [`Trouble`] if the trial cannot be made or the program not be asked.
pub fn try_out(trial: &Trial, analyser: &Analyser) -> Result<Answer, Trouble> {
    let (folder, mut answer) = answered(trial, analyser)?;
    if let ([hidden], false) = (&trial.hidden[..], trial.has_an_imperfect_table())
        && hidden.strength >= GAINFUL
        && let Some(truth) = hidden.as_term()
    {
        let given = analyser.ask_given(folder.path(), &Model { terms: vec![truth] })?;
        answer.true_gain = given.gain["log_score_rise"].as_f64();
        answer.true_ln_p = given.causes.first().map(|cause| cause.ln_p);
    }
    Ok(answer)
}

/// Makes a trial in a temporary folder, and asks the program.
///
/// # Errors
/// [`Trouble`] if the trial cannot be made or the program not be asked.
pub(crate) fn answered(trial: &Trial, analyser: &Analyser) -> Result<(TempDir, Answer), Trouble> {
    let folder = tempfile::tempdir()?;
    write(folder.path(), &record(&trial.experiment), &trial.known, trial.experiment.interval)?;
    let answer = analyser.ask(folder.path())?;
    Ok((folder, answer))
}

impl Trial {
    /// Whether there is more in the run than what is hidden, as there is with every table that is real.
    fn has_an_imperfect_table(&self) -> bool {
        self.present.iter().any(|id| catalogue::term(id).is_some_and(Term::is_signal))
    }
}

impl Hidden {
    /// It as a model that knows what is there and not how large it is.
    fn as_term(&self) -> Option<TermInstance> {
        let mut chosen = TermInstance::new(catalogue::term(&self.id)?).estimated();
        chosen.settings.clone_from(&self.settings);
        Some(chosen)
    }
}

/// Runs what a plan holds and `journal` does not, each record appended when it is there.
///
/// # Errors
/// The first [`Trouble`] of any trial; those that were finished are in the journal.
pub fn run(
    plan: &Plan,
    analyser: &Analyser,
    journal: &Path,
    told: impl Fn(&Record) + Sync,
) -> Result<(), Trouble> {
    let before = records(journal)?;
    mend(journal, &before)?;
    let done: BTreeSet<u64> =
        before.iter().filter(|r| r.seed == plan.seed && !r.timed).map(|r| r.index).collect();
    let left = (0..plan.trials as u64).filter(|&index| plan.has(index) && !done.contains(&index));
    let left: Vec<u64> = left.collect();
    let file = Mutex::new(OpenOptions::new().create(true).append(true).open(journal)?);
    at_once(plan.threads, &left, |&index| {
        let trial = match plan.population {
            Population::Blind => Trial::draw(plan.seed, index, Length::Drawn)?,
            Population::Null => Trial::null(plan.seed, index),
        };
        let record = Record::of(trial, (plan.seed, index, false), analyser)?;
        let line = serde_json::to_string(&record)? + "\n";
        let mut file = file.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        file.write_all(line.as_bytes())?;
        drop(file);
        told(&record);
        Ok(())
    })
}

/// Joins the journals of shards into a journal in the order of trials.
///
/// A card depends on the trials, not on their order: that of the merged journal is that of a journal without shards.
///
/// # Errors
/// [`Trouble`] if a journal cannot be read, if trials of different seeds are among them, if one is there twice or missing, or if
/// the merged journal cannot be written.
pub fn merge(journals: &[&Path], merged: &Path) -> Result<(), Trouble> {
    let mut all = Vec::new();
    for journal in journals {
        // A journal that does not exist has no records; here it is an error.
        fs::metadata(journal)?;
        all.extend(records(journal)?);
    }
    all.sort_by_key(|record| record.index);
    let seed = all.first().map_or(0, |record| record.seed);
    for (expected, record) in (0..).zip(&all) {
        if record.seed != seed || record.timed {
            return Err(Trouble::Foreign {
                index: record.index,
                seed: record.seed,
                expected: seed,
            });
        }
        if record.index != expected {
            return Err(Trouble::Trials { index: record.index, expected });
        }
    }
    Ok(fs::write(merged, lines(&all)?)?)
}

/// Records as the lines of a journal.
fn lines(records: &[Record]) -> Result<String, Trouble> {
    let mut text = String::new();
    for record in records {
        text.push_str(&serde_json::to_string(record)?);
        text.push('\n');
    }
    Ok(text)
}

/// Runs so many trials of the longest kind, one after the other, to see how long they take.
///
/// # Errors
/// The first [`Trouble`] of any trial.
pub fn time(
    seed: u64,
    trials: u64,
    analyser: &Analyser,
    journal: &Path,
    told: impl Fn(&Record),
) -> Result<(), Trouble> {
    mend(journal, &records(journal)?)?;
    let mut file = OpenOptions::new().create(true).append(true).open(journal)?;
    for index in 0..trials {
        let trial = Trial::draw(seed, index, Length::Longest)?;
        let record = Record::of(trial, (seed, index, true), analyser)?;
        file.write_all((serde_json::to_string(&record)? + "\n").as_bytes())?;
        told(&record);
    }
    Ok(())
}

/// Drops a line that was not finished.
fn mend(journal: &Path, whole: &[Record]) -> Result<(), Trouble> {
    if !journal.exists() {
        return Ok(());
    }
    let text = fs::read_to_string(journal)?;
    if !text.is_empty() && !text.ends_with('\n') {
        fs::write(journal, lines(whole)?)?;
    }
    Ok(())
}

impl Record {
    /// The answer to a trial: the `index`-th under `seed`, and whether it is timed.
    ///
    /// # Errors
    /// [`Trouble`] if its run cannot be made or the program not be asked.
    pub fn of(
        trial: Trial,
        (seed, index, timed): (u64, u64, bool),
        analyser: &Analyser,
    ) -> Result<Self, Trouble> {
        let answer = try_out(&trial, analyser)?;
        Ok(Self {
            seed,
            index,
            timed,
            kind: trial.kind,
            schedule: trial.schedule,
            level: trial.level,
            grade: trial.grade,
            interval: trial.experiment.interval,
            duration: trial.experiment.drive.duration(),
            hidden: trial.hidden,
            outside: trial.outside,
            present: trial.present,
            answer,
        })
    }
}
