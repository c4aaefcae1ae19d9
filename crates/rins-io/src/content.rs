//! What a TOML file is.

use std::path::Path;

use crate::document::Document;
use crate::error::IoError;

/// What a TOML file is, by the keys at its top.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TomlContent {
    /// A calibration: it has a version and errors of the sensors.
    Calibration,
    /// A rig file: it names a log.
    Rig,
    /// Anything else.
    Other,
}

impl TomlContent {
    /// What the file at `path` is.
    ///
    /// # Errors
    /// [`IoError`] if it cannot be read, or is not TOML.
    pub fn of(path: &Path) -> Result<Self, IoError> {
        let document = Document::read(path)?;
        let has = |key: &str| document.root.iter().any(|entry| entry.key == key);
        Ok(if has("log") {
            Self::Rig
        } else if has("schema") && (has("gyro") || has("accel")) {
            Self::Calibration
        } else {
            Self::Other
        })
    }
}
