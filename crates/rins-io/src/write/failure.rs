//! Errors of writing a log.

use crate::error::WriteProblem;

/// The error of writing a log, before the file name is added.
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
