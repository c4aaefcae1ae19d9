//! The rules of CONTRIBUTING.md that rustc and clippy cannot check.

use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::Result;

mod catalogue;
mod crates;
mod cycles;
mod language;
mod references;
mod sources;
mod text;

#[cfg(test)]
mod tests;

/// The crates with cyclic imports between files; no others may be added.
const IN_CIRCLES: &[&str] = &["rins-blind", "rins-diagnosis"];

/// One violation of a rule.
#[derive(Debug)]
struct Finding {
    /// The file, relative to the workspace.
    path: PathBuf,
    /// The line in it, from 1.
    line: usize,
    /// The violation, and the remedy if it is not obvious.
    what: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.path.display(), self.line, self.what)
    }
}

/// Prints every violation, and fails if there is one.
pub(crate) fn run(root: &Path) -> Result<()> {
    let findings = findings(root, &tracked_files(root)?)?;
    for finding in &findings {
        println!("{finding}");
    }
    match findings.len() {
        0 => Ok(()),
        count => Err(format!("{count} breaches of the rules in CONTRIBUTING.md").into()),
    }
}

/// All violations in these files, whose paths are relative to `root`.
fn findings(root: &Path, files: &[PathBuf]) -> Result<Vec<Finding>> {
    let mut findings = text::findings(root, files)?;
    findings.extend(references::findings(root, files)?);
    findings.extend(language::findings(root, files)?);
    findings.extend(crates::findings(root)?);
    findings.extend(cycles::findings(root, IN_CIRCLES)?);
    findings.extend(catalogue::findings(root)?);
    findings.sort_by(|a, b| (&a.path, a.line).cmp(&(&b.path, b.line)));
    Ok(findings)
}

/// The files that git tracks or would track, relative to `root`.
fn tracked_files(root: &Path) -> Result<Vec<PathBuf>> {
    let listed = Command::new("git")
        .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
        .current_dir(root)
        .output()?;
    if !listed.status.success() {
        return Err(format!("git ls-files: {}", String::from_utf8_lossy(&listed.stderr)).into());
    }
    let names = String::from_utf8(listed.stdout)?;
    let files = names.split_terminator('\0').map(PathBuf::from);
    // A file that was deleted but not yet committed is still listed.
    Ok(files.filter(|file| root.join(file).is_file()).collect())
}
