//! The paper's closed forms against numerical integration.

use std::path::Path;

use crate::Result;
use crate::reproduce::program;

/// Prints the grid and fails if a bound is broken.
pub(crate) fn run(root: &Path) -> Result<()> {
    program(root, &["verify"])
}
