//! The error of a job.

use std::fmt;

/// The error of a job: what is wrong, where, the value found and the value expected.
///
/// Its [`Display`](fmt::Display) is the whole chain of causes, in one line.
pub struct Error(anyhow::Error);

/// The result of a job.
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#}", self.0)
    }
}

// A program that returns it from `main` prints what the command prints.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

// `Display` prints the whole chain: with a `source`, the causes would appear twice.
impl std::error::Error for Error {}

impl From<anyhow::Error> for Error {
    fn from(error: anyhow::Error) -> Self {
        Self(error)
    }
}

impl From<rins_io::IoError> for Error {
    fn from(error: rins_io::IoError) -> Self {
        Self(error.into())
    }
}
