//! Rules about the text of a file: its length, its first line, and forbidden words.

use std::fs;
use std::path::{Path, PathBuf};

use super::Finding;
use crate::Result;

/// The length above which a file usually has two concepts.
const MAX_LINES: usize = 400;

/// Third-party files, and initial inputs of a fuzzer, which are kept unchanged.
const VENDORED: &[&str] = &["crates/rins-report/assets", "docs/katex", "fuzz/corpus"];

/// Names that state no concept.
const EMPTY_NAMES: &[&str] = &["utils", "util", "common", "helpers", "misc"];

/// Marks of postponed work: each needs the number of its issue, as in `(#12)`.
///
/// They are split in two halves so that this file does not contain them.
pub(super) const POSTPONED: &[&str] =
    &[concat!("TO", "DO"), concat!("FIX", "ME"), concat!("XX", "X")];

/// Words that are always wrong, with the reason.
pub(super) const FORBIDDEN: &[(&str, &str)] = &[
    (concat!("lorem", " ipsum"), "a placeholder"),
    (concat!("<<<<", "<<< "), "a merge conflict"),
    (concat!(">>>>", ">>> "), "a merge conflict"),
    (concat!("/ho", "me/"), "a path of one machine"),
    (concat!("/Us", "ers/"), "a path of one machine"),
    (concat!("/ro", "ot/"), "a path of one machine"),
    (concat!("/wo", "rk/"), "a path of one machine"),
];

/// All violations in these files, whose paths are relative to `root`.
pub(super) fn findings(root: &Path, files: &[PathBuf]) -> Result<Vec<Finding>> {
    let mut findings = Vec::new();
    for path in files {
        if VENDORED.iter().any(|folder| path.starts_with(folder)) || is(path, "lock") {
            continue;
        }
        // A file that is not text has no lines to check.
        let Ok(text) = String::from_utf8(fs::read(root.join(path))?) else { continue };
        let breaches = source(path, &text)
            .into_iter()
            .chain(lines(path, &text))
            .map(|(line, what)| Finding { path: path.clone(), line, what });
        findings.extend(breaches);
    }
    Ok(findings)
}

/// The violations of a Rust file as a whole.
fn source(path: &Path, text: &str) -> Vec<(usize, String)> {
    let mut breaches = Vec::new();
    if !is(path, "rs") {
        return breaches;
    }
    let count = text.lines().count();
    if count > MAX_LINES {
        breaches.push((MAX_LINES + 1, format!("{count} lines, more than {MAX_LINES}: two ideas?")));
    }
    if !text.starts_with("//! ") {
        breaches.push((1, "no `//!` line that says what the file is for".into()));
    }
    let parts = path.iter().filter_map(|part| part.to_str());
    for part in parts.map(|part| part.trim_end_matches(".rs")) {
        if EMPTY_NAMES.contains(&part) {
            breaches.push((1, format!("`{part}` names nothing: name the idea")));
        }
    }
    breaches
}

/// The violations in single lines of any text.
fn lines(path: &Path, text: &str) -> Vec<(usize, String)> {
    let mut breaches = Vec::new();
    // A log may have tabs between its columns.
    let may_have_tabs = ["csv", "tsv", "txt"].iter().any(|ending| is(path, ending));
    for (number, line) in (1..).zip(text.lines()) {
        if line.contains('\t') && !may_have_tabs {
            breaches.push((number, "a tab: indent with spaces".into()));
        }
        for mark in POSTPONED.iter().filter(|mark| is_postponed_without_issue(line, mark)) {
            breaches.push((number, format!("`{mark}` without its issue, as in `{mark}(#12)`")));
        }
        for (word, why) in FORBIDDEN {
            if position_of_word(line, word).is_some() {
                breaches.push((number, format!("`{}`: {why}", word.trim())));
            }
        }
        if is(path, "rs") && is_banner(line) {
            breaches.push((number, "a banner: a file that needs one is two files".into()));
        }
    }
    breaches
}

fn is(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|found| found == ending)
}

/// The position of `word` in `line`, except at the end of a longer word or path.
fn position_of_word(line: &str, word: &str) -> Option<usize> {
    let mut found = line.match_indices(word);
    found.find_map(|(at, _)| {
        let before = line[..at].chars().next_back();
        before.is_none_or(|c| !c.is_alphanumeric() && !"._-".contains(c)).then_some(at)
    })
}

fn is_postponed_without_issue(line: &str, mark: &str) -> bool {
    position_of_word(line, mark).is_some_and(|at| {
        let rest = &line[at + mark.len()..];
        let whole_word = !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_');
        let issue = rest.strip_prefix("(#").and_then(|rest| rest.split_once(')'));
        let numbered = issue.is_some_and(|(number, _)| number.parse::<u32>().is_ok());
        whole_word && !numbered
    })
}

fn is_banner(line: &str) -> bool {
    let comment = line.trim_start().strip_prefix("//");
    comment.is_some_and(|rest| {
        ["----", "====", "****", "####", "////"].iter().any(|rule| rest.contains(rule))
    })
}
