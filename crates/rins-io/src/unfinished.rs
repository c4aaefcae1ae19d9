//! Unfinished output, which an interrupt removes.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::{fs, io};

/// The temporary files and folders of unfinished output.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    // The list of paths is valid even if a thread panicked while it held the lock.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A temporary file or folder, which [`abandon`] removes as long as this value exists.
#[derive(Debug)]
pub(crate) struct Unfinished(PathBuf);

impl Unfinished {
    /// Creates the file or folder of the returned path and registers it, without an instant at which it exists unregistered.
    ///
    /// It must be removed or renamed before this value is dropped.
    pub(crate) fn make<T: AsRef<Path>>(
        make: impl FnOnce() -> io::Result<T>,
    ) -> io::Result<(Self, T)> {
        let mut unfinished = unfinished();
        let made = make()?;
        let path = made.as_ref().to_path_buf();
        unfinished.push(path.clone());
        Ok((Self(path), made))
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        unfinished().retain(|path| *path != self.0);
    }
}

/// Moves finished output to its place, either before an interrupt or not at all.
pub(crate) fn undisturbed<T>(place: impl FnOnce() -> T) -> T {
    let _held = unfinished();
    place()
}

/// The end of all output; see [`abandon`].
#[derive(Debug)]
#[must_use = "what is being written goes on when this is dropped"]
pub struct Abandoned {
    _held: MutexGuard<'static, Vec<PathBuf>>,
}

/// Removes all unfinished output, for a program that is about to exit.
///
/// As long as the returned value exists, no output is moved to its place: a thread that tries waits.
pub fn abandon() -> Abandoned {
    let held = unfinished();
    for path in held.iter() {
        // A file that cannot be removed stays under its hidden name.
        let _ = if path.is_dir() { remove_folder(path) } else { fs::remove_file(path) };
    }
    Abandoned { _held: held }
}

/// Removes a folder into which another thread may still write files.
fn remove_folder(path: &Path) -> io::Result<()> {
    // A file that appears during the removal is rare; several in succession do not occur.
    const ATTEMPTS: usize = 100;
    for _ in 1..ATTEMPTS {
        if fs::remove_dir_all(path).is_ok() {
            return Ok(());
        }
    }
    fs::remove_dir_all(path)
}
