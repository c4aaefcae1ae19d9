//! Asking the program: a folder with a log and a rig file in, its JSON out.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use rins_io::{ModelFile, Overwrite};
use rins_terms::{Model, catalogue};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::trouble::Trouble;

/// How long a diagnosis may take before it counts as hung.
const PATIENCE: Duration = Duration::from_secs(300);

/// What the program said of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Its verdict; empty if it gave none.
    pub verdict: String,
    /// What it named, in its order.
    pub causes: Vec<Named>,
    /// The channels on which it found what it could not name, with what it looks like.
    pub unexplained: Vec<String>,
    /// The gain that it measured, as it gave it.
    pub gain: Value,
    /// By how much the log score rises with the effect that is there \[nats\], if it was asked.
    #[serde(default)]
    pub true_gain: Option<f64>,
    /// The logarithm of the family-wise p-value of the effect that is there, if it was asked.
    #[serde(default)]
    pub true_ln_p: Option<f64>,
    /// How long it took \[s\].
    pub seconds: f64,
    /// What it said when it failed.
    pub failure: Option<String>,
}

/// An effect that was named.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Named {
    /// Its id.
    pub effect: String,
    /// The others that it could not be told from.
    pub cannot_tell_from: Vec<String>,
    /// The logarithm of its family-wise probability.
    pub ln_p: f64,
    /// Its posterior probability among these, if it was stated.
    #[serde(default)]
    pub probability: Option<f64>,
    /// Its amplitudes: the parameter's name, its value and 1σ in SI units.
    pub parameters: Vec<(String, f64, f64)>,
    /// Its settings.
    pub settings: Value,
}

impl Named {
    /// The effects that it may be.
    pub fn set(&self) -> impl Iterator<Item = &str> {
        std::iter::once(self.effect.as_str())
            .chain(self.cannot_tell_from.iter().map(String::as_str))
    }

    /// Whether it may be this effect.
    pub fn may_be(&self, id: &str) -> bool {
        self.set().any(|other| other == id)
    }
}

/// The program that is tried.
#[derive(Clone, Debug)]
pub struct Analyser {
    /// Where it is.
    pub program: PathBuf,
    /// How many threads it may use.
    pub threads: usize,
    /// Further arguments of `diagnose`.
    pub arguments: Vec<String>,
}

impl Analyser {
    /// The program at this path, on so many threads.
    pub fn new(program: impl Into<PathBuf>, threads: usize) -> Self {
        Self { program: program.into(), threads, arguments: Vec::new() }
    }

    /// The same with these arguments of `diagnose`.
    #[must_use]
    pub fn with(mut self, arguments: &[&str]) -> Self {
        self.arguments.extend(arguments.iter().map(|one| (*one).to_owned()));
        self
    }

    /// What it says of the run in `folder`.
    ///
    /// # Errors
    /// [`Trouble`] if it cannot be started, or what it prints cannot be kept.
    pub fn ask(&self, folder: &Path) -> Result<Answer, Trouble> {
        self.asked(folder, &[])
    }

    /// What it says of the run in `folder` when it is given these effects.
    ///
    /// # Errors
    /// As [`ask`](Self::ask).
    pub fn ask_given(&self, folder: &Path, effects: &Model) -> Result<Answer, Trouble> {
        const FILE: &str = "hypothesis.toml";
        ModelFile::of(effects.clone()).write(&folder.join(FILE), Overwrite::Refuse)?;
        self.asked(folder, &["--hypothesis", FILE])
    }

    fn asked(&self, folder: &Path, more: &[&str]) -> Result<Answer, Trouble> {
        let (out, errors) = (folder.join("answer.json"), folder.join("errors.txt"));
        let started = Instant::now();
        let mut child = Command::new(&self.program)
            .args(["diagnose", "rig.toml", "--json"])
            .args(&self.arguments)
            .args(more)
            .current_dir(folder)
            .env("RAYON_NUM_THREADS", self.threads.to_string())
            .stdin(Stdio::null())
            .stdout(File::create(&out)?)
            .stderr(File::create(&errors)?)
            .spawn()?;
        let status = loop {
            if let Some(status) = child.try_wait()? {
                break Some(status);
            }
            if started.elapsed() > PATIENCE {
                child.kill()?;
                child.wait()?;
                break None;
            }
            sleep(Duration::from_millis(20));
        };
        let seconds = started.elapsed().as_secs_f64();
        let said = std::fs::read_to_string(&out)?;
        let complaint = std::fs::read_to_string(&errors)?;
        let mut answer = match serde_json::from_str::<Value>(&said) {
            Ok(value) => read(&value),
            Err(_) => Answer::default(),
        };
        answer.seconds = seconds;
        answer.failure = match status {
            None => Some(format!("it did not end within {} s", PATIENCE.as_secs())),
            Some(status) if !status.success() => Some(format!("{status}: {}", complaint.trim())),
            Some(_) if answer.verdict.is_empty() => Some("it gave no verdict".into()),
            Some(_) => None,
        };
        Ok(answer)
    }
}

/// What a result says, as far as it is scored.
fn read(result: &Value) -> Answer {
    let list = |value: &Value, key: &str| value[key].as_array().cloned().unwrap_or_default();
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let cause = |cause: &Value| {
        let effect = text(&cause["effect"]);
        let parameters = list(cause, "parameters")
            .iter()
            .filter_map(|parameter| {
                let id = parameter["id"].as_str()?;
                let name = id.rsplit_once('.')?.1;
                let term = catalogue::term(&effect)?;
                let unit = term.parameters.iter().find(|p| p.name == name)?.unit;
                let si = |key: &str| number(&parameter[key]) * unit.factor;
                Some((name.to_owned(), si("value"), si("sigma")))
            })
            .collect();
        Named {
            cannot_tell_from: list(cause, "cannot_tell_from").iter().map(text).collect(),
            ln_p: cause["ln_p"].as_f64().unwrap_or_else(|| number(&cause["p_value"]).ln()),
            probability: cause["probability"].as_f64(),
            parameters,
            settings: cause["settings"].clone(),
            effect,
        }
    };
    let unexplained =
        |one: &Value| format!("{}: {}", text(&one["channel"]), text(&one["structure"]));
    Answer {
        verdict: text(&result["verdict"]),
        causes: list(result, "causes").iter().map(cause).collect(),
        unexplained: list(result, "unexplained").iter().map(unexplained).collect(),
        gain: result["gain"].clone(),
        true_gain: None,
        true_ln_p: None,
        seconds: 0.0,
        failure: None,
    }
}
