//! Banned words: texts for users have one standard term for one concept.

use std::path::{Path, PathBuf};

use super::Finding;
use crate::Result;

/// The places that are checked: the texts of the command and the library, and the book.
const PLACES: &[&str] = &[
    "crates/rins/src/",
    "crates/rins-cli/src/",
    "crates/rins-design/src/",
    "docs/src/",
    "README.md",
];

/// Pages that quote the paper, or older results, in their own words.
const QUOTING: &[&str] = &["docs/src/reproduction.md", "docs/src/references.md"];

/// Phrases in lower case, with the standard term.
const BANNED: &[(&str, &str)] = &[
    ("foretell", "predict"),
    ("foretold", "predicted"),
    ("foresight", "predictive score"),
    ("played no part", "held-out"),
    ("plays no part", "held-out"),
    ("odds of chance", "p"),
    ("odds that it is nothing", "p-value"),
    ("exactly invisible", "unobservable"),
    ("told apart", "distinguished, separated"),
    ("tells apart", "distinguishes, separates"),
    ("tell apart", "distinguish, separate"),
    ("cannot be told from", "is not distinguished from"),
    ("what is left unexplained", "residual structure"),
    ("left unexplained", "residual structure"),
    ("would have been seen", "minimum detectable effect"),
    ("could not have been seen", "not testable"),
    ("puts off", "biases"),
    ("least bit", "LSB"),
    ("gives way", "base motion"),
    ("rides along", "augmented state"),
    ("broke off", "failed, diverged"),
    ("measured-looking", "simulated"),
    ("reckon", "compute"),
    ("the sheet", "the data sheet"),
    ("sense of rotation", "direction of rotation"),
    ("table's turn", "table's rotation"),
    ("rests of", "static intervals of"),
    ("longest rest", "longest static interval"),
    ("stands still", "is static"),
    ("jolt", "tilt step"),
    ("quantisation grid", "quantization grid"),
    ("rival", "alternative"),
    ("honest", "consistent"),
];

/// All banned phrases in the tracked files of these places, outside of code.
pub(super) fn findings(root: &Path, files: &[PathBuf]) -> Result<Vec<Finding>> {
    let mut findings = Vec::new();
    for path in files {
        let name = path.to_string_lossy();
        let is_read =
            PLACES.iter().any(|place| name.starts_with(place)) && !QUOTING.contains(&name.as_ref());
        let Some(ending) = path.extension().filter(|_| is_read) else { continue };
        let source = ending == "rs";
        if !source && ending != "md" {
            continue;
        }
        let text = std::fs::read_to_string(root.join(path))?;
        findings.extend(in_text(path, &text, source));
    }
    Ok(findings)
}

fn in_text(path: &Path, text: &str, source: bool) -> Vec<Finding> {
    let mut findings = Vec::new();
    let (mut fenced, mut quoted) = (false, false);
    for (line, text) in (1..).zip(text.lines()) {
        fenced ^= !source && text.trim_start().starts_with("```");
        let said = if source { said(text, &mut quoted) } else { prose(text) };
        let said = said.to_lowercase();
        let banned = BANNED.iter().filter(|(phrase, _)| !fenced && said.contains(phrase));
        findings.extend(banned.map(|(phrase, standard)| Finding {
            path: path.to_path_buf(),
            line,
            what: format!("{phrase:?} is no term of the glossary: {standard}"),
        }));
    }
    findings
}

/// The text of a source line for users: documentation, and string literals, one of which may be continued from the line before.
fn said(line: &str, quoted: &mut bool) -> String {
    let trimmed = line.trim_start();
    if !*quoted && trimmed.starts_with("//") {
        return prose(trimmed);
    }
    let mut said = String::new();
    let line = line.replace("'\"'", "").replace("\\\"", "");
    for (place, part) in line.split('"').enumerate() {
        *quoted ^= place > 0;
        if *quoted {
            said.push_str(part);
            said.push(' ');
        }
    }
    said
}

/// A line without code spans.
fn prose(line: &str) -> String {
    line.split('`').step_by(2).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str, source: bool) -> usize {
        in_text(Path::new("x"), text, source).len()
    }

    #[test]
    fn banned_words_are_found_in_prose_and_literals_only() {
        assert_eq!(found("The odds of chance are small.", false), 1);
        assert_eq!(found("The key `rivals` is gone.", false), 0);
        assert_eq!(found("```\nrival\n```\nfine", false), 0);
        assert_eq!(found("let rivals = rivals(named);", true), 0);
        assert_eq!(found("use a::{\n    Rival, Other,\n};", true), 0);
        assert_eq!(found("push(\"no rival\");", true), 1);
        assert_eq!(
            found("push(\n    \"a long sentence \\\n     on rivals\",\n    rivals,\n);", true),
            1
        );
        assert_eq!(found("/// The honest ones.", true), 1);
    }
}
