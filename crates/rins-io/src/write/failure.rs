//! Why writing has failed.

use crate::error::WriteProblem;

/// Why writing has failed, before the file is known.
pub(super) enum Failure {
    System(std::io::Error),
    Problem(WriteProblem),
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        Self::System(error)
    }
}

impl From<WriteProblem> for Failure {
    fn from(problem: WriteProblem) -> Self {
        Self::Problem(problem)
    }
}
