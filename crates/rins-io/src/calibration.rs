//! Calibration files: what an IMU gets wrong, to be undone in other runs.

use std::path::{Path, PathBuf};

use rins_imu::{Compensation, ImuError, TriadError};

use crate::document::Document;
use crate::error::{IoError, KeyError, KeyProblem};
use crate::output::{Overwrite, write_file};
use crate::parameter::{self, LeftOut};
use crate::section::Section;

/// The version of the format that this crate writes, and the only one that it reads.
const SCHEMA: u64 = 1;

/// What every calibration file begins with.
const MEANING: &str = "\
# Errors of an inertial measurement unit, along body axes whose z is the spin axis.
#
#   measured    = true + bias + [S, M] true
#   compensated = (I + [S, M])^-1 (measured - bias)
#
# S: scale errors, on the diagonal. M: misalignments, off it, named by row and column:
# gyro.misalignment.xz is what gyro x sees of a rate about z.
";

/// The errors of an IMU and how well they are known, as a calibration file holds them.
///
/// ```
/// # use std::path::Path;
/// use rins_imu::{Axis, ImuError, TriadError};
/// use rins_io::Calibration;
///
/// let gyro = TriadError::default().with_bias(Axis::X, 1e-6);
/// let calibration = Calibration::of(ImuError { gyro, ..ImuError::default() });
/// let text = calibration.to_toml();
/// let again = Calibration::parse(&text, Path::new("calibration.toml"))?;
/// assert!((again.error.gyro.bias.x - 1e-6).abs() < 1e-21);
/// # Ok::<(), rins_io::IoError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// The file it comes from; empty if none.
    pub path: PathBuf,
    /// The errors.
    pub error: ImuError,
    /// The standard deviation of each number of the errors, in the same place.
    pub sigma: Option<ImuError>,
}

impl Calibration {
    /// A calibration without standard deviations.
    pub fn of(error: ImuError) -> Self {
        Self { path: PathBuf::new(), error, sigma: None }
    }

    /// Reads the calibration file at `path`.
    ///
    /// # Errors
    /// [`IoError::File`] if it cannot be read, [`IoError::Key`] if one of its numbers is missing,
    /// unknown or of the wrong dimension, if the errors cannot be undone, or if it is written in
    /// another version of the format.
    pub fn read(path: &Path) -> Result<Self, IoError> {
        Self::from_document(&Document::read(path)?)
    }

    /// The calibration that `text` holds, as if it stood in the file at `path`.
    ///
    /// # Errors
    /// [`IoError::Key`], as [`Calibration::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, IoError> {
        Self::from_document(&Document::parse(text, path)?)
    }

    fn from_document(document: &Document) -> Result<Self, IoError> {
        let root = Section::root(document, &["schema", "gyro", "accel", "sigma"])?;
        match root.count("schema", "1")? {
            Some(SCHEMA) => {}
            Some(_) => return Err(root.not_allowed("schema", "1")),
            None => return Err(root.missing("schema", "1")),
        }
        let error = both(&root)?;
        let sigma = root.section("sigma", &["gyro", "accel"])?;
        let sigma = match sigma {
            Some(section) => {
                let sigma = both(&section)?;
                let triads = [sigma.gyro, sigma.accel];
                let mut numbers = triads.iter().flat_map(|t| t.bias.iter().chain(t.matrix.iter()));
                if numbers.any(|sigma| *sigma < 0.0) {
                    return Err(root.conflict("sigma", "a standard deviation is negative"));
                }
                Some(sigma)
            }
            None => None,
        };
        let calibration = Self { path: document.path.clone(), error, sigma };
        calibration.compensation()?;
        Ok(calibration)
    }

    /// The inverse of the errors.
    ///
    /// # Errors
    /// [`IoError::Key`] if they cannot be undone.
    pub fn compensation(&self) -> Result<Compensation, IoError> {
        self.error.compensation().map_err(|refusal| {
            let key = match refusal.triad {
                rins_imu::Triad::Gyro => "[gyro]",
                rins_imu::Triad::Accel => "[accel]",
            };
            let problem = KeyProblem::Conflict { reason: refusal.reason.to_string() };
            let (path, key) = (self.path.clone(), key.to_string());
            Box::new(KeyError { path, line: None, key, problem }).into()
        })
    }

    /// The text of the calibration's file.
    pub fn to_toml(&self) -> String {
        let mut text = format!("{MEANING}schema = {SCHEMA}\n");
        let mut push = |header: &str, triad: &TriadError, keys| {
            text.push_str("\n[");
            text.push_str(header);
            text.push_str("]\n");
            text.push_str(&parameter::written(triad, keys));
        };
        push("gyro", &self.error.gyro, &parameter::GYRO);
        push("accel", &self.error.accel, &parameter::ACCEL);
        if let Some(sigma) = &self.sigma {
            push("sigma.gyro", &sigma.gyro, &parameter::GYRO);
            push("sigma.accel", &sigma.accel, &parameter::ACCEL);
        }
        text
    }

    /// Writes the calibration's file, whole or not at all.
    ///
    /// # Errors
    /// As [`write_file`].
    pub fn write(&self, path: &Path, overwrite: Overwrite) -> Result<(), IoError> {
        write_file(path, overwrite, |file| {
            file.write_all(self.to_toml().as_bytes()).map_err(IoError::file("write", path))
        })
    }
}

fn both(section: &Section<'_>) -> Result<ImuError, IoError> {
    let triad = |key: &str, keys| match section.section(key, &parameter::KEYS)? {
        Some(triad) => parameter::read(&triad, keys, LeftOut::Refused),
        None => Err(section.missing(key, "the keys bias, scale and misalignment")),
    };
    let gyro = triad("gyro", &parameter::GYRO)?;
    Ok(ImuError { gyro, accel: triad("accel", &parameter::ACCEL)? })
}
