//! The book, built by a separate program so that its dependencies do not slow down the other commands.

use std::path::Path;
use std::process::Command;

use crate::Result;

/// Builds the book into `target/book` and checks it.
pub(crate) fn run(root: &Path) -> Result<()> {
    let status = Command::new("cargo")
        .args(["run", "--quiet", "--profile", "tool"])
        .args(["--package", "xtask", "--features", "book", "--bin", "book"])
        .current_dir(root)
        .status()?;
    if status.success() { Ok(()) } else { Err("the book could not be built".into()) }
}
