//! Checks that all citations in the sources, keys in angle quotes, are in the list of references.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::Finding;
use crate::Result;

/// The list, whose headings are the keys.
const LIST: &str = "docs/src/references.md";

/// All citations in these files, whose paths are relative to `root`, that are not in the list.
pub(super) fn findings(root: &Path, files: &[PathBuf]) -> Result<Vec<Finding>> {
    // A workspace without a list has no keys.
    let list = fs::read_to_string(root.join(LIST)).unwrap_or_default();
    let keys: BTreeSet<&str> = list.lines().filter_map(|line| line.strip_prefix("## ")).collect();
    let mut findings = Vec::new();
    for path in files.iter().filter(|path| path.extension().is_some_and(|e| e == "rs")) {
        let text = fs::read_to_string(root.join(path))?;
        for (number, line) in (1..).zip(text.lines()) {
            findings.extend(citations(line).filter(|cited| !keys.contains(cited)).map(|cited| {
                let what = format!("‹{cited}› is not in {LIST}");
                Finding { path: path.clone(), line: number, what }
            }));
        }
    }
    Ok(findings)
}

/// The keys cited on a line, if it is a comment.
fn citations(line: &str) -> impl Iterator<Item = &str> {
    let comment = if line.trim_start().starts_with("//") { line } else { "" };
    comment.split('‹').skip(1).filter_map(|rest| Some(rest.split_once('›')?.0))
}
