//! The error of a job.

use std::fmt;
use std::path::Path;

use rins_calibration::CalibrationError;
use rins_diagnosis::DiagnosisError;
use rins_estimation::{FitError, Indefinite};
use rins_io::IoError;

/// The error of a job: what is wrong, where, the value found and the value expected.
///
/// Its [`Display`](fmt::Display) is the whole chain of causes, in one line.
///
/// ```
/// let error = rins::Log::open("no-such-rig.toml").unwrap_err();
/// assert_eq!(error.file(), Some("no-such-rig.toml".as_ref()));
/// assert_eq!((error.line(), error.key()), (None, None));
/// ```
pub struct Error(anyhow::Error);

/// The result of a job.
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// The file with the error, if it is in a file.
    pub fn file(&self) -> Option<&Path> {
        self.io().map(IoError::path)
    }

    /// The line of the error in its file, from 1, if it has one.
    pub fn line(&self) -> Option<u64> {
        self.io().and_then(IoError::line)
    }

    /// The section and key, as in `[imu.gyro] noise`, or the column of a log, if the error is of one.
    pub fn key(&self) -> Option<&str> {
        self.io().and_then(IoError::key)
    }

    /// Whether the data were read and the model cannot be estimated from them.
    pub fn is_of_model(&self) -> bool {
        self.0.chain().any(|cause| {
            cause.is::<FitError>()
                || cause.is::<Indefinite>()
                || cause.is::<DiagnosisError>()
                || cause.is::<CalibrationError>()
        })
    }

    fn io(&self) -> Option<&IoError> {
        self.0.chain().find_map(|cause| cause.downcast_ref())
    }
}

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

impl From<IoError> for Error {
    fn from(error: IoError) -> Self {
        Self(error.into())
    }
}
