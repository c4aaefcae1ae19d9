//! `rins init`: drafts a rig file from a log.

use std::fmt::Write as _;
use std::path::Path;

use rins_io::{Draft, draft_rig};
use serde_json::{Value, json};

use crate::args::Init;
use crate::commands::setup::shown;
use crate::outcome::Outcome;

pub(crate) fn run(arguments: &Init) -> anyhow::Result<Outcome> {
    let Init { log, output } = arguments;
    let folder = output.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
    if let Some(output) = output
        && let (Ok(rig), Ok(log)) = (output.canonicalize(), log.canonicalize())
        && rig == log
    {
        anyhow::bail!("{}: is the log itself; choose another name for the rig", output.display());
    }
    let draft = draft_rig(log, folder)?;
    let json = json(&draft, output.as_deref());
    Ok(match output {
        Some(output) => {
            let text = summary(&draft, log, output);
            Outcome { json, text, file: Some(draft.text), ..Outcome::default() }
        }
        None => Outcome { json, text: draft.text, ..Outcome::default() },
    })
}

/// What is left to do, for a terminal.
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

fn json(draft: &Draft, output: Option<&Path>) -> Value {
    let guesses: Vec<Value> = draft
        .guesses
        .iter()
        .map(|guess| json!({"key": guess.key, "value": guess.value, "why": guess.why}))
        .collect();
    let to_fill_in: Vec<Value> = draft
        .to_fill_in
        .iter()
        .map(|key| json!({"key": key.key, "expected": key.expected}))
        .collect();
    json!({
        "schema": 1,
        "command": "init",
        "rig": output.map_or_else(|| draft.text.clone(), shown),
        "guesses": guesses,
        "to_fill_in": to_fill_in,
    })
}
