//! A draft of a rig file from a log.

use std::fmt::{self, Write as _};
use std::path::{Path, PathBuf};

use rins_io::{Draft, InputFile, draft_rig, shown};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::basis::BasisResult;
use crate::error::Result;
use crate::outcome::Outcome;

/// A draft of a rig file from a log, with the guessed keys and the keys to be filled in.
#[derive(Debug)]
pub struct DraftedRig {
    log: PathBuf,
    output: Option<PathBuf>,
    draft: Draft,
    basis: BasisResult,
}

/// The result of `rins init`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct InitResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `init`.
    pub command: String,
    /// The rig file that is written, or its text where none is.
    pub rig: String,
    /// What was guessed, to be confirmed.
    pub guesses: Vec<GuessResult>,
    /// What is to be filled in.
    pub to_fill_in: Vec<ToFillInResult>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// A key of the rig file whose value was guessed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GuessResult {
    /// The key.
    pub key: String,
    /// Its value, as it stands in the file.
    pub value: String,
    /// What the guess rests on.
    pub why: String,
}

/// A key of the rig file that is to be filled in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ToFillInResult {
    /// The key.
    pub key: String,
    /// What is expected.
    pub expected: String,
}

/// Drafts a rig file from a log; it is written to `output`, or printed if there is none.
///
/// # Errors
/// If the log cannot be read, or `output` is the log itself.
///
/// ```
/// use rins::Outcome;
/// let folder = tempfile::tempdir()?;
/// let log = folder.path().join("run.csv");
/// std::fs::write(&log, "t,gx,gy,gz\n0.01,1,2,3\n0.02,2,3,4\n0.03,2,3,5\n")?;
/// let drafted = rins::init(&log, None)?;
/// assert!(drafted.result().to_fill_in.iter().any(|key| key.key == "log.accel.columns"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn init(log: &Path, output: Option<&Path>) -> Result<DraftedRig> {
    let folder = output.and_then(Path::parent).unwrap_or(Path::new(""));
    if let Some(output) = output
        && let (Ok(rig), Ok(log)) = (output.canonicalize(), log.canonicalize())
        && rig == log
    {
        let why = format!("{}: is the log itself; choose another name for the rig", shown(output));
        return Err(anyhow::Error::msg(why).into());
    }
    let draft = draft_rig(log, folder)?;
    let basis = BasisResult::of_files([InputFile::of(log)?]);
    Ok(DraftedRig { log: log.into(), output: output.map(Path::to_path_buf), draft, basis })
}

impl DraftedRig {
    /// The text of the rig file.
    pub fn text(&self) -> &str {
        &self.draft.text
    }
}

impl fmt::Display for DraftedRig {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.output {
            Some(output) => f.write_str(&summary(&self.draft, &self.log, output)),
            None => f.write_str(self.text()),
        }
    }
}

impl Outcome for DraftedRig {
    type Result = InitResult;

    fn result(&self) -> InitResult {
        let Draft { text, guesses, to_fill_in } = &self.draft;
        let guesses = guesses.iter().map(|guess| GuessResult {
            key: guess.key.clone(),
            value: guess.value.clone(),
            why: guess.why.clone(),
        });
        let to_fill_in = to_fill_in
            .iter()
            .map(|key| ToFillInResult { key: key.key.clone(), expected: key.expected.clone() });
        InitResult {
            schema: crate::SCHEMA,
            command: "init".into(),
            rig: self.output.as_deref().map_or_else(|| text.clone(), shown),
            guesses: guesses.collect(),
            to_fill_in: to_fill_in.collect(),
            basis: self.basis.clone(),
        }
    }

    fn basis(&self) -> BasisResult {
        self.basis.clone()
    }
}

/// The remaining steps, as text for a terminal.
fn summary(draft: &Draft, log: &Path, rig: &Path) -> String {
    let mut text = format!("Draft of a rig for {}\n", shown(log));
    if !draft.guesses.is_empty() {
        text.push_str("\n  guesses to confirm\n");
    }
    for guess in &draft.guesses {
        let _ = writeln!(text, "    {} = {}  ({})", guess.key, guess.value, guess.why);
    }
    if !draft.to_fill_in.is_empty() {
        text.push_str("\n  to fill in\n");
    }
    for key in &draft.to_fill_in {
        let _ = writeln!(text, "    {}  ({})", key.key, key.expected);
    }
    let _ = writeln!(text, "\n  then: rins check {}", shown(rig));
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOG: &str = "t,gx,gy,gz\n0.01,1,2,3\n0.02,2,3,4\n0.03,2,3,5\n";

    fn log(folder: &Path) -> PathBuf {
        let log = folder.join("run.csv");
        std::fs::write(&log, LOG).unwrap();
        log
    }

    #[test]
    fn a_log_is_never_replaced_by_its_rig() {
        let folder = tempfile::tempdir().unwrap();
        let log = log(folder.path());
        let error = init(&log, Some(&log)).map(|_| ()).unwrap_err();
        assert!(error.to_string().ends_with("is the log itself; choose another name for the rig"));
    }

    #[test]
    fn without_a_destination_the_draft_is_the_result() {
        let folder = tempfile::tempdir().unwrap();
        let drafted = init(&log(folder.path()), None).unwrap();
        let result = drafted.result();
        assert_eq!(result.rig, drafted.to_string());
        assert_eq!((result.schema, result.command.as_str()), (crate::SCHEMA, "init"));
        let guess = GuessResult {
            key: "log.gyro.columns".into(),
            value: "[\"gx\", \"gy\", \"gz\"]".into(),
            why: "by their names".into(),
        };
        assert!(result.guesses.contains(&guess));
        assert!(result.to_fill_in.iter().any(|key| key.key == "log.accel.columns"));
    }
}
