//! What is being written, so that an interrupt leaves nothing of it.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::{fs, io};

/// The temporary files and folders of what is being written.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    // A list of paths is whole whatever happened to who held it.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A temporary file or folder that is removed by [`abandon`] as long as this lives.
pub(crate) struct Unfinished(PathBuf);

impl Unfinished {
    /// Makes the file or folder of the returned path, with no moment at which it is there but not known.
    ///
    /// Whoever removes it does so before this is dropped.
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

/// Puts what is finished in its place, before an interrupt or not at all.
pub(crate) fn undisturbed<T>(place: impl FnOnce() -> T) -> T {
    let _held = unfinished();
    place()
}

/// The end of all that is being written; see [`abandon`].
#[derive(Debug)]
#[must_use = "what is being written goes on when this is dropped"]
pub struct Abandoned {
    _held: MutexGuard<'static, Vec<PathBuf>>,
}

/// Removes whatever is being written but not in its place yet, for a program that is about to end.
///
/// As long as the returned value lives, nothing is put in its place any more: who tries waits.
pub fn abandon() -> Abandoned {
    let held = unfinished();
    for path in held.iter() {
        // What cannot be removed stays under its hidden name.
        let _ = if path.is_dir() { remove_folder(path) } else { fs::remove_file(path) };
    }
    Abandoned { _held: held }
}

/// Removes a folder into which another thread may still put files.
fn remove_folder(path: &Path) -> io::Result<()> {
    // A file that comes in between is rare; more than a few one after the other are not met.
    const ATTEMPTS: usize = 100;
    for _ in 1..ATTEMPTS {
        if fs::remove_dir_all(path).is_ok() {
            return Ok(());
        }
    }
    fs::remove_dir_all(path)
}
