//! What can be wrong with a file, and where in it.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::log::LogProblem;
use crate::output::OutputProblem;
use crate::quantity::{QuantityError, did_you_mean};
use crate::shown::shown;
use crate::write::WriteProblem;

/// Why a file could not be read or written.
///
/// Every variant names the file; what is wrong inside one also names the line and the key or
/// column, the value, and what was expected.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IoError {
    /// The operating system refused.
    #[error("cannot {action} {}", shown(.path))]
    File {
        /// What was tried: "read", "write", …
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A file of keys says something wrong.
    #[error(transparent)]
    Key(#[from] Box<KeyError>),
    /// A log says something wrong.
    #[error(transparent)]
    Log(#[from] Box<LogError>),
    /// A recording cannot be written in a format.
    #[error("{}: {problem}", shown(.path))]
    Write {
        /// The log that was to be written.
        path: PathBuf,
        /// Why it was not.
        problem: WriteProblem,
    },
    /// A result cannot be put where it should go.
    #[error("{}: {problem}", shown(.path))]
    Output {
        /// The file or folder that was to be written.
        path: PathBuf,
        /// Why it was not.
        problem: OutputProblem,
    },
}

impl IoError {
    /// Wraps the operating system's error on `path`.
    pub(crate) fn file(
        action: &'static str,
        path: &Path,
    ) -> impl FnOnce(std::io::Error) -> Self + use<> {
        let path = path.to_path_buf();
        move |source| Self::File { action, path, source }
    }
}

/// A key of a rig, scenario or calibration file, and what is wrong with it.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyError {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1, where there is one to show.
    pub line: Option<usize>,
    /// The section and the key, as in `[imu.gyro] noise`; empty for the whole file.
    pub key: String,
    /// What is wrong.
    pub problem: KeyProblem,
}

impl fmt::Display for KeyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", shown(&self.path))?;
        if let Some(line) = self.line {
            write!(f, "{line}:")?;
        }
        if !self.key.is_empty() {
            write!(f, " {}:", self.key)?;
        }
        write!(f, " {}", self.problem)
    }
}

impl std::error::Error for KeyError {}

/// What is wrong with a key.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum KeyProblem {
    /// The file is not TOML.
    #[error("{message}")]
    Syntax {
        /// What the parser says.
        message: String,
    },
    /// The file is too large to be one of its kind.
    #[error("more than {most} bytes, too large for a file of keys")]
    TooLarge {
        /// The most that is read.
        most: u64,
    },
    /// The key is needed and is not there.
    #[error("missing, expected {expected}")]
    Missing {
        /// What it should be.
        expected: String,
    },
    /// There is no such key.
    #[error("unknown key{}", hint(.suggestion.as_deref(), .known))]
    Unknown {
        /// What may have been meant.
        suggestion: Option<String>,
        /// The keys that there are.
        known: String,
    },
    /// The value is not of the right type.
    #[error("{got}, expected {expected}")]
    WrongType {
        /// What it is.
        got: String,
        /// What it should be.
        expected: String,
    },
    /// The value is not the quantity that the key stands for.
    #[error(transparent)]
    Quantity(#[from] QuantityError),
    /// The value is not one of those that the key may have.
    #[error("{value:?} is not known{}", hint(.suggestion.as_deref(), .known))]
    NotOneOf {
        /// The value.
        value: String,
        /// What may have been meant.
        suggestion: Option<String>,
        /// The values that there are.
        known: String,
    },
    /// The value is of the right type but makes no sense.
    #[error("{value} is not allowed, expected {expected}")]
    NotAllowed {
        /// The value, as written.
        value: String,
        /// What it should be.
        expected: String,
    },
    /// The key does not go with another one.
    #[error("{reason}")]
    Conflict {
        /// Why not.
        reason: String,
    },
}

fn hint(suggestion: Option<&str>, known: &str) -> String {
    match suggestion {
        Some(_) => did_you_mean(suggestion),
        None => format!(", expected one of {known}"),
    }
}

/// A place in a log, and what is wrong there.
#[derive(Clone, Debug, PartialEq)]
pub struct LogError {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1, unless the whole file is meant.
    pub line: Option<u64>,
    /// What is wrong.
    pub problem: LogProblem,
}

impl fmt::Display for LogError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{line}: {}", shown(&self.path), self.problem),
            None => write!(f, "{}: {}", shown(&self.path), self.problem),
        }
    }
}

impl std::error::Error for LogError {}

impl LogError {
    /// This problem at a line of a log, as the crate's error.
    pub(crate) fn at(path: &Path, line: u64, problem: LogProblem) -> IoError {
        Box::new(Self { path: path.into(), line: Some(line), problem }).into()
    }

    /// This problem of a whole log, as the crate's error.
    pub(crate) fn of(path: &Path, problem: LogProblem) -> IoError {
        Box::new(Self { path: path.into(), line: None, problem }).into()
    }
}
