//! What can be wrong with a file, and where in it.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::log::LogProblem;
use crate::quantity::{QuantityError, did_you_mean};
use crate::shown::shown;

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

/// Why a result was not put where it should go.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OutputProblem {
    /// Something is there.
    #[error("exists already; choose another name, or --force to replace it")]
    Exists,
    /// Another program has put something there, or taken it away, since the work began.
    #[error("was written by another program in the meantime; choose another name, or try again")]
    Overtaken,
    /// A folder should be replaced that does not look like one of ours.
    #[error("is not replaced, as it does not hold a result of rins; choose another name")]
    NotOurs,
    /// A folder of ours holds something else too.
    #[error("is not replaced, as it also holds {entry:?}; move that away or choose another name")]
    HoldsMore {
        /// The first entry that is not ours.
        entry: String,
    },
    /// A folder should go where a file is, or a file where a folder is.
    #[error("is {found}, expected {expected}")]
    WrongType {
        /// What is there.
        found: &'static str,
        /// What should be.
        expected: &'static str,
    },
    /// It is one of the files that are read.
    #[error("is an input of the same command and is not replaced; choose another name")]
    IsInput,
    /// A folder of ours holds one of the files that are read.
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
    /// A rig file has to name it, and cannot.
    #[error("its name is not UTF-8, so that a rig file cannot state it; choose another")]
    NotText,
}

/// Why a recording cannot be written in a format.
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
        /// How far its time is from where it should be \[s\].
        off: f64,
        /// The interval \[s\].
        interval: f64,
    },
    /// The format cannot say so much.
    #[error("{what} cannot be written in {format}: {why}")]
    TooMuch {
        /// What cannot be written.
        what: &'static str,
        /// The format.
        format: &'static str,
        /// Why not.
        why: &'static str,
    },
    /// The encoder refuses.
    #[error("cannot be written as {format}: {message}")]
    Encoder {
        /// The format.
        format: &'static str,
        /// What it says.
        message: String,
    },
}
