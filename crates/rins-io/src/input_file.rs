//! The identity of an input file: its path and the digest of its content.

use std::collections::HashSet;
use std::fmt::Write as _;
use std::io::Read;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::error::IoError;
use crate::inputs;
use crate::rig::{LogFormat, Rig};

/// The size of the portions in which a file is read \[bytes\].
const PORTION: usize = 1 << 16;

/// An input file, identified by its content.
///
/// ```
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("abc");
/// std::fs::write(&path, "abc")?;
/// // FIPS 180-4, example of SHA-256:
/// let file = rins_io::InputFile::of(&path)?;
/// assert_eq!(file.sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputFile {
    /// The path, as it was given.
    pub path: PathBuf,
    /// The SHA-256 of the content, 64 hexadecimal digits (FIPS 180-4).
    pub sha256: String,
}

impl InputFile {
    /// The file at `path`.
    ///
    /// # Errors
    /// [`IoError::File`] if it cannot be read.
    pub fn of(path: &Path) -> Result<Self, IoError> {
        let failed = || IoError::file("read", path);
        let mut file = inputs::open(path).map_err(failed())?;
        let mut digest = Sha256::new();
        let mut portion = vec![0; PORTION];
        loop {
            let length = file.read(&mut portion).map_err(failed())?;
            if length == 0 {
                break;
            }
            digest.update(&portion[..length]);
        }
        Ok(Self { path: path.into(), sha256: hexadecimal(digest) })
    }

    /// The file of this name with this content, which is not read.
    pub fn of_content(path: &Path, content: &[u8]) -> Self {
        Self { path: path.into(), sha256: hexadecimal(Sha256::new_with_prefix(content)) }
    }

    /// The files at these paths, each once.
    ///
    /// # Errors
    /// [`IoError::File`] if one of them cannot be read.
    pub fn of_each<'p>(paths: impl IntoIterator<Item = &'p Path>) -> Result<Vec<Self>, IoError> {
        let mut before = HashSet::new();
        paths.into_iter().filter(|path| before.insert(*path)).map(Self::of).collect()
    }
}

/// A digest in hexadecimal digits.
pub(crate) fn hexadecimal(digest: Sha256) -> String {
    digest.finalize().iter().fold(String::new(), |mut text, byte| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

impl Rig {
    /// The rig file and the files of its log, each once.
    ///
    /// # Errors
    /// [`IoError::File`] if one of them cannot be read.
    pub fn input_files(&self) -> Result<Vec<InputFile>, IoError> {
        let mut paths = vec![self.path.as_path(), self.log.path.as_path()];
        if let LogFormat::Columns(columns) = &self.log.format {
            paths.extend([columns.gyro.path.as_path(), columns.accel.path.as_path()]);
            let angle = columns.table_angle.as_ref().and_then(|angle| angle.file.as_ref());
            let temperature = columns.temperature.as_ref().and_then(|column| column.file.as_ref());
            paths.extend(angle.map(|(path, _)| path.as_path()));
            paths.extend(temperature.map(|(path, _)| path.as_path()));
        }
        InputFile::of_each(paths)
    }
}
