//! Errors of files, and their places.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::log::LogProblem;
use crate::quantity::{QuantityError, did_you_mean};
use crate::shown::shown;

/// The error of reading or writing a file.
///
/// Every variant names the file; an error in the content also names the line and the key or
/// column, the value found, and the value expected.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IoError {
    /// The operating system reported an error.
    #[error("cannot {action} {}", shown(.path))]
    File {
        /// The failed action: "read", "write", …
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// A TOML file has an invalid key or value.
    #[error(transparent)]
    Key(#[from] Box<KeyError>),
    /// A log has invalid content.
    #[error(transparent)]
    Log(#[from] Box<LogError>),
    /// A recording cannot be written in a format.
    #[error("{}: {problem}", shown(.path))]
    Write {
        /// The log that was to be written.
        path: PathBuf,
        /// The reason.
        problem: WriteProblem,
    },
    /// A result cannot be written to its destination.
    #[error("{}: {problem}", shown(.path))]
    Output {
        /// The file or folder to be written.
        path: PathBuf,
        /// The reason.
        problem: OutputProblem,
    },
}

impl IoError {
    /// The file with the error.
    pub fn path(&self) -> &Path {
        match self {
            Self::Key(error) => &error.path,
            Self::Log(error) => &error.path,
            Self::File { path, .. } | Self::Write { path, .. } | Self::Output { path, .. } => path,
        }
    }

    /// The line of the error, from 1, if it has one.
    pub fn line(&self) -> Option<u64> {
        match self {
            Self::Key(error) => error.line.map(|line| line as u64),
            Self::Log(error) => error.line,
            Self::File { .. } | Self::Write { .. } | Self::Output { .. } => None,
        }
    }

    /// The section and key of a file of keys, as in `[imu.gyro] noise`, or the column of a log, if the error is of one.
    pub fn key(&self) -> Option<&str> {
        match self {
            Self::Key(error) => Some(error.key.as_str()).filter(|key| !key.is_empty()),
            Self::Log(error) => column_of(&error.problem),
            Self::File { .. } | Self::Write { .. } | Self::Output { .. } => None,
        }
    }

    /// Wraps the operating system's error on `path`.
    pub(crate) fn file(
        action: &'static str,
        path: &Path,
    ) -> impl FnOnce(std::io::Error) -> Self + use<> {
        let path = path.to_path_buf();
        move |source| Self::File { action, path, source }
    }
}

/// The column of a log with a problem, if it is of one column.
fn column_of(problem: &LogProblem) -> Option<&str> {
    match problem {
        LogProblem::NoColumn { column, .. }
        | LogProblem::TwoColumns { column }
        | LogProblem::EmptyField { column }
        | LogProblem::NotANumber { column, .. }
        | LogProblem::NotADate { column, .. }
        | LogProblem::NotWhole { column, .. }
        | LogProblem::BeyondPart { column, .. }
        | LogProblem::NotFinite { column, .. }
        | LogProblem::BeyondReason { column, .. }
        | LogProblem::NoSuchRows { column, .. }
        | LogProblem::PartOfASample { column, .. }
        | LogProblem::WrongColumn { column, .. } => Some(column),
        LogProblem::ManyDamaged { first, .. } => column_of(first),
        _ => None,
    }
}

/// A key of a rig, scenario or calibration file, and its problem.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyError {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1, if the problem has one.
    pub line: Option<usize>,
    /// The section and the key, as in `[imu.gyro] noise`; empty for the whole file.
    pub key: String,
    /// The problem.
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

/// The problem of a key.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum KeyProblem {
    /// The file is not TOML.
    #[error("{message}")]
    Syntax {
        /// The message of the parser.
        message: String,
    },
    /// The file is larger than any file of its kind.
    #[error("more than {most} bytes, too large for a file of keys")]
    TooLarge {
        /// The maximum size.
        most: u64,
    },
    /// A required key is missing.
    #[error("missing, expected {expected}")]
    Missing {
        /// The expected value.
        expected: String,
    },
    /// The key is unknown.
    #[error("unknown key{}", hint(.suggestion.as_deref(), .known))]
    Unknown {
        /// The most similar known key.
        suggestion: Option<String>,
        /// The known keys.
        known: String,
    },
    /// The value is not of the right type.
    #[error("{got}, expected {expected}")]
    WrongType {
        /// The actual type.
        got: String,
        /// The expected value.
        expected: String,
    },
    /// The value is not a quantity of the kind of the key.
    #[error(transparent)]
    Quantity(#[from] QuantityError),
    /// The value is not one of the permitted values of the key.
    #[error("{value:?} is not known{}", hint(.suggestion.as_deref(), .known))]
    NotOneOf {
        /// The value.
        value: String,
        /// The most similar permitted value.
        suggestion: Option<String>,
        /// The permitted values.
        known: String,
    },
    /// The value has the right type but is not permitted.
    #[error("{value} is not allowed, expected {expected}")]
    NotAllowed {
        /// The value, as written in the file.
        value: String,
        /// The expected value.
        expected: String,
    },
    /// The key conflicts with another one.
    #[error("{reason}")]
    Conflict {
        /// The reason.
        reason: String,
    },
}

fn hint(suggestion: Option<&str>, known: &str) -> String {
    match suggestion {
        Some(_) => did_you_mean(suggestion),
        None => format!(", expected one of {known}"),
    }
}

/// A line of a log, and its problem.
#[derive(Clone, Debug, PartialEq)]
pub struct LogError {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1; `None` if the problem is of the whole file.
    pub line: Option<u64>,
    /// The problem.
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

/// The reason why a result was not written to its destination.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OutputProblem {
    /// The destination exists.
    #[error("exists already; choose another name, or --force to replace it")]
    Exists,
    /// Another program has created or removed the destination during the work.
    #[error("was written by another program in the meantime; choose another name, or try again")]
    Overtaken,
    /// The folder to be replaced does not look like a folder of rins results.
    #[error("is not replaced, as it does not hold a result of rins; choose another name")]
    NotOurs,
    /// The folder of rins results contains another file too.
    #[error("is not replaced, as it also holds {entry:?}; move that away or choose another name")]
    HoldsMore {
        /// The first entry that is not a rins result.
        entry: String,
    },
    /// The destination of a folder is a file, or that of a file is a folder.
    #[error("is {found}, expected {expected}")]
    WrongType {
        /// The existing type.
        found: &'static str,
        /// The expected type.
        expected: &'static str,
    },
    /// The destination is one of the input files.
    #[error("is an input of the same command and is not replaced; choose another name")]
    IsInput,
    /// The folder of rins results contains one of the input files.
    #[error(
        "is not replaced, as it holds {entry:?}, an input of the same command; choose another name"
    )]
    HoldsInput {
        /// The input.
        entry: String,
    },
    /// The path does not end in a name.
    #[error("does not end in the name of a file or folder")]
    NoName,
    /// A rig file must contain the path, which is not UTF-8.
    #[error("its name is not UTF-8, so that a rig file cannot state it; choose another")]
    NotText,
}

/// The reason why a recording cannot be written in a format.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WriteProblem {
    /// The format has no time column.
    #[error(
        "a psins log has no time column, and sample {sample} is {off:e} s away from equal steps of \
         {interval} s; choose another format"
    )]
    Uneven {
        /// The sample, from 1.
        sample: usize,
        /// The difference between its time and the even time step \[s\].
        off: f64,
        /// The interval \[s\].
        interval: f64,
    },
    /// The format cannot represent the recording.
    #[error("{what} cannot be written in {format}: {why}")]
    TooMuch {
        /// The part that cannot be written.
        what: &'static str,
        /// The format.
        format: &'static str,
        /// The reason.
        why: &'static str,
    },
    /// The encoder reported an error.
    #[error("cannot be written as {format}: {message}")]
    Encoder {
        /// The format.
        format: &'static str,
        /// The message of the encoder.
        message: String,
    },
}
