//! `rins init`: drafts a rig file from a log.

use std::fmt::Write as _;
use std::path::Path;

use rins_io::{Draft, draft_rig};
use serde_json::{Value, json};

use crate::args::Init;
use crate::outcome::Outcome;
use rins_io::shown;

pub(crate) fn run(arguments: &Init) -> anyhow::Result<Outcome> {
    let Init { log, output } = arguments;
    let folder = output.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
    if let Some(output) = output
        && let (Ok(rig), Ok(log)) = (output.canonicalize(), log.canonicalize())
        && rig == log
    {
        anyhow::bail!("{}: is the log itself; choose another name for the rig", shown(output));
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

#[cfg(test)]
mod tests {
    use super::*;
    use rins_io::Overwrite;

    const LOG: &str = "t,gx,gy,gz\n0.01,1,2,3\n0.02,2,3,4\n0.03,2,3,5\n";

    fn arguments(folder: &Path, output: Option<&str>) -> Init {
        let log = folder.join("run.csv");
        std::fs::write(&log, LOG).unwrap();
        Init { log, output: output.map(|name| folder.join(name)) }
    }

    #[test]
    fn a_draft_replaces_a_rig_only_if_forced() {
        let folder = tempfile::tempdir().unwrap();
        let arguments = arguments(folder.path(), Some("rig.toml"));
        let rig = arguments.output.as_deref();
        let place = folder.path().join("rig.toml");
        std::fs::write(&place, "mine").unwrap();
        let outcome = run(&arguments).unwrap();
        let error = outcome.write(rig, Overwrite::Refuse).unwrap_err().to_string();
        assert!(error.ends_with("exists already; choose another name, or --force to replace it"));
        assert_eq!(std::fs::read_to_string(&place).unwrap(), "mine");
        outcome.write(rig, Overwrite::Force).unwrap();
        let text = std::fs::read_to_string(&place).unwrap();
        assert!(text.contains("path = \"run.csv\"\n"), "{text}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn a_log_is_never_replaced_by_its_rig() {
        let folder = tempfile::tempdir().unwrap();
        let error = run(&arguments(folder.path(), Some("run.csv"))).map(|_| ()).unwrap_err();
        assert!(error.to_string().ends_with("is the log itself; choose another name for the rig"));
    }

    #[test]
    fn without_a_destination_the_draft_is_the_result() {
        let folder = tempfile::tempdir().unwrap();
        let outcome = run(&arguments(folder.path(), None)).unwrap();
        assert_eq!(outcome.json["rig"].as_str(), Some(outcome.text.as_str()));
        assert_eq!(
            (&outcome.json["schema"], &outcome.json["command"]),
            (&json!(1), &json!("init"))
        );
        let why = "by their names";
        let guess =
            json!({"key": "log.gyro.columns", "value": "[\"gx\", \"gy\", \"gz\"]", "why": why});
        assert!(outcome.json["guesses"].as_array().unwrap().contains(&guess));
        let open = outcome.json["to_fill_in"].as_array().unwrap();
        assert!(open.iter().any(|key| key["key"] == "log.accel.columns"));
    }
}
